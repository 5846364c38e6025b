"""One line of pixels synthesized one after the other: search, copy, and tell the pixels that follow."""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.tree import offer, search_tree


@wp.func
def site_at(row: int, column: int, rows: int, columns: int, wrap: int) -> int:
    """The site of a texel, on the torus or on the plane; -1 outside."""
    if wrap != 0:
        r = ((row % rows) + rows) % rows
        c = ((column % columns) + columns) % columns
        return r * columns + c
    if row < 0 or column < 0 or row >= rows or column >= columns:
        return -1
    return row * columns + column


@wp.func
def window_cost(
    exemplar: wp.array3d(dtype=wp.vec4),
    row: int,
    column: int,
    stencil: wp.array2d(dtype=int),
    around: wp.array(dtype=int),
    colour: wp.array2d(dtype=wp.vec4),
    limit: float,
) -> float:
    """Sum over the coloured sites s of a stencil of |exemplar((row, column) + offset_s) - colour_s|^2; to ``limit``."""
    total = float(0.0)
    for k in range(stencil.shape[0]):
        site = around[k]
        if site >= 0:
            for g in range(exemplar.shape[2]):
                d = exemplar[row + stencil[k, 0], column + stencil[k, 1], g] - colour[site, g]
                total += wp.dot(d, d)
            if total > limit:
                break
    return total


@wp.func
def complete(
    inverse: wp.array3d(dtype=float),
    mean: wp.array2d(dtype=wp.vec4),
    v: int,
    projected: wp.array2d(dtype=wp.vec4),
    i: int,
    query: wp.array2d(dtype=wp.vec4),
):
    """The components of a whole window from the known part: inverse (projected - mean); as they are, where all is."""
    own = wp.min(v, mean.shape[0] - 1)
    for g in range(query.shape[1]):
        query[0, g] = projected[i, g] - mean[own, g]
    if inverse.shape[1] > 1:
        for g in range(query.shape[1]):
            for k in range(4):
                total = float(0.0)
                for h in range(query.shape[1]):
                    known = projected[i, h] - mean[own, h]
                    for j in range(4):
                        total += inverse[v, 4 * g + k, 4 * h + j] * known[j]
                query[0, g][k] = total


@wp.func
def offer_continuations(
    row: int,
    column: int,
    shape: wp.array(dtype=int),
    position: wp.array2d(dtype=float),
    label: wp.array(dtype=int),
    candidate_at: wp.array2d(dtype=int),
    vectors: wp.array2d(dtype=wp.vec4),
    query: wp.array2d(dtype=wp.vec4),
    suggested: wp.array(dtype=int),
    found: wp.array2d(dtype=int),
    distance: wp.array2d(dtype=float),
):
    """The candidates that continue what the site and the eight around it show: -1 where there is none."""
    for k in range(9):
        dr = k / 3 - 1
        dc = k % 3 - 1
        suggested[k] = -1
        beside = site_at(row + dr, column + dc, shape[0], shape[1], shape[2])
        if beside >= 0:
            r = int(position[beside, 0]) - dr
            c = int(position[beside, 1]) - dc
            inside = r >= 0 and c >= 0 and r < candidate_at.shape[0] and c < candidate_at.shape[1]
            if label[beside] >= 0 and inside:
                guess = candidate_at[r, c]
                suggested[k] = guess
                if guess >= 0:
                    total = float(0.0)
                    for g in range(query.shape[1]):
                        d = vectors[guess, g] - query[0, g]
                        total += wp.dot(d, d)
                    offer(found, distance, 0, guess, total)


@wp.func
def tell_line(
    change: float,
    channel: int,
    i: int,
    wrap: int,
    along: wp.array3d(dtype=wp.vec4),
    projected: wp.array2d(dtype=wp.vec4),
):
    """Add a change of pixel i to the components of all windows of its line that hold it."""
    length = projected.shape[0]
    for o in range(along.shape[0]):
        j = i - (o - (along.shape[0] - 1) / 2)
        if wrap != 0:
            j = ((j % length) + length) % length
        if j >= 0 and j < length:
            for h in range(projected.shape[1]):
                projected[j, h] = projected[j, h] + change * along[o, channel, h]


