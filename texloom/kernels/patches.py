"""Reading patches from a domain, finding where they fit in the exemplar, cutting their seams and pasting them.

Shapes: ``sites`` and ``weights`` are (patch, sample, corner), a site's ``colour`` is (site, channel), the exemplar is
(row, column, channel). Patches are ``width × width`` samples in scan-line order; sample -1 is out of reach.
"""

import warp as wp


@wp.func
def sample_exemplar(exemplar: wp.array3d(dtype=wp.vec4), row: float, column: float, group: int) -> wp.vec4:
    """Bilinear value at (row, column), clamped at the border; exact at integers."""
    r = wp.clamp(row, 0.0, float(exemplar.shape[0] - 1))
    c = wp.clamp(column, 0.0, float(exemplar.shape[1] - 1))
    r0 = int(r)
    c0 = int(c)
    fr = r - float(r0)
    fc = c - float(c0)
    value = exemplar[r0, c0, group]
    if fr > 0.0 or fc > 0.0:
        r1 = wp.min(r0 + 1, exemplar.shape[0] - 1)
        c1 = wp.min(c0 + 1, exemplar.shape[1] - 1)
        value = (1.0 - fr) * ((1.0 - fc) * value + fc * exemplar[r0, c1, group]) + fr * (
            (1.0 - fc) * exemplar[r1, c0, group] + fc * exemplar[r1, c1, group]
        )
    return value


@wp.func
def read_sample(
    patch: int,
    sample: int,
    sites: wp.array3d(dtype=int),
    weights: wp.array3d(dtype=float),
    colour: wp.array2d(dtype=wp.vec4),
    label: wp.array(dtype=int),
    i: int,
    j: int,
    values: wp.array3d(dtype=wp.vec4),
) -> float:
    """values[i, j] = mean of the sample's coloured corners; returns 1 where they hold half of its weight, else 0."""
    if sites.shape[2] == 1:
        site = sites[patch, sample, 0]
        if site >= 0:
            if label[site] >= 0:
                for g in range(colour.shape[1]):
                    values[i, j, g] = colour[site, g]
                return 1.0
        for g in range(colour.shape[1]):
            values[i, j, g] = wp.vec4(0.0, 0.0, 0.0, 0.0)
        return 0.0
    total = float(0.0)
    for k in range(sites.shape[2]):
        site = sites[patch, sample, k]
        if site >= 0:
            if label[site] >= 0:
                total += weights[patch, sample, k]
    known = wp.where(total >= 0.5, 1.0, 0.0)
    for g in range(colour.shape[1]):
        mean = wp.vec4(0.0, 0.0, 0.0, 0.0)
        if known > 0.0:
            for k in range(sites.shape[2]):
                site = sites[patch, sample, k]
                if site >= 0:
                    if label[site] >= 0:
                        mean += (weights[patch, sample, k] / total) * colour[site, g]
        values[i, j, g] = mean
    return known


@wp.kernel(enable_backward=False)
def read_patches(
    start: int,
    chosen: wp.array(dtype=int),
    samples: wp.array(dtype=int),
    sites: wp.array3d(dtype=int),
    weights: wp.array3d(dtype=float),  # (1, 1, 1) where every sample is a site
    colour: wp.array2d(dtype=wp.vec4),  # channels in fours
    label: wp.array(dtype=int),
    values: wp.array3d(dtype=wp.vec4),
    known: wp.array2d(dtype=float),
):
    """values[i, j] = mean of the coloured corners (label >= 0) of sample ``samples[j]`` of patch ``chosen[i]``.

    known[i, j] is 1 where at least half of the weight is coloured, else 0 (and values 0).
    """
    item = start + wp.tid()
    i = item // samples.shape[0]
    j = item - i * samples.shape[0]
    known[i, j] = read_sample(chosen[i], samples[j], sites, weights, colour, label, i, j, values)


@wp.kernel(enable_backward=False)
def refine_anchors(
    start: int,
    anchors: wp.array3d(dtype=int),  # (patch, candidate, 2)
    reach: int,
    width: int,
    stride: int,  # compare every stride-th sample of every stride-th row
    values: wp.array3d(dtype=wp.vec4),
    known: wp.array2d(dtype=float),
    exemplar: wp.array3d(dtype=wp.vec4),
    usable: wp.array2d(dtype=wp.uint8),
    best: wp.array3d(dtype=int),
    cost: wp.array2d(dtype=float),
):
    """best[p, k] = the anchor within ``reach`` texels of anchors[p, k] with the least mean squared difference.

    cost = sum over known samples |exemplar - values|^2 / their number; ties keep the first in scan-line order. An
    anchor that is not ``usable`` (its patch leaves the exemplar or its mask) costs infinity.
    """
    item = start + wp.tid()
    p = item // anchors.shape[1]
    k = item - p * anchors.shape[1]
    number = float(1.0e-6)
    for r in range(0, width, stride):
        for c in range(0, width, stride):
            number += known[p, r * width + c]
    least = float(1.0e30)
    best[p, k, 0] = anchors[p, k, 0]
    best[p, k, 1] = anchors[p, k, 1]
    for dr in range(-reach, reach + 1):
        for dc in range(-reach, reach + 1):
            r0 = anchors[p, k, 0] + dr
            c0 = anchors[p, k, 1] + dc
            if r0 >= 0 and c0 >= 0 and r0 < usable.shape[0] and c0 < usable.shape[1]:
                if usable[r0, c0] != wp.uint8(0):
                    total = float(0.0)
                    for r in range(0, width, stride):
                        for c in range(0, width, stride):
                            j = r * width + c
                            if known[p, j] > 0.0:
                                for g in range(exemplar.shape[2]):
                                    d = exemplar[r0 + r, c0 + c, g] - values[p, j, g]
                                    total += wp.dot(d, d)
                        if total > least:
                            break
                    if total < least:
                        least = total
                        best[p, k, 0] = r0
                        best[p, k, 1] = c0
    cost[p, k] = least / number


