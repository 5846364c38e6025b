"""Choosing texels site by site: the one whose surroundings fit best, of what the neighbours and a search suggest."""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.patches import read_sample, sample_exemplar
from texloom.kernels.tree import search_tree

NEAR = wp.constant(2.5)  # squared texels: how near the neighbours are whose sources are tried
FAR = wp.constant(1.0e30)


@wp.struct
class Canvas:
    """What each site shows; ``changed`` is when it last did."""

    position: wp.array2d(dtype=float)
    turn: wp.array(dtype=float)
    colour: wp.array2d(dtype=wp.vec4)  # channels in fours
    label: wp.array(dtype=int)
    changed: wp.array(dtype=int)


@wp.struct
class Around:
    """Neighbourhoods: the samples that are compared, and the sites whose sources are tried."""

    samples: wp.array(dtype=int)  # those of a stencil that count
    sites: wp.array3d(dtype=int)  # (neighbourhood, exemplar, corner): -1 none
    weights: wp.array3d(dtype=float)  # (1, 1, 1) where a sample is a site
    offset: wp.array3d(dtype=float)  # (neighbourhood or 1, exemplar, 2)
    near: wp.array2d(dtype=int)  # (neighbourhood, k): the middle site first, -1 none
    near_offset: wp.array3d(dtype=float)  # (neighbourhood or 1, k, 2)
    turned: wp.array2d(dtype=float)  # (neighbourhood, k), or (1, 1) where no frame is turned


@wp.struct
class Exemplar:
    """The exemplar, and where a whole neighbourhood lies in it."""

    image: wp.array3d(dtype=wp.vec4)
    usable: wp.array2d(dtype=wp.uint8)
    similar: wp.array4d(dtype=int)  # (row, column, k, 2): texels most like each texel
    suggesting: int  # of the near sites, those whose similar texels are tried


@wp.struct
class Tree:
    """The exemplar's windows by their principal components; of none, where no tree is asked."""

    axes: wp.array3d(dtype=wp.vec4)  # (sample compared, channel, d / 4)
    mean: wp.array2d(dtype=wp.vec4)  # (sample compared, channel / 4)
    points: wp.array2d(dtype=wp.vec4)
    index: wp.array(dtype=int)
    low: wp.array2d(dtype=wp.vec4)
    high: wp.array2d(dtype=wp.vec4)
    first: wp.array(dtype=int)
    last: wp.array(dtype=int)
    centre: wp.array2d(dtype=int)  # texel in the middle of each window


@wp.struct
class Desk:
    """Room to work in, a row for each neighbourhood at work, and what is found."""

    seen: wp.array3d(dtype=wp.vec4)  # what its samples show
    known: wp.array2d(dtype=float)
    query: wp.array2d(dtype=wp.vec4)
    nearest: wp.array2d(dtype=int)
    distance: wp.array2d(dtype=float)
    tried: wp.array3d(dtype=float)  # (row, candidate, 3); no more candidates than fit are compared
    found: wp.array2d(dtype=float)  # position and turn


@wp.func
def mismatch(
    exemplar: Exemplar,
    row: float,
    column: float,
    angle: float,
    around: Around,
    shape: int,
    desk: Desk,
    i: int,
    limit: float,
) -> float:
    """Sum over the known samples s of |exemplar((row, column) + R offset_s) - seen_s|^2; stops past ``limit``.

    R reads an offset in axes turned by ``angle``.

    Offsets may reach half a texel farther than whole ones do: what lies outside the exemplar reads its border.
    """
    total = float(0.0)
    cosine = wp.cos(angle)
    sine = wp.sin(angle)
    for j in range(around.samples.shape[0]):
        if desk.known[i, j] > 0.0:
            dr = around.offset[shape, around.samples[j], 0]
            dc = around.offset[shape, around.samples[j], 1]
            y = row + cosine * dr + sine * dc
            x = column + cosine * dc - sine * dr
            for g in range(exemplar.image.shape[2]):
                d = sample_exemplar(exemplar.image, y, x, g) - desk.seen[i, j, g]
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


