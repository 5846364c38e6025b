"""A triangulation whose points come and go: flips, collapses and splits, on one thread in the order given.

Arrays are those of ``halfedges``; ``bend`` is what normals count for (``delaunay``), in scales.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.delaunay import flip_around, push_around, should_flip
from texloom.kernels.ground import after, before
from texloom.kernels.halfedges import MOST_AROUND, collapse, fan_start, may_collapse, next_around, split

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


@wp.kernel(enable_backward=False)
def collapse_edges(
    start: int,
    halfedge: wp.array(dtype=int),  # in the order to try them; the tail goes, unless only the head may
    most: int,
    longest: wp.float64,  # in scales
    least: wp.float64,  # cosine of the most a face may turn
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
                # The edge itself, then any other of its ends'
                g = int(-1)
                for end in range(2):
                    from_ = wp.where(end == 0, h, twin[h])
                    if g < 0 and from_ >= 0 and tail[wp.max(from_, 0)] >= frozen:
                        if may_collapse(tail, twin, first, rim, at, from_, least) == 1:
                            g = from_
                for end in range(2):
                    v = wp.where(end == 0, a, b)
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
                if g >= 0:
                    kept = tail[after(g)]
                    collapse(tail, twin, first, rim, g)
                    height = push_around(tail, twin, fan_start(twin, first[kept], rim[kept]), stack, 0)
                    flip_around(tail, twin, first, rim, at, normal, scale, bend, stack, height)
                    gone[0] = gone[0] + 1


@wp.kernel(enable_backward=False)
def split_edges(
    start: int,
    halfedge: wp.array(dtype=int),  # one of each edge, in the order to try them
    most: int,
    points: int,  # the first ones; point ``points + i`` goes onto edge i
    faces: int,
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
        if fresh == 1 and count[0] < most:
            v = points + i
            split(tail, twin, first, h, v, 3 * (faces + count[1]))
            count[0] = count[0] + 1
            count[1] = count[1] + wp.where(t < 0, 1, 2)
            height = push_around(tail, twin, fan_start(twin, first[v], rim[v]), stack, 0)
            flip_around(tail, twin, first, rim, at, normal, scale, bend, stack, height)