@wp.kernel(enable_backward=False)
def scan_line(
    start: int,
    line: wp.array(dtype=int),  # its sites, along it
    visits: wp.array(dtype=int),  # which of them, in scan order
    shape: wp.array(dtype=int),  # rows, columns and whether they wrap
    inverse: wp.array3d(dtype=float),  # (visit, d, d), or (1, 1, 1) where all windows are whole
    mean: wp.array2d(dtype=wp.vec4),  # (visit or 1, d / 4)
    along: wp.array3d(dtype=wp.vec4),  # A of the window's own line: (offset, channel, d / 4)
    vectors: wp.array2d(dtype=wp.vec4),  # components of the candidates
    points: wp.array2d(dtype=wp.vec4),  # the tree of them
    index: wp.array(dtype=int),
    low: wp.array2d(dtype=wp.vec4),
    high: wp.array2d(dtype=wp.vec4),
    first: wp.array(dtype=int),
    last: wp.array(dtype=int),
    centre: wp.array2d(dtype=int),  # texel of each candidate
    candidate_at: wp.array2d(dtype=int),  # and the candidate of each texel, -1 none
    exemplar: wp.array3d(dtype=wp.vec4),
    stencil: wp.array2d(dtype=int),  # offsets compared
    around: wp.array(dtype=int),  # scratch: the sites of the stencil
    query: wp.array2d(dtype=wp.vec4),  # scratch: (1, d / 4)
    suggested: wp.array(dtype=int),  # scratch: 9
    found: wp.array2d(dtype=int),  # scratch: (1, shortlist)
    distance: wp.array2d(dtype=float),
    projected: wp.array2d(dtype=wp.vec4),  # of the window around each site of the line: A^T (known colours)
    colour: wp.array2d(dtype=wp.vec4),
    position: wp.array2d(dtype=float),
    label: wp.array(dtype=int),
    cost: wp.array(dtype=float),
):
    """Shin & Shin, section 3: each pixel takes the texel whose window is nearest, and the next ones see it.

    A sequence, so one item. The nearest windows come from the tree, bounded by what the neighbours would continue;
    with a shortlist of more than one, the stencil's colours decide among them and those continuations. The cost is the
    mean squared difference over the stencil's coloured sites.
    """
    far = float(1.0e30)
    for v in range(visits.shape[0]):
        i = visits[v]
        site = line[i]
        row = site / shape[1]
        column = site % shape[1]

        coloured = int(0)
        for k in range(stencil.shape[0]):
            near = site_at(row + stencil[k, 0], column + stencil[k, 1], shape[0], shape[1], shape[2])
            if near >= 0:
                if label[near] < 0:
                    near = -1
            around[k] = near
            if near >= 0:
                coloured += 1

        complete(inverse, mean, v, projected, i, query)
        for k in range(found.shape[1]):
            found[0, k] = -1
            distance[0, k] = far
        offer_continuations(
            row, column, shape, position, label, candidate_at, vectors, query, suggested, found, distance
        )
        search_tree(points, index, low, high, first, last, query, 0, found, distance)

        best = int(-1)
        least = float(far)
        if found.shape[1] == 1:
            best = found[0, 0]
            least = window_cost(exemplar, centre[best, 0], centre[best, 1], stencil, around, colour, far)
        else:
            # What is shown already first: it fits, so that comparing the others ends soon.
            for k in range(9 + found.shape[1]):
                guess = int(-1)
                if k < 9:
                    guess = suggested[(k + 4) % 9]
                else:
                    guess = found[0, k - 9]
                if guess >= 0 and guess != best:  # neighbours mostly suggest the same
                    total = window_cost(exemplar, centre[guess, 0], centre[guess, 1], stencil, around, colour, least)
                    if total < least:
                        least = total
                        best = guess
        cost[site] = least / float(wp.max(coloured, 1))

        for channel in range(along.shape[1]):
            change = exemplar[centre[best, 0], centre[best, 1], channel / 4][channel % 4]
            if label[site] >= 0:
                change -= colour[site, channel / 4][channel % 4]
            if change != 0.0:
                tell_line(change, channel, i, shape[2], along, projected)
        for g in range(colour.shape[1]):
            colour[site, g] = exemplar[centre[best, 0], centre[best, 1], g]
        position[site, 0] = float(centre[best, 0])
        position[site, 1] = float(centre[best, 1])
        label[site] = wp.max(label[site], 0)
