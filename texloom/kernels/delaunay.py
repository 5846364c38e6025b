"""Delaunay flips on a surface: judged in space times normals, so that the two sides of a thin sheet stay apart."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.ground import after, before
from texloom.kernels.halfedges import MOST_AROUND, are_joined, fan_start, flip, next_around

WELL_LAID = wp.constant(wp.float64(0.3))  # least cosine between a face and the ground at its corners to be trusted
LEAST_GAIN = wp.constant(wp.float64(1.0e-4))  # sine of the angle two opposite corners must exceed π by
FLIPS_A_STACK = wp.constant(64)  # for each entry at the start: an end where rounding makes flips go in circles


@wp.func
def opposite(p: wp.vec3d, m: wp.vec3d, q: wp.vec3d, n: wp.vec3d):
    """Cosine and sine of the corner between two sides of a triangle in space times normals."""
    along = wp.dot(p, q) + wp.dot(m, n)
    squares = (wp.length_sq(p) + wp.length_sq(m)) * (wp.length_sq(q) + wp.length_sq(n))
    size = wp.sqrt(wp.max(squares, wp.float64(1.0e-300)))
    return along / size, wp.sqrt(wp.max(squares - along * along, wp.float64(0.0))) / size


@wp.func
def excess(
    at: wp.array(dtype=wp.vec3d), normal: wp.array(dtype=wp.vec3d), bend: wp.float64, a: int, b: int, c: int, d: int
) -> wp.float64:
    """Sine of what the corners at c and d, opposite edge a b, exceed π by: above 0 the edge is not Delaunay.

    Normals count as ``bend`` times their difference: the two sides of a sheet are far from each other.
    """
    c_cos, c_sin = opposite(
        at[a] - at[c], bend * (normal[a] - normal[c]), at[b] - at[c], bend * (normal[b] - normal[c])
    )
    d_cos, d_sin = opposite(
        at[a] - at[d], bend * (normal[a] - normal[d]), at[b] - at[d], bend * (normal[b] - normal[d])
    )
    return -(c_sin * d_cos + c_cos * d_sin)


@wp.func
def facing(at: wp.array(dtype=wp.vec3d), normal: wp.array(dtype=wp.vec3d), a: int, b: int, c: int) -> wp.float64:
    """Cosine between a triangle's normal and those of the ground at its corners, less where these differ."""
    across = wp.normalize(wp.cross(at[b] - at[a], at[c] - at[a]))
    return wp.dot(across, normal[a] + normal[b] + normal[c]) / wp.float64(3.0)


@wp.func
def should_flip(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    bend: wp.float64,
    h: int,
) -> int:
    """Whether the other diagonal is more nearly Delaunay and its faces lie on the ground as well as these."""
    t = twin[h]
    if t < 0 or tail[h] < 0:
        return 0
    a = tail[h]
    b = tail[t]
    c = tail[before(h)]
    d = tail[before(t)]
    local = bend * wp.float64(0.5) * (scale[a] + scale[b])
    now = excess(at, normal, local, a, b, c, d)
    if now < LEAST_GAIN or excess(at, normal, local, c, d, a, b) > now:
        return 0
    before_ = wp.min(facing(at, normal, a, b, c), facing(at, normal, b, a, d))
    then = wp.min(facing(at, normal, a, d, c), facing(at, normal, b, c, d))
    if then < WELL_LAID and then < before_:
        return 0
    return 1


@wp.func
def flip_around(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    first: wp.array(dtype=int),
    rim: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    bend: wp.float64,
    stack: wp.array(dtype=int),
    height: int,
) -> int:
    """Lawson's flips: edges on the stack, then those around each that was flipped. Returns how many were."""
    top = int(height)
    flips = int(0)
    most = FLIPS_A_STACK * (height + 4)
    while top > 0 and flips < most:
        top = top - 1
        h = stack[top]
        if should_flip(tail, twin, at, normal, scale, bend, h) == 1:
            c = tail[before(h)]
            d = tail[before(twin[h])]
            if c != d and are_joined(tail, twin, fan_start(twin, first[c], rim[c]), d) == 0:
                t = twin[h]
                flip(tail, twin, first, h)
                flips = flips + 1
                if top + 4 < stack.shape[0]:
                    stack[top] = after(h)
                    stack[top + 1] = before(h)
                    stack[top + 2] = after(t)
                    stack[top + 3] = before(t)
                    top = top + 4
    return flips


@wp.func
def push_around(
    tail: wp.array(dtype=int), twin: wp.array(dtype=int), start: int, stack: wp.array(dtype=int), height: int
) -> int:
    """Put the edges from a vertex, and those across, on the stack; returns its height."""
    top = int(height)
    h = int(start)
    for _ in range(MOST_AROUND):
        if top + 2 < stack.shape[0]:
            stack[top] = h
            stack[top + 1] = after(h)
            top = top + 2
        h = next_around(twin, h, start)
        if h < 0:
            break
    return top
