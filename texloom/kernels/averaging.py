"""Pasting many overlapping patches at once: weighted means, and layers feathered at their borders."""

import warp as wp

from texloom.kernels.patches import sample_exemplar


@wp.kernel(enable_backward=False)
def average_patches(
    start: int,
    cover_start: wp.array(dtype=int),
    cover_patch: wp.array(dtype=int),
    cover_position: wp.array2d(dtype=float),
    anchors: wp.array2d(dtype=int),  # in texels of the level
    weight: wp.array(dtype=float),
    scale: float,  # texels of the level per texel of the domain
    exemplar: wp.array3d(dtype=wp.vec4),
    colour: wp.array2d(dtype=wp.vec4),
):
    """colour[s] = sum over patches p covering s of weight[p] exemplar(anchors[p] + scale position(p, s)) / sum weight.

    Chen, Liu & Dong, section 4.3, the least squares of the E-step. A site that no patch covers keeps its colour.
    """
    s = start + wp.tid()
    first = cover_start[s]
    last = cover_start[s + 1]
    if first < last:
        total = float(0.0)
        for g in range(exemplar.shape[2]):
            colour[s, g] = wp.vec4(0.0, 0.0, 0.0, 0.0)
        for e in range(first, last):
            p = cover_patch[e]
            w = weight[p]
            total += w
            row = float(anchors[p, 0]) + scale * cover_position[e, 0]
            column = float(anchors[p, 1]) + scale * cover_position[e, 1]
            for g in range(exemplar.shape[2]):
                colour[s, g] = colour[s, g] + w * sample_exemplar(exemplar, row, column, g)
        for g in range(exemplar.shape[2]):
            colour[s, g] = colour[s, g] / total


@wp.kernel(enable_backward=False)
def heaviest_patches(
    start: int,
    cover_start: wp.array(dtype=int),
    cover_patch: wp.array(dtype=int),
    weight: wp.array(dtype=float),
    entry: wp.array2d(dtype=int),
    share: wp.array2d(dtype=float),
):
    """entry[s], share[s] = the heaviest cover entries of site s, heaviest first, and their weights scaled to sum 1.

    Equal weights keep the first entry first; missing ones are -1 with share 0.
    """
    s = start + wp.tid()
    most = entry.shape[1]
    for k in range(most):
        entry[s, k] = -1
        share[s, k] = 0.0
    for e in range(cover_start[s], cover_start[s + 1]):
        w = weight[cover_patch[e]]
        k = most - 1
        if entry[s, k] < 0 or w > share[s, k]:
            while k > 0 and (entry[s, k - 1] < 0 or w > share[s, k - 1]):
                entry[s, k] = entry[s, k - 1]
                share[s, k] = share[s, k - 1]
                k -= 1
            entry[s, k] = e
            share[s, k] = w
    total = float(1.0e-30)
    for k in range(most):
        total += share[s, k]
    for k in range(most):
        share[s, k] = share[s, k] / total


@wp.kernel(enable_backward=False)
def feather_layers(
    start: int,
    cover_start: wp.array(dtype=int),
    cover_patch: wp.array(dtype=int),
    cover_position: wp.array2d(dtype=float),
    rank: wp.array(dtype=int),  # when each patch was laid
    width: int,
    zone: float,
    entry: wp.array2d(dtype=int),
    share: wp.array2d(dtype=float),
):
    """entry[s], share[s] = the latest patches over site s and what shows of each.

    A patch covers what lies below by min(1, (depth + 1/2) / zone), depth the distance from its border in samples:
    section 5, step 6. Missing layers are -1 with share 0; the last layer kept takes what is left.
    """
    s = start + wp.tid()
    most = entry.shape[1]
    left = float(1.0)
    below = int(2147483647)
    final = int(-1)
    for k in range(most):
        entry[s, k] = -1
        share[s, k] = 0.0
        if left > 0.0:
            top = int(-1)
            for e in range(cover_start[s], cover_start[s + 1]):
                if rank[cover_patch[e]] < below and (top < 0 or rank[cover_patch[e]] > rank[cover_patch[top]]):
                    top = e
            if top >= 0:
                below = rank[cover_patch[top]]
                row = cover_position[top, 0]
                column = cover_position[top, 1]
                side = float(width - 1)
                depth = wp.min(wp.min(row, column), wp.min(side - row, side - column))
                cover = wp.clamp((depth + 0.5) / zone, 0.0, 1.0)
                entry[s, k] = top
                share[s, k] = left * cover
                left = left - left * cover
                final = k
    if final >= 0:
        share[s, final] = share[s, final] + left


@wp.kernel(enable_backward=False)
def place_sources(
    start: int,
    entry: wp.array2d(dtype=int),
    cover_patch: wp.array(dtype=int),
    cover_position: wp.array2d(dtype=float),
    cover_turn: wp.array(dtype=float),  # one element where no patch is turned
    anchors: wp.array2d(dtype=int),
    share: wp.array2d(dtype=float),
    position: wp.array3d(dtype=float),
    turn: wp.array2d(dtype=float),
):
    """position[s, k] = anchors[p] + the place in patch p of cover entry (s, k); heaviest first, ties in order.

    Shares are made to sum to one exactly in the first; a site without any shows texel (0, 0) whole.
    """
    s = start + wp.tid()
    most = entry.shape[1]
    for k in range(1, most):
        at = k
        while at > 0:
            if share[s, at] <= share[s, at - 1]:
                break
            e = entry[s, at]
            entry[s, at] = entry[s, at - 1]
            entry[s, at - 1] = e
            w = share[s, at]
            share[s, at] = share[s, at - 1]
            share[s, at - 1] = w
            at -= 1
    rest = float(1.0)
    for k in range(most):
        e = entry[s, k]
        position[s, k, 0] = 0.0
        position[s, k, 1] = 0.0
        if e >= 0:
            position[s, k, 0] = float(anchors[cover_patch[e], 0]) + cover_position[e, 0]
            position[s, k, 1] = float(anchors[cover_patch[e], 1]) + cover_position[e, 1]
            if cover_turn.shape[0] > 1:
                turn[s, k] = cover_turn[e]
        if k > 0:
            rest -= share[s, k]
    share[s, 0] = rest