@wp.func
def is_settled(own: int, around: Around, canvas: Canvas, visited: wp.array(dtype=int)) -> bool:
    """Whether none of the sites a neighbourhood reads changed since its last visit: it would find the same."""
    latest = int(-1)
    for j in range(around.samples.shape[0]):
        for corner in range(around.sites.shape[2]):
            site = around.sites[own, around.samples[j], corner]
            if site >= 0:
                latest = wp.max(latest, canvas.changed[site])
    return latest < visited[own]


@wp.func
def ask_tree(tree: Tree, desk: Desk, i: int):
    """nearest[i] = the windows nearest in their principal components; what is not known counts as the mean."""
    for h in range(desk.query.shape[1]):
        desk.query[i, h] = wp.vec4(0.0, 0.0, 0.0, 0.0)
    for j in range(tree.axes.shape[0]):
        if desk.known[i, j] > 0.0:
            for g in range(tree.mean.shape[1]):
                d = desk.seen[i, j, g] - tree.mean[j, g]
                for channel in range(4):
                    for h in range(desk.query.shape[1]):
                        desk.query[i, h] += d[channel] * tree.axes[j, 4 * g + channel, h]
    for k in range(desk.nearest.shape[1]):
        desk.nearest[i, k] = -1
        desk.distance[i, k] = FAR
    search_tree(
        tree.points,
        tree.index,
        tree.low,
        tree.high,
        tree.first,
        tree.last,
        desk.query,
        i,
        desk.nearest,
        desk.distance,
    )


@wp.func
def find_source(own: int, i: int, around: Around, canvas: Canvas, exemplar: Exemplar, tree: Tree, desk: Desk) -> float:
    """found[i] = argmin over candidates (q, turn) of mean_s |exemplar(q + R(turn) offset_s) - seen_s|^2; returns that.

    Candidates are the sources of the middle site and of those next to it, continued to the middle (coherence), the
    texels similar to those of the first ``suggesting`` (k-coherence), and what the tree finds. Ties keep the first.
    """
    middle = around.near[own, 0]
    desk.found[i, 0] = canvas.position[middle, 0]
    desk.found[i, 1] = canvas.position[middle, 1]
    desk.found[i, 2] = canvas.turn[middle]
    number = float(0.0)
    for j in range(around.samples.shape[0]):
        known = read_sample(
            own, around.samples[j], around.sites, around.weights, canvas.colour, canvas.label, i, j, desk.seen
        )
        desk.known[i, j] = known
        number += known
    shape = wp.min(own, around.offset.shape[0] - 1)
    beside = wp.min(own, around.near_offset.shape[0] - 1)
    count = int(0)
    best = float(FAR)
    for k in range(around.near.shape[1]):
        site = around.near[own, k]
        dr = around.near_offset[beside, k, 0]
        dc = around.near_offset[beside, k, 1]
        guesses = int(0)
        angle = float(0.0)
        if site >= 0 and dr * dr + dc * dc < NEAR:
            if canvas.label[site] >= 0:
                guesses = 1
                angle = canvas.turn[site]
                if around.turned.shape[1] > 1:
                    angle -= around.turned[own, k]  # the source's axes, against the middle site's frame
                if k < exemplar.suggesting:
                    guesses = 1 + exemplar.similar.shape[2]
        cosine = wp.cos(angle)
        sine = wp.sin(angle)
        for guess in range(guesses):
            row = canvas.position[site, 0]
            column = canvas.position[site, 1]
            if guess > 0:
                # Sources may lie up to a texel outside the exemplar, where a patch's outer samples show its border.
                r = wp.clamp(int(wp.round(row)), 0, exemplar.similar.shape[0] - 1)
                c = wp.clamp(int(wp.round(column)), 0, exemplar.similar.shape[1] - 1)
                row = row + float(exemplar.similar[r, c, guess - 1, 0] - r)
                column = column + float(exemplar.similar[r, c, guess - 1, 1] - c)
            row = row - (cosine * dr + sine * dc)
            column = column - (cosine * dc - sine * dr)
            # What is shown now may always stay, or coherence would break where it comes from the exemplar's border.
            fits = k + guess == 0 or is_usable(exemplar.usable, row, column)
            if fits and is_new(desk.tried, i, count, row, column, angle):
                desk.tried[i, count, 0] = row
                desk.tried[i, count, 1] = column
                desk.tried[i, count, 2] = angle
                count += 1
                total = mismatch(exemplar, row, column, angle, around, shape, desk, i, best)
                if total < best:
                    best = total
                    desk.found[i, 0] = row
                    desk.found[i, 1] = column
                    desk.found[i, 2] = angle
    if tree.points.shape[0] > 0:
        ask_tree(tree, desk, i)
        for k in range(desk.nearest.shape[1]):
            window = desk.nearest[i, k]
            if window >= 0:
                row = float(tree.centre[window, 0])
                column = float(tree.centre[window, 1])
                total = mismatch(exemplar, row, column, 0.0, around, shape, desk, i, best)
                if total < best:
                    best = total
                    desk.found[i, 0] = row
                    desk.found[i, 1] = column
                    desk.found[i, 2] = 0.0
    return wp.where(best < FAR, best / wp.max(number, 1.0), 0.0)


