"""Correcting sites one by one: the texel whose neighbourhood fits best, among those the neighbours suggest."""

import warp as wp

from texloom.kernels.patches import sample_exemplar

NEAR = wp.constant(2.5)  # squared texels: how near the neighbours are whose sources are tried


@wp.func
def mismatch(
    exemplar: wp.array3d(dtype=wp.vec4),
    row: float,
    column: float,
    angle: float,
    sites: wp.array2d(dtype=int),
    offset: wp.array3d(dtype=float),
    shape: int,
    i: int,
    colour: wp.array2d(dtype=wp.vec4),
    limit: float,
) -> float:
    """Sum over the neighbours s of site i of |exemplar((row, column) + R offset_s) - colour_s|^2; stops past ``limit``.

    R reads an offset in axes turned by ``angle``.

    Offsets may reach half a texel farther than whole ones do: what lies outside the exemplar reads its border.
    """
    total = float(0.0)
    cosine = wp.cos(angle)
    sine = wp.sin(angle)
    for k in range(sites.shape[1]):
        site = sites[i, k]
        if site >= 0:
            dr = offset[shape, k, 0]
            dc = offset[shape, k, 1]
            y = row + cosine * dr + sine * dc
            x = column + cosine * dc - sine * dr
            for g in range(exemplar.shape[2]):
                d = sample_exemplar(exemplar, y, x, g) - colour[site, g]
                total += wp.dot(d, d)
            if total > limit:
                break
    return total


@wp.func
def is_new(tried: wp.array3d(dtype=float), i: int, count: int, row: float, column: float, angle: float) -> bool:
    """Whether this is none of the ``count`` candidates tried, to a third of a texel and 30°, and fits beside them."""
    if count >= tried.shape[1]:
        return False
    for k in range(count):
        if wp.abs(tried[i, k, 0] - row) + wp.abs(tried[i, k, 1] - column) < 0.3:
            if wp.cos(tried[i, k, 2] - angle) > 0.87:
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


@wp.kernel(enable_backward=False)
def correct_sites(
    start: int,
    chosen: wp.array(dtype=int),  # which neighbourhoods
    sites: wp.array2d(dtype=int),  # (neighbourhood, k): the middle site first, -1 none
    offset: wp.array3d(dtype=float),  # (neighbourhood or 1, k, 2)
    turned: wp.array2d(dtype=float),  # (neighbourhood, k), or (1, 1) where no frame is turned
    position: wp.array2d(dtype=float),
    turn: wp.array(dtype=float),
    colour: wp.array2d(dtype=wp.vec4),  # channels in fours
    label: wp.array(dtype=int),
    changed: wp.array(dtype=int),  # when each site last changed
    visited: wp.array(dtype=int),  # when each neighbourhood was last corrected
    exemplar: wp.array3d(dtype=wp.vec4),
    usable: wp.array2d(dtype=wp.uint8),
    similar: wp.array4d(dtype=int),  # (row, column, k, 2): texels most like each texel
    tried: wp.array3d(dtype=float),  # (chosen, candidate, 3) scratch; no more candidates than fit are compared
    found: wp.array2d(dtype=float),
    cost: wp.array(dtype=float),
):
    """found[i] = argmin over candidates (q, turn) of mean_k |exemplar(q + R(turn) offset_k) - colour_k|^2.

    Candidates are the sources of the middle site and of those next to it, continued to the middle (coherence), and the
    texels similar to the middle site's (k-coherence). Ties keep the first. A neighbourhood none of whose sites
    changed since its last visit is passed over: it would find the same. ``cost`` is by neighbourhood.
    """
    i = start + wp.tid()
    own = chosen[i]
    middle = sites[own, 0]
    found[i, 0] = position[middle, 0]
    found[i, 1] = position[middle, 1]
    found[i, 2] = turn[middle]
    latest = int(-1)
    number = float(0.0)
    for k in range(sites.shape[1]):
        if sites[own, k] >= 0:
            latest = wp.max(latest, changed[sites[own, k]])
            number += 1.0
    if latest < visited[own]:
        return
    shape = wp.min(own, offset.shape[0] - 1)
    count = int(0)
    best = float(1.0e30)
    for k in range(sites.shape[1]):
        site = sites[own, k]
        dr = offset[shape, k, 0]
        dc = offset[shape, k, 1]
        guesses = int(0)
        angle = float(0.0)
        if site >= 0 and dr * dr + dc * dc < NEAR:
            if label[site] >= 0:
                guesses = 1
                angle = turn[site]
                if turned.shape[1] > 1:
                    angle -= turned[own, k]  # the source's axes, against the middle site's frame
                if k == 0:
                    guesses = 1 + similar.shape[2]
        cosine = wp.cos(angle)
        sine = wp.sin(angle)
        for guess in range(guesses):
            row = position[site, 0]
            column = position[site, 1]
            if guess > 0:
                # Sources may lie up to a texel outside the exemplar, where a patch's outer samples show its border.
                r = wp.clamp(int(wp.round(row)), 0, similar.shape[0] - 1)
                c = wp.clamp(int(wp.round(column)), 0, similar.shape[1] - 1)
                row = row + float(similar[r, c, guess - 1, 0] - r)
                column = column + float(similar[r, c, guess - 1, 1] - c)
            row = row - (cosine * dr + sine * dc)
            column = column - (cosine * dc - sine * dr)
            # What is shown now may always stay, or coherence would break where it comes from the exemplar's border.
            fits = k + guess == 0 or is_usable(usable, row, column)
            if fits and is_new(tried, i, count, row, column, angle):
                tried[i, count, 0] = row
                tried[i, count, 1] = column
                tried[i, count, 2] = angle
                count += 1
                total = mismatch(exemplar, row, column, angle, sites, offset, shape, own, colour, best)
                if total < best:
                    best = total
                    found[i, 0] = row
                    found[i, 1] = column
                    found[i, 2] = angle
    if count > 0:
        cost[own] = best / number
