"""Correcting sites one by one: the texel whose neighbourhood fits best, among those the neighbours suggest."""

import warp as wp

from texloom.kernels.patches import read_sample


@wp.func
def mismatch(
    exemplar: wp.array3d(dtype=wp.vec4),
    row: float,
    column: float,
    width: int,
    values: wp.array3d(dtype=wp.vec4),
    known: wp.array2d(dtype=float),
    i: int,
    limit: float,
) -> float:
    """Sum over known samples of |exemplar - values[i]|^2, the patch's corner at (row, column); stops past ``limit``.

    All samples share one fraction of a texel, so the four bilinear weights are computed once.
    """
    r0 = int(wp.floor(row))
    c0 = int(wp.floor(column))
    fr = row - float(r0)
    fc = column - float(c0)
    whole = fr == 0.0 and fc == 0.0
    total = float(0.0)
    for r in range(width):
        for c in range(width):
            j = r * width + c
            for g in range(exemplar.shape[2]):
                value = exemplar[r0 + r, c0 + c, g]
                if not whole:
                    value = (1.0 - fr) * ((1.0 - fc) * value + fc * exemplar[r0 + r, c0 + c + 1, g]) + fr * (
                        (1.0 - fc) * exemplar[r0 + r + 1, c0 + c, g] + fc * exemplar[r0 + r + 1, c0 + c + 1, g]
                    )
                d = value - values[i, j, g]
                total += known[i, j] * wp.dot(d, d)
        if total > limit:
            break
    return total


@wp.func
def is_new(tried: wp.array3d(dtype=float), i: int, count: int, row: float, column: float) -> bool:
    """Whether (row, column) is none of the ``count`` candidates tried, to a third of a texel, and fits beside them."""
    if count >= tried.shape[1]:
        return False
    for k in range(count):
        if wp.abs(tried[i, k, 0] - row) + wp.abs(tried[i, k, 1] - column) < 0.3:
            return False
    return True


@wp.func
def is_usable(usable: wp.array2d(dtype=wp.uint8), row: float, column: float) -> bool:
    """Whether a whole neighbourhood lies in the exemplar around (row, column)."""
    r = int(wp.round(row))
    c = int(wp.round(column))
    if r < 0 or c < 0 or r >= usable.shape[0] or c >= usable.shape[1]:
        return False
    return usable[r, c] != wp.uint8(0)


NEAR = wp.constant(2.5)  # squared texels: how near the neighbours are whose sources are tried
SKEW = wp.constant(0.5)  # radians: sources turned more than this against the patch cannot be continued in it


@wp.kernel(enable_backward=False)
def correct_sites(
    start: int,
    chosen: wp.array(dtype=int),  # patches to correct, each around its own site
    centres: wp.array(dtype=int),
    width: int,
    entry_start: wp.array(dtype=int),  # cover entries by patch
    entries: wp.array(dtype=int),
    entry_site: wp.array(dtype=int),
    entry_position: wp.array2d(dtype=float),
    entry_turn: wp.array(dtype=float),  # one element where no patch is turned
    sites: wp.array3d(dtype=int),
    weights: wp.array3d(dtype=float),
    colour: wp.array2d(dtype=wp.vec4),  # channels in fours
    label: wp.array(dtype=int),
    changed: wp.array(dtype=int),  # when each site last changed
    visited: wp.array(dtype=int),  # when each patch's own site was last corrected
    position: wp.array2d(dtype=float),
    turn: wp.array(dtype=float),
    exemplar: wp.array3d(dtype=wp.vec4),
    usable: wp.array2d(dtype=wp.uint8),
    similar: wp.array4d(dtype=int),  # (row, column, k, 2): texels most like each texel
    values: wp.array3d(dtype=wp.vec4),  # (chosen, sample, group) scratch
    known: wp.array2d(dtype=float),  # (chosen, sample) scratch
    tried: wp.array3d(dtype=float),  # (chosen, candidate, 2) scratch; no more candidates than fit are compared
    found: wp.array2d(dtype=float),
    cost: wp.array(dtype=float),
):
    """found[i] = argmin over candidates q of mean_j |exemplar[q + offset_j] - values[i, j]|^2.

    A patch none of whose sites changed since its last visit is passed over: it would find the same. ``cost`` is by
    patch and keeps what it was then. Candidates are the sources of the sites in the patch, each moved by the site's offset to the centre (coherence),
    and the texels similar to those of the nearest sites (k-coherence). Ties keep the first.
    """
    i = start + wp.tid()
    patch = chosen[i]
    middle = float(width // 2)
    count = int(0)
    best = float(1.0e30)
    own = centres[patch]
    found[i, 0] = position[own, 0]
    found[i, 1] = position[own, 1]
    latest = int(-1)
    for e in range(entry_start[patch], entry_start[patch + 1]):
        latest = wp.max(latest, changed[entry_site[entries[e]]])
    if latest < visited[patch]:
        return
    number = float(1.0e-6)
    for j in range(width * width):
        known[i, j] = read_sample(patch, j, sites, weights, colour, label, i, j, values)
        number += known[i, j]
    for e in range(entry_start[patch], entry_start[patch + 1]):
        entry = entries[e]
        dr = entry_position[entry, 0] - middle
        dc = entry_position[entry, 1] - middle
        if dr * dr + dc * dc < NEAR:
            site = entry_site[entry]
            straight = int(1)
            if entry_turn.shape[0] > 1:
                if wp.abs(turn[site] - entry_turn[entry]) > SKEW:
                    straight = 0
            guesses = straight
            if site == own:
                guesses = straight * (1 + similar.shape[2])
            for guess in range(guesses):
                row = position[site, 0]
                column = position[site, 1]
                if guess > 0:
                    r = int(wp.round(row))
                    c = int(wp.round(column))
                    row = row + float(similar[r, c, guess - 1, 0] - r)
                    column = column + float(similar[r, c, guess - 1, 1] - c)
                row = row - dr
                column = column - dc
                if is_new(tried, i, count, row, column) and is_usable(usable, row, column):
                    tried[i, count, 0] = row
                    tried[i, count, 1] = column
                    count += 1
                    total = mismatch(exemplar, row - middle, column - middle, width, values, known, i, best)
                    if total < best:
                        best = total
                        found[i, 0] = row
                        found[i, 1] = column
    if count > 0:
        cost[patch] = best / number
