"""Triangles in their own 2-D frames (corner 0 at the origin, corner 1 on the first axis), and vectors in them."""

import warp as wp


@wp.kernel(enable_backward=False)
def flatten_triangles(
    start: int, vertices: wp.array(dtype=wp.vec3d), faces: wp.array2d(dtype=int), corners: wp.array(dtype=wp.vec3d)
):
    """(a, b, c) of every triangle: corners at (0, 0), (a, 0) and (b, c). A needle keeps a height to divide by."""
    f = start + wp.tid()
    p = vertices[faces[f, 0]]
    q = vertices[faces[f, 1]] - p
    r = vertices[faces[f, 2]] - p
    a = wp.length(q)
    x = q / wp.max(a, wp.float64(1.0e-300))
    corners[f] = wp.vec3d(a, wp.dot(r, x), wp.max(wp.length(wp.cross(x, r)), wp.float64(1.0e-6) * a))


@wp.func
def direction_of_edge(corners: wp.array(dtype=wp.vec3d), f: int, e: int) -> wp.vec2d:
    """From corner e towards the next, a unit vector."""
    a = corners[f][0]
    b = corners[f][1]
    c = corners[f][2]
    zero = wp.float64(0.0)
    x = wp.where(e == 0, a, wp.where(e == 1, b - a, -b))
    y = wp.where(e == 0, zero, wp.where(e == 1, c, -c))
    return wp.normalize(wp.vec2d(x, y))


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
    a = corners[f][0]
    b = corners[f][1]
    c = corners[f][2]
    record[f, 0] = float(a)
    record[f, 1] = float(b)
    record[f, 2] = float(c)
    for e in range(3):
        record[f, 3 + 2 * e] = power[f, e][0]
        record[f, 4 + 2 * e] = power[f, e][1]
        record[f, 9 + e] = texel[faces[f, e]]
        halfedge = twin[f, e]
        x = wp.float64(1.0)
        y = wp.float64(0.0)
        if halfedge >= 0:
            mine = direction_of_edge(corners, f, e)
            theirs = direction_of_edge(corners, halfedge // 3, halfedge % 3)  # which runs the other way
            x = -(theirs[0] * mine[0] + theirs[1] * mine[1])
            y = -(theirs[1] * mine[0] - theirs[0] * mine[1])
        record[f, 12 + 2 * e] = float(x)
        record[f, 13 + 2 * e] = float(y)
    record[f, 18] = float(wp.float64(1.0) / a)
    record[f, 19] = float(b / (a * c))
    record[f, 20] = float(wp.float64(1.0) / c)
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
