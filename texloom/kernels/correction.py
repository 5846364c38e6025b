"""Correcting sites one by one: the texel whose neighbourhood fits best, among those the neighbours suggest."""

import warp as wp


@wp.func
def mismatch(
    exemplar: wp.array3d(dtype=float),
    row: float,
    column: float,
    width: int,
    values: wp.array3d(dtype=float),
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
            if known[i, j] > 0.0:
                for ch in range(exemplar.shape[2]):
                    value = exemplar[r0 + r, c0 + c, ch]
                    if not whole:
                        upper = value + fc * (exemplar[r0 + r, c0 + c + 1, ch] - value)
                        lower = exemplar[r0 + r + 1, c0 + c, ch]
                        lower += fc * (exemplar[r0 + r + 1, c0 + c + 1, ch] - lower)
                        value = upper + fr * (lower - upper)
                    d = value - values[i, j, ch]
                    total += d * d
        if total > limit:
            break
    return total


KEPT = wp.constant(24)  # distinct candidates compared at most; coherent neighbourhoods have one to six
SKEW = wp.constant(0.5)  # radians: sources turned more than this against the patch cannot be continued in it
vec_kept = wp.types.vector(length=24, dtype=float)


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
    values: wp.array3d(dtype=float),  # what the samples of the chosen patches show
    known: wp.array2d(dtype=float),
    position: wp.array2d(dtype=float),
    turn: wp.array(dtype=float),
    exemplar: wp.array3d(dtype=float),
    usable: wp.array2d(dtype=wp.uint8),
    similar: wp.array4d(dtype=int),  # (row, column, k, 2): texels most like each texel
    found: wp.array2d(dtype=float),
    cost: wp.array(dtype=float),
):
    """found[i] = argmin over candidates q of mean_j |exemplar[q + offset_j] - values[i, j]|^2.

    Candidates are the sources of the sites in the patch, each moved by the site's offset to the centre (coherence),
    and the texels similar to those of the nearest sites (k-coherence). Ties keep the first.
    """
    i = start + wp.tid()
    patch = chosen[i]
    middle = float(width // 2)
    candidate_row = vec_kept()
    candidate_column = vec_kept()
    count = int(0)
    best = float(1.0e30)
    number = float(1.0e-6)
    for j in range(width * width):
        number += known[i, j]
    found[i, 0] = position[centres[patch], 0]
    found[i, 1] = position[centres[patch], 1]
    # Two rounds: the neighbours' own sources first, then texels similar to them.
    for guess in range(1 + similar.shape[2]):
        for e in range(entry_start[patch], entry_start[patch + 1]):
            entry = entries[e]
            site = entry_site[entry]
            dr = entry_position[entry, 0] - middle
            dc = entry_position[entry, 1] - middle
            row = position[site, 0]
            column = position[site, 1]
            take = dr * dr + dc * dc < 4.5
            if entry_turn.shape[0] > 1 and wp.abs(turn[site] - entry_turn[entry]) > SKEW:
                take = False
            if guess > 0:
                take = take and dr * dr + dc * dc < 0.5
                r = int(wp.round(row))
                c = int(wp.round(column))
                row = row + float(similar[r, c, guess - 1, 0]) - float(r)
                column = column + float(similar[r, c, guess - 1, 1]) - float(c)
            row = row - dr
            column = column - dc
            if take and count < KEPT:
                for k in range(count):
                    if wp.abs(candidate_row[k] - row) + wp.abs(candidate_column[k] - column) < 0.3:
                        take = False
                        break
                r = int(wp.round(row))
                c = int(wp.round(column))
                if r < 0 or c < 0 or r >= usable.shape[0] or c >= usable.shape[1]:
                    take = False
                elif usable[r, c] == wp.uint8(0):
                    take = False
                if take:
                    candidate_row[count] = row
                    candidate_column[count] = column
                    count += 1
                    total = mismatch(exemplar, row - middle, column - middle, width, values, known, i, best)
                    if total < best:
                        best = total
                        found[i, 0] = row
                        found[i, 1] = column
    cost[i] = best / number
