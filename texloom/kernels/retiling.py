"""A triangulation whose points come and go: flips, collapses and splits, on one thread in the order given.

``bend`` is what normals count for (``delaunay``), in scales.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.delaunay import facing, flip_around, push_around, should_flip
from texloom.kernels.ground import Places, after, before
from texloom.kernels.halfedges import MOST_AROUND, Net, collapse, fan_start, may_collapse, next_around, split

LEAST_TURN = wp.constant(wp.float64(0.2))  # cosine of the most a face turns when a point beside it goes, if it may
HALF = wp.constant(wp.float64(0.5))


@wp.kernel(enable_backward=False)
def mark_flips(
    start: int,
    halfedge: wp.array(dtype=int),
    net: Net,
    places: Places,
    bend: wp.float64,
    marked: wp.array(dtype=wp.uint8),
):
    """Which edges want to be flipped, at the higher of their halfedges."""
    i = start + wp.tid()
    h = halfedge[i]
    marked[i] = wp.uint8(0)
    if h > net.twin[h]:
        marked[i] = wp.uint8(should_flip(net, places, bend, h))


@wp.kernel(enable_backward=False)
def flip_edges(
    start: int,
    height: int,
    places: Places,
    bend: wp.float64,
    stack: wp.array(dtype=int),
    net: Net,
    flips: wp.array(dtype=int),
):
    """Flip the edges on the stack, and those around them, until all are Delaunay. One thread."""
    flips[0] = flip_around(net, places, bend, stack, height)


@wp.func
def way_out(net: Net, places: Places, h: int, frozen: int, least: wp.float64) -> int:
    """A halfedge by which an end of this edge can go into a neighbour: the edge itself, then any other; -1 for none."""
    g = int(-1)
    for end in range(2):
        from_ = wp.where(end == 0, h, net.twin[h])
        if g < 0 and from_ >= 0 and net.tail[wp.max(from_, 0)] >= frozen:
            if may_collapse(net, places, from_, least) == 1:
                g = from_
    for end in range(2):
        v = wp.where(end == 0, net.tail[h], net.tail[after(h)])
        if g < 0 and v >= frozen:
            begin = fan_start(net, v)
            e = int(begin)
            for _ in range(MOST_AROUND):
                if may_collapse(net, places, e, least) == 1:
                    g = e
                    break
                e = next_around(net, e, begin)
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
    places: Places,
    bend: wp.float64,
    stack: wp.array(dtype=int),
    net: Net,
    gone: wp.array(dtype=int),
):
    """Take out one end of each edge that is short, and keep the rest Delaunay; ``gone`` counts them. One thread."""
    for i in range(halfedge.shape[0]):
        h = int(halfedge[i])
        if gone[0] < most and net.tail[h] >= 0:
            a = net.tail[h]
            b = net.tail[after(h)]
            if wp.length(places.at[a] - places.at[b]) < longest * HALF * (places.scale[a] + places.scale[b]):
                g = way_out(net, places, h, frozen, wp.max(least, LEAST_TURN))
                if g < 0 and least < LEAST_TURN:
                    g = way_out(net, places, h, frozen, least)
                if g >= 0:
                    kept = net.tail[after(g)]
                    collapse(net, g)
                    height = push_around(net, fan_start(net, kept), stack, 0)
                    flip_around(net, places, bend, stack, height)
                    gone[0] = gone[0] + 1


@wp.func
def overturns(net: Net, places: Places, h: int, v: int) -> bool:
    """Whether cutting an edge at point v makes a face that opposes the ground, more than a face there does now.

    The rim is followed whatever comes of it.
    """
    over = bool(False)
    for side in range(2):
        g = wp.where(side == 0, h, net.twin[h])
        if net.twin[h] >= 0:
            a = net.tail[g]
            b = net.tail[after(g)]
            c = net.tail[before(g)]
            then = wp.min(facing(places, a, v, c), facing(places, v, b, c))
            if then < wp.float64(0.0) and then < facing(places, a, b, c):
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
    places: Places,
    bend: wp.float64,
    stack: wp.array(dtype=int),
    net: Net,
    count: wp.array(dtype=int),  # new points and new faces
):
    """Put new points on edges whose faces have none yet, and keep the rest Delaunay. One thread."""
    for i in range(halfedge.shape[0]):
        h = int(halfedge[i])
        t = int(net.twin[h])
        fresh = int(net.tail[h] < points and net.tail[after(h)] < points and net.tail[before(h)] < points)
        if t >= 0:
            if net.tail[before(t)] >= points:
                fresh = 0
        v = points + i
        if fresh == 1 and count[0] < most and (anyhow or not overturns(net, places, h, v)):
            split(net, h, v, 3 * (faces + count[1]))
            count[0] = count[0] + 1
            count[1] = count[1] + wp.where(t < 0, 1, 2)
            height = push_around(net, fan_start(net, v), stack, 0)
            flip_around(net, places, bend, stack, height)