@wp.func
def seam_cost(
    ring: wp.array3d(dtype=int),
    t: int,
    d: int,
    p: int,
    r0: int,
    c0: int,
    width: int,
    values: wp.array3d(dtype=wp.vec4),
    known: wp.array2d(dtype=float),
    exemplar: wp.array3d(dtype=wp.vec4),
) -> float:
    """Squared difference of old and new colour at place (t, d) of the ring; nothing where there is no old colour."""
    r = ring[t, d, 0]
    c = ring[t, d, 1]
    j = r * width + c
    if known[p, j] == 0.0:
        return 0.0
    total = float(1.0e-4)  # a seam through equal colours should still be short
    for g in range(exemplar.shape[2]):
        e = exemplar[r0 + r, c0 + c, g] - values[p, j, g]
        total += wp.dot(e, e)
    return total


@wp.kernel(enable_backward=False)
def cut_seams(
    start: int,
    ring: wp.array3d(dtype=int),  # (perimeter, depth, 2): sample [row, column] at each place of the unrolled border
    anchors: wp.array3d(dtype=int),  # (patch, candidate, 2)
    width: int,
    values: wp.array3d(dtype=wp.vec4),
    known: wp.array2d(dtype=float),
    exemplar: wp.array3d(dtype=wp.vec4),
    path_cost: wp.array3d(dtype=float),  # (patch candidate, 2, depth) scratch
    step: wp.array3d(dtype=wp.int8),  # (patch candidate, 2 perimeter, depth) scratch
    seam: wp.array3d(dtype=int),
    cost: wp.array2d(dtype=float),
):
    """seam[p, k, t] = depth at which patch p, showing candidate k, begins around its border: the cheapest closed path.

    Dynamic programming twice around the unrolled ring (the second lap forgets where the first began):
    cost(t, d) = e(t, d) + min over |d' - d| <= 1 of cost(t - 1, d'). ``cost`` is that of one lap.
    """
    item = start + wp.tid()
    p = item // anchors.shape[1]
    k = item - p * anchors.shape[1]
    r0 = anchors[p, k, 0]
    c0 = anchors[p, k, 1]
    around = ring.shape[0]
    depth = ring.shape[1]
    for lap in range(2 * around):
        t = lap % around
        now = lap % 2
        before = 1 - now
        for d in range(depth):
            least = float(0.0)
            move = int(0)
            if lap > 0:
                least = path_cost[item, before, d]
                if d > 0:
                    if path_cost[item, before, d - 1] < least:
                        least = path_cost[item, before, d - 1]
                        move = -1
                if d < depth - 1:
                    if path_cost[item, before, d + 1] < least:
                        least = path_cost[item, before, d + 1]
                        move = 1
            path_cost[item, now, d] = least + seam_cost(ring, t, d, p, r0, c0, width, values, known, exemplar)
            step[item, lap, d] = wp.int8(move)
    at = int(0)
    last = (2 * around - 1) % 2
    for d in range(1, depth):
        if path_cost[item, last, d] < path_cost[item, last, at]:
            at = d
    cost[p, k] = 0.5 * path_cost[item, last, at]
    for back in range(2 * around):
        lap = 2 * around - 1 - back
        # Keep the middle of the two laps, where neither end of the path shows.
        if lap >= around // 2 and lap < around + around // 2:
            seam[p, k, lap % around] = at
        at += int(step[item, lap, at])


@wp.kernel(enable_backward=False)
def paste_blocks(
    start: int,
    entries: wp.array(dtype=int),  # cover entries of the chosen patches
    entry_owner: wp.array(dtype=int),  # which of the chosen patches each belongs to
    entry_site: wp.array(dtype=int),
    entry_position: wp.array2d(dtype=float),
    entry_turn: wp.array(dtype=float),  # one element where no patch is turned
    chosen: wp.array(dtype=int),
    anchors: wp.array2d(dtype=int),
    scale: float,  # texels of the exemplar per sample
    width: int,
    place: wp.array2d(dtype=int),  # (sample, 2): perimeter index and depth of each sample
    seam: wp.array2d(dtype=int),
    exemplar: wp.array3d(dtype=wp.vec4),
    first: int,  # label of patch 0
    label: wp.array(dtype=int),
    position: wp.array2d(dtype=float),
    turn: wp.array(dtype=float),
    colour: wp.array2d(dtype=wp.vec4),
    pasted: wp.array(dtype=wp.uint8),
):
    """Give a site inside its patch's seam (or without a colour) to that patch; pasted[i] tells whether entry i took.

    Patches of one launch share no site.
    """
    i = start + wp.tid()
    e = entries[i]
    p = entry_owner[i]
    site = entry_site[e]
    row = entry_position[e, 0]
    column = entry_position[e, 1]
    r = wp.clamp(int(wp.round(row)), 0, width - 1)
    c = wp.clamp(int(wp.round(column)), 0, width - 1)
    j = r * width + c
    pasted[i] = wp.uint8(0)
    if label[site] < 0 or place[j, 1] >= seam[p, place[j, 0]]:
        pasted[i] = wp.uint8(1)
        label[site] = first + chosen[p]
        if entry_turn.shape[0] > 1:
            turn[site] = entry_turn[e]
        position[site, 0] = float(anchors[p, 0]) + scale * row
        position[site, 1] = float(anchors[p, 1]) + scale * column
        for g in range(exemplar.shape[2]):
            colour[site, g] = sample_exemplar(exemplar, position[site, 0], position[site, 1], g)
