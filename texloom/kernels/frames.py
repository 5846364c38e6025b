"""Triangles in their own 2-D frames (corner 0 at the origin, corner 1 on the first axis), and vectors in them.

A triangle's shape is (a, b, c): its corners lie at (0, 0), (a, 0) and (b, c). Functions on ``Any`` serve both
precisions: the tracer's and the points'.
"""

from typing import Any

import warp as wp


@wp.func
def shape_of(p: wp.vec3d, q: wp.vec3d, r: wp.vec3d) -> wp.vec3d:
    """The shape of a triangle in space. A needle keeps a height to divide by."""
    along = q - p
    a = wp.length(along)
    x = along / wp.max(a, wp.float64(1.0e-300))
    return wp.vec3d(a, wp.dot(r - p, x), wp.max(wp.length(wp.cross(x, r - p)), wp.float64(1.0e-6) * a))


@wp.func
def inverse_of(shape: wp.vec3d) -> wp.vec3d:
    """1 / a, b / (a c), 1 / c: what ``rates`` take."""
    one = wp.float64(1.0)
    return wp.vec3d(one / shape[0], shape[1] / (shape[0] * shape[2]), one / shape[2])


@wp.func
def direction_of_edge(shape: wp.vec3d, e: int) -> wp.vec2d:
    """From corner e towards the next, a unit vector."""
    a = shape[0]
    b = shape[1]
    c = shape[2]
    zero = wp.float64(0.0)
    x = wp.where(e == 0, a, wp.where(e == 1, b - a, -b))
    y = wp.where(e == 0, zero, wp.where(e == 1, c, -c))
    return wp.normalize(wp.vec2d(x, y))


@wp.func
def turn_between(shape: wp.vec3d, e: int, onto: wp.vec3d, t: int) -> wp.vec2d:
    """The rotation from the frame of a triangle to that of the one across its edge e, which is edge t there."""
    mine = direction_of_edge(shape, e)
    theirs = direction_of_edge(onto, t)  # which runs the other way
    x = -(theirs[0] * mine[0] + theirs[1] * mine[1])
    y = -(theirs[1] * mine[0] - theirs[0] * mine[1])
    return wp.vec2d(x, y)


@wp.func
def times(p: Any, q: Any):
    """Product of complex numbers."""
    return type(p)(p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0])


@wp.func
def rates(inverse: Any, way: Any):
    """Change of the barycentric coordinates along ``way``."""
    r1 = way[0] * inverse[0] - way[1] * inverse[1]
    r2 = way[1] * inverse[2]
    return type(inverse)(-r1 - r2, r1, r2)


@wp.func
def time_to_zero(at: Any, rate: Any):
    """When a coordinate reaches 0; never, unless it falls."""
    return wp.where(rate < type(rate)(0.0), -at / rate, type(rate)(1.0e30))


@wp.func
def exit_of(at: Any, rate: Any):
    """When the first coordinate reaches 0, and which: the corner opposite the edge that is reached."""
    t0 = time_to_zero(at[0], rate[0])
    t1 = time_to_zero(at[1], rate[1])
    t2 = time_to_zero(at[2], rate[2])
    when = wp.min(t0, wp.min(t1, t2))
    return when, wp.where(t0 == when, 0, wp.where(t1 == when, 1, 2))


@wp.func
def component(p: Any, i: int):
    return wp.where(i == 0, p[0], wp.where(i == 1, p[1], p[2]))


@wp.func
def between(e: int, share: Any):
    """The point on edge e that has come so far from corner e to the next."""
    rest = type(share)(1.0) - share
    zero = type(share)(0.0)
    return wp.vector(
        wp.where(e == 0, rest, wp.where(e == 1, zero, share)),
        wp.where(e == 1, rest, wp.where(e == 2, zero, share)),
        wp.where(e == 2, rest, wp.where(e == 0, zero, share)),
    )


@wp.func
def across(at: Any, e: int, t: int):
    """A place on edge e of a triangle, in the one beyond, whose edge t that is."""
    ahead = component(at, e)
    share = ahead / (ahead + component(at, wp.where(e == 2, 0, e + 1)))
    return between(t, wp.clamp(share, type(share)(0.0), type(share)(1.0)))


@wp.kernel(enable_backward=False)
def flatten_triangles(
    start: int, vertices: wp.array(dtype=wp.vec3d), faces: wp.array2d(dtype=int), corners: wp.array(dtype=wp.vec3d)
):
    """The shape of every triangle."""
    f = start + wp.tid()
    corners[f] = shape_of(vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]])


@wp.kernel(enable_backward=False)
def pack_records(
    start: int,
    corners: wp.array(dtype=wp.vec3d),
    power: wp.array2d(dtype=wp.vec2),
    texel: wp.array(dtype=float),  # of every site
    faces: wp.array2d(dtype=int),
    twin: wp.array2d(dtype=int),
    record: wp.array2d(dtype=float),
):
    """What the tracer reads of a triangle (``texloom.kernels.trace``)."""
    f = start + wp.tid()
    for e in range(3):
        record[f, 3 + 2 * e] = power[f, e][0]
        record[f, 4 + 2 * e] = power[f, e][1]
        record[f, 9 + e] = texel[faces[f, e]]
        halfedge = twin[f, e]
        turn = wp.vec2d(wp.float64(1.0), wp.float64(0.0))
        if halfedge >= 0:
            turn = turn_between(corners[f], e, corners[halfedge // 3], halfedge % 3)
        record[f, 12 + 2 * e] = float(turn[0])
        record[f, 13 + 2 * e] = float(turn[1])
    inverse = inverse_of(corners[f])
    for k in range(3):
        record[f, k] = float(corners[f][k])
        record[f, 18 + k] = float(inverse[k])
    for k in range(21, 24):
        record[f, k] = 0.0


@wp.kernel(enable_backward=False)
def lay_into_faces(
    start: int,
    faces: wp.array2d(dtype=int),
    frames: wp.array2d(dtype=wp.vec3d),
    normals: wp.array(dtype=wp.vec3d),
    tangents: wp.array(dtype=wp.vec3d),
    directions: wp.array2d(dtype=wp.vec2d),
):
    """A tangent vector of each vertex in the frames of the faces around it, made a unit vector (0 stays 0).

    R t = t - (n · t) (N + n) / (1 + N · n) takes a tangent t of normal N to one of normal n, by the least rotation.
    """
    f = start + wp.tid()
    x = frames[f, 0]
    y = frames[f, 1]
    n = wp.cross(x, y)
    for k in range(3):
        normal = normals[faces[f, k]]
        t = tangents[faces[f, k]]
        share = wp.dot(n, t) / (wp.float64(1.0) + wp.max(wp.dot(n, normal), wp.float64(-0.999)))
        laid = wp.vec2d(wp.dot(x, t) - share * wp.dot(x, normal), wp.dot(y, t) - share * wp.dot(y, normal))
        directions[f, k] = wp.normalize(laid)
