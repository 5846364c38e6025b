"""A triangulation whose points come and go: flips, collapses and splits, on one thread in the order given.

Arrays are those of ``halfedges``; ``bend`` is what normals count for (``delaunay``), in scales.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.delaunay import facing, flip_around, push_around, should_flip
from texloom.kernels.ground import after, before
from texloom.kernels.halfedges import MOST_AROUND, collapse, fan_start, may_collapse, next_around, split

LEAST_TURN = wp.constant(wp.float64(0.2))  # cosine of the most a face turns when a point beside it goes, if it may
HALF = wp.constant(wp.float64(0.5))


@wp.kernel(enable_backward=False)
def mark_flips(
    start: int,
    halfedge: wp.array(dtype=int),
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    bend: wp.float64,
    marked: wp.array(dtype=wp.uint8),
):
    """Which edges want to be flipped, at the higher of their halfedges."""
    i = start + wp.tid()
    h = halfedge[i]
    marked[i] = wp.uint8(0)
    if h > twin[h]:
        marked[i] = wp.uint8(should_flip(tail, twin, at, normal, scale, bend, h))


@wp.kernel(enable_backward=False)
def flip_edges(
    start: int,
    height: int,
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    bend: wp.float64,
    rim: wp.array(dtype=int),
    stack: wp.array(dtype=int),
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    first: wp.array(dtype=int),
    flips: wp.array(dtype=int),
):
    """Flip the edges on the stack, and those around them, until all are Delaunay. One thread."""
    flips[0] = flip_around(tail, twin, first, rim, at, normal, scale, bend, stack, height)


@wp.func
def way_out(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    first: wp.array(dtype=int),
    rim: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    h: int,
    frozen: int,
    least: wp.float64,
) -> int:
    """A halfedge by which an end of this edge can go into a neighbour: the edge itself, then any other; -1 for none."""
    g = int(-1)
    for end in range(2):
        from_ = wp.where(end == 0, h, twin[h])
        if g < 0 and from_ >= 0 and tail[wp.max(from_, 0)] >= frozen:
            if may_collapse(tail, twin, first, rim, at, from_, least) == 1:
                g = from_
    for end in range(2):
        v = wp.where(end == 0, tail[h], tail[after(h)])
        if g < 0 and v >= frozen:
            begin = fan_start(twin, first[v], rim[v])
            e = int(begin)
            for _ in range(MOST_AROUND):
                if may_collapse(tail, twin, first, rim, at, e, least) == 1:
                    g = e
                    break
                e = next_around(twin, e, begin)
                if e < 0:
                    break
    return g


@wp.kernel(enable_backward=False)
def collapse_edges(
    start: int,
    halfedge: wp.array(dtype=int),  # in the order to try them; the tail goes, unless only the head may
    most: int,
    longest: wp.float64,  # in scales
    least: wp.float64,  # cosine of the most a face may turn; less than that is tried first
    frozen: int,
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    bend: wp.float64,
    rim: wp.array(dtype=int),
    stack: wp.array(dtype=int),
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    first: wp.array(dtype=int),
    gone: wp.array(dtype=int),
):
    """Take out one end of each edge that is short, and keep the rest Delaunay; ``gone`` counts them. One thread."""
    for i in range(halfedge.shape[0]):
        h = int(halfedge[i])
        if gone[0] < most and tail[h] >= 0:
            a = tail[h]
            b = tail[after(h)]
            if wp.length(at[a] - at[b]) < longest * HALF * (scale[a] + scale[b]):
                g = way_out(tail, twin, first, rim, at, h, frozen, wp.max(least, LEAST_TURN))
                if g < 0 and least < LEAST_TURN:
                    g = way_out(tail, twin, first, rim, at, h, frozen, least)
                if g >= 0:
                    kept = tail[after(g)]
                    collapse(tail, twin, first, rim, g)
                    height = push_around(tail, twin, fan_start(twin, first[kept], rim[kept]), stack, 0)
                    flip_around(tail, twin, first, rim, at, normal, scale, bend, stack, height)
                    gone[0] = gone[0] + 1


@wp.func
def overturns(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    h: int,
    v: int,
) -> bool:
    """Whether cutting an edge at point v makes a face that opposes the ground, more than a face there does now.

    The rim is followed whatever comes of it.
    """
    over = bool(False)
    for side in range(2):
        g = wp.where(side == 0, h, twin[h])
        if twin[h] >= 0:
            a = tail[g]
            b = tail[after(g)]
            c = tail[before(g)]
            then = wp.min(facing(at, normal, a, v, c), facing(at, normal, v, b, c))
            if then < wp.float64(0.0) and then < facing(at, normal, a, b, c):
                over = True
    return over


@wp.kernel(enable_backward=False)
def split_edges(
    start: int,
    halfedge: wp.array(dtype=int),  # one of each edge, in the order to try them
    most: int,
    points: int,  # the first ones; point ``points + i`` goes onto edge i
    faces: int,
    anyhow: bool,  # even where a face would oppose the ground
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    bend: wp.float64,
    rim: wp.array(dtype=int),
    stack: wp.array(dtype=int),
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    first: wp.array(dtype=int),
    count: wp.array(dtype=int),  # new points and new faces
):
    """Put new points on edges whose faces have none yet, and keep the rest Delaunay. One thread."""
    for i in range(halfedge.shape[0]):
        h = int(halfedge[i])
        t = int(twin[h])
        fresh = int(tail[h] < points and tail[after(h)] < points and tail[before(h)] < points)
        if t >= 0:
            if tail[before(t)] >= points:
                fresh = 0
        v = points + i
        if fresh == 1 and count[0] < most and (anyhow or not overturns(tail, twin, at, normal, h, v)):
            split(tail, twin, first, h, v, 3 * (faces + count[1]))
            count[0] = count[0] + 1
            count[1] = count[1] + wp.where(t < 0, 1, 2)
            height = push_around(tail, twin, fan_start(twin, first[v], rim[v]), stack, 0)
            flip_around(tail, twin, first, rim, at, normal, scale, bend, stack, height)