@wp.func
def show_source(site: int, i: int, now: int, exemplar: Exemplar, desk: Desk, canvas: Canvas):
    """The site shows found[i], from ``now`` on."""
    row = desk.found[i, 0]
    column = desk.found[i, 1]
    if canvas.position[site, 0] != row or canvas.position[site, 1] != column or canvas.turn[site] != desk.found[i, 2]:
        canvas.changed[site] = now
        canvas.position[site, 0] = row
        canvas.position[site, 1] = column
        canvas.turn[site] = desk.found[i, 2]
        for g in range(canvas.colour.shape[1]):
            canvas.colour[site, g] = sample_exemplar(exemplar.image, row, column, g)


@wp.kernel(enable_backward=False)
def find_sources(
    start: int,
    chosen: wp.array(dtype=int),  # which neighbourhoods
    around: Around,
    canvas: Canvas,
    visited: wp.array(dtype=int),  # when each neighbourhood last was
    exemplar: Exemplar,
    tree: Tree,
    desk: Desk,  # row i for chosen[i]
    cost: wp.array(dtype=float),  # of each neighbourhood, at its last visit
):
    """What every chosen site is to show, from what all show now."""
    i = start + wp.tid()
    own = chosen[i]
    if is_settled(own, around, canvas, visited):
        site = around.near[own, 0]
        desk.found[i, 0] = canvas.position[site, 0]
        desk.found[i, 1] = canvas.position[site, 1]
        desk.found[i, 2] = canvas.turn[site]
    else:
        cost[own] = find_source(own, i, around, canvas, exemplar, tree, desk)


@wp.kernel(enable_backward=False)
def show_sources(
    start: int,
    chosen: wp.array(dtype=int),
    now: int,
    around: Around,
    exemplar: Exemplar,
    desk: Desk,
    visited: wp.array(dtype=int),
    canvas: Canvas,
):
    """Every chosen site shows what was found for it."""
    i = start + wp.tid()
    show_source(around.near[chosen[i], 0], i, now, exemplar, desk, canvas)
    visited[chosen[i]] = now


@wp.kernel(enable_backward=False)
def visit_in_order(
    start: int,
    chosen: wp.array(dtype=int),
    now: int,
    around: Around,
    exemplar: Exemplar,
    tree: Tree,
    desk: Desk,  # of one row
    visited: wp.array(dtype=int),
    canvas: Canvas,
    cost: wp.array(dtype=float),
):
    """One site after the other, each seeing what those before it show: a sequence, so one item."""
    for v in range(chosen.shape[0]):
        own = chosen[v]
        if not is_settled(own, around, canvas, visited):
            cost[own] = find_source(own, 0, around, canvas, exemplar, tree, desk)
            show_source(around.near[own, 0], 0, now, exemplar, desk, canvas)
        visited[own] = now
