"""What the choice of a texel reads: neighbourhoods, what they show, the exemplar, a tree of its windows."""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.patches import sample_exemplar
from texloom.kernels.tree import search_tree

FAR = wp.constant(1.0e30)


@wp.struct
class Canvas:
    """What each site shows; ``changed`` is when it last did."""

    position: wp.array2d(dtype=float)
    turn: wp.array(dtype=float)
    colour: wp.array2d(dtype=wp.vec4)  # channels in fours
    label: wp.array(dtype=int)
    changed: wp.array(dtype=int)
    kind: wp.array(dtype=wp.uint8)  # empty where all are 1


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
    usable: wp.array2d(dtype=wp.uint8)  # the kind of site that each texel may serve, 0 none
    axis: wp.array2d(dtype=float)  # the angle of each texel's own axes; empty where all are 0
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
def is_usable(usable: wp.array2d(dtype=wp.uint8), row: float, column: float, kind: wp.uint8) -> bool:
    """Whether a whole neighbourhood lies in the exemplar around (row, column), where it serves that kind of site."""
    r = int(wp.round(row))
    c = int(wp.round(column))
    if r < 0 or c < 0 or r >= usable.shape[0] or c >= usable.shape[1]:
        return False
    return usable[r, c] == kind


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
