"""Delaunay flips on a surface: judged in space times normals, so that the two sides of a thin sheet stay apart."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.ground import Places, after, before
from texloom.kernels.halfedges import MOST_AROUND, Net, are_joined, fan_start, flip, next_around

WELL_LAID = wp.constant(wp.float64(0.3))  # least cosine between a face and the ground at its corners to be trusted
LEAST_GAIN = wp.constant(wp.float64(1.0e-4))  # sine of the angle two opposite corners must exceed π by
FLIPS_A_STACK = wp.constant(64)  # for each entry at the start: an end where rounding makes flips go in circles


@wp.func
def corner_of(places: Places, bend: wp.float64, c: int, a: int, b: int):
    """Cosine and sine of the corner at c of a triangle in space times normals, these ``bend`` times as long."""
    p = places.at[a] - places.at[c]
    m = bend * (places.normal[a] - places.normal[c])
    q = places.at[b] - places.at[c]
    n = bend * (places.normal[b] - places.normal[c])
    along = wp.dot(p, q) + wp.dot(m, n)
    squares = (wp.length_sq(p) + wp.length_sq(m)) * (wp.length_sq(q) + wp.length_sq(n))
    size = wp.sqrt(wp.max(squares, wp.float64(1.0e-300)))
    return along / size, wp.sqrt(wp.max(squares - along * along, wp.float64(0.0))) / size


@wp.func
def excess(places: Places, bend: wp.float64, a: int, b: int, c: int, d: int) -> wp.float64:
    """Sine of what the corners at c and d, opposite edge a b, exceed π by: above 0 the edge is not Delaunay.

    So the two sides of a sheet are far from each other.
    """
    c_cos, c_sin = corner_of(places, bend, c, a, b)
    d_cos, d_sin = corner_of(places, bend, d, a, b)
    return -(c_sin * d_cos + c_cos * d_sin)


@wp.func
def facing(places: Places, a: int, b: int, c: int) -> wp.float64:
    """Cosine between a triangle's normal and those of the ground at its corners, less where these differ."""
    across = wp.normalize(wp.cross(places.at[b] - places.at[a], places.at[c] - places.at[a]))
    return wp.dot(across, places.normal[a] + places.normal[b] + places.normal[c]) / wp.float64(3.0)


@wp.func
def should_flip(net: Net, places: Places, bend: wp.float64, h: int) -> int:
    """Whether the other diagonal is more nearly Delaunay and its faces lie on the ground as well as these."""
    t = net.twin[h]
    if t < 0 or net.tail[h] < 0:
        return 0
    a = net.tail[h]
    b = net.tail[t]
    c = net.tail[before(h)]
    d = net.tail[before(t)]
    local = bend * wp.float64(0.5) * (places.scale[a] + places.scale[b])
    now = excess(places, local, a, b, c, d)
    if now < LEAST_GAIN or excess(places, local, c, d, a, b) > now:
        return 0
    before_ = wp.min(facing(places, a, b, c), facing(places, b, a, d))
    then = wp.min(facing(places, a, d, c), facing(places, b, c, d))
    if then < WELL_LAID and then < before_:
        return 0
    return 1


@wp.func
def flip_around(net: Net, places: Places, bend: wp.float64, stack: wp.array(dtype=int), height: int) -> int:
    """Lawson's flips: edges on the stack, then those around each that was flipped. Returns how many were."""
    top = int(height)
    flips = int(0)
    most = FLIPS_A_STACK * (height + 4)
    while top > 0 and flips < most:
        top = top - 1
        h = stack[top]
        if should_flip(net, places, bend, h) == 1:
            c = net.tail[before(h)]
            d = net.tail[before(net.twin[h])]
            if c != d and are_joined(net, fan_start(net, c), d) == 0:
                t = net.twin[h]
                flip(net, h)
                flips = flips + 1
                if top + 4 < stack.shape[0]:
                    stack[top] = after(h)
                    stack[top + 1] = before(h)
                    stack[top + 2] = after(t)
                    stack[top + 3] = before(t)
                    top = top + 4
    return flips


@wp.func
def push_around(net: Net, start: int, stack: wp.array(dtype=int), height: int) -> int:
    """Put the edges from a vertex, and those across, on the stack; returns its height."""
    top = int(height)
    h = int(start)
    for _ in range(MOST_AROUND):
        if top + 2 < stack.shape[0]:
            stack[top] = h
            stack[top + 1] = after(h)
            top = top + 2
        h = next_around(net, h, start)
        if h < 0:
            break
    return top
