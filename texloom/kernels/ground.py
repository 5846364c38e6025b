"""Points on a triangle mesh (the ground): straight walks over it, the closest place from nearby, slides along its rim.

A point is a face and barycentric coordinates in it, so it never leaves the surface. ``twin[3 f + c]`` is the halfedge
on the other side of the one from corner c to the next, -1 at the rim. A point of the rim has its edge's number in
``side`` (-1 for all others) and stays there; ``following`` and ``leading`` chain the rim's halfedges.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.frames import across, between, exit_of, inverse_of, rates, shape_of, times, turn_between

MOST_FACES = wp.constant(4096)  # crossed by one walk
TINY = wp.constant(wp.float64(1.0e-290))


@wp.func
def after(h: int) -> int:
    """The next halfedge of the face."""
    return wp.where(h % 3 == 2, h - 2, h + 1)


@wp.func
def before(h: int) -> int:
    return wp.where(h % 3 == 0, h + 2, h - 1)


@wp.func
def place_at(vertex: wp.array(dtype=wp.vec3d), corner: wp.array(dtype=int), f: int, b: wp.vec3d) -> wp.vec3d:
    """The point of face f with these barycentric coordinates."""
    return b[0] * vertex[corner[3 * f]] + b[1] * vertex[corner[3 * f + 1]] + b[2] * vertex[corner[3 * f + 2]]


@wp.func
def cross_of(vertex: wp.array(dtype=wp.vec3d), corner: wp.array(dtype=int), f: int) -> wp.vec3d:
    """The normal of face f, twice as long as its area."""
    a = vertex[corner[3 * f]]
    return wp.cross(vertex[corner[3 * f + 1]] - a, vertex[corner[3 * f + 2]] - a)


@wp.func
def shape_in(vertex: wp.array(dtype=wp.vec3d), corner: wp.array(dtype=int), f: int) -> wp.vec3d:
    """The shape of face f (``texloom.kernels.frames``)."""
    return shape_of(vertex[corner[3 * f]], vertex[corner[3 * f + 1]], vertex[corner[3 * f + 2]])


@wp.func
def walk(
    vertex: wp.array(dtype=wp.vec3d),
    corner: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    face: int,
    barycentric: wp.vec3d,
    way: wp.vec3d,
    length: wp.float64,
):
    """Straight on over the ground for ``length``, starting along the part of ``way`` in the first face's plane.

    Faces are laid flat one after the other. It ends early at the rim, and in a face whose first edge has no length.
    Returns face, place and whether it went all the way.
    """
    f = int(face)
    at = barycentric
    left = wp.float64(length)
    shape = shape_in(vertex, corner, f)
    first = wp.normalize(vertex[corner[3 * f + 1]] - vertex[corner[3 * f]])
    second = wp.normalize(wp.cross(cross_of(vertex, corner, f), first))
    heading = wp.normalize(wp.vec2d(wp.dot(way, first), wp.dot(way, second)))
    entry = int(-1)  # the corner opposite the edge we came in by
    for _ in range(MOST_FACES):
        if shape[0] <= TINY:
            return f, at, False
        rate = rates(inverse_of(shape), heading)
        if entry >= 0:
            rate[entry] = wp.max(rate[entry], wp.float64(0.0))
        when, leave = exit_of(at, rate)
        if left <= when:
            at = wp.max(at + left * rate, wp.vec3d())
            return f, at / (at[0] + at[1] + at[2]), True
        at = wp.max(at + when * rate, wp.vec3d())
        left = left - when
        e = (leave + 1) % 3
        h = twin[3 * f + e]
        if h < 0:
            return f, at / (at[0] + at[1] + at[2]), False
        f = h // 3
        t = h - 3 * f
        at = across(at, e, t)
        entry = (t + 2) % 3
        onto = shape_in(vertex, corner, f)
        heading = times(heading, turn_between(shape, e, onto, t))
        shape = onto
    return f, at, False


@wp.func
def share_between(p: wp.vec3d, a: wp.vec3d, b: wp.vec3d) -> wp.float64:
    """How far along the segment from a to b its point nearest to p lies."""
    ab = b - a
    return wp.clamp(wp.dot(p - a, ab) / wp.max(wp.dot(ab, ab), TINY), wp.float64(0.0), wp.float64(1.0))


@wp.func
def nearest_in_face(vertex: wp.array(dtype=wp.vec3d), corner: wp.array(dtype=int), f: int, p: wp.vec3d):
    """Barycentric coordinates of the point of face f nearest to p, and its squared distance."""
    zero = wp.float64(0.0)
    normal = cross_of(vertex, corner, f)
    squared = wp.dot(normal, normal)
    b = wp.vec3d()
    inside = int(1)
    for c in range(3):
        from_ = vertex[corner[3 * f + (c + 1) % 3]]
        side = vertex[corner[3 * f + (c + 2) % 3]] - from_
        b[c] = wp.dot(normal, wp.cross(side, p - from_)) / wp.max(squared, TINY)
        if b[c] < zero or squared <= TINY:
            inside = 0
    if inside == 0:
        best = wp.float64(-1.0)
        for e in range(3):
            share = share_between(p, vertex[corner[3 * f + e]], vertex[corner[3 * f + (e + 1) % 3]])
            candidate = between(e, share)
            away = wp.length_sq(place_at(vertex, corner, f, candidate) - p)
            if best < zero or away < best:
                best = away
                b = candidate
        return b, best
    b = b / (b[0] + b[1] + b[2])
    return b, wp.length_sq(place_at(vertex, corner, f, b) - p)


@wp.func
def descend(
    vertex: wp.array(dtype=wp.vec3d),
    corner: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    face: int,
    p: wp.vec3d,
):
    """The place of the ground nearest to p that is reached from ``face`` by coming ever nearer: never another sheet."""
    f = int(face)
    b, away = nearest_in_face(vertex, corner, f, p)
    for _ in range(MOST_FACES):
        best_f = int(f)
        best_b = b
        best = wp.float64(away)
        for e in range(3):
            if b[(e + 2) % 3] == wp.float64(0.0):
                # On this edge: across it; at a corner, on around that, which from the other edge goes the other way
                onward = int(b[(e + 1) % 3] == wp.float64(0.0))
                h = twin[3 * f + e]
                for _ring in range(MOST_FACES):
                    if h < 0 or h // 3 == f:
                        break
                    at, far = nearest_in_face(vertex, corner, h // 3, p)
                    if far < best:
                        best_f = h // 3
                        best_b = at
                        best = far
                    if b[e] > wp.float64(0.0) and b[(e + 1) % 3] > wp.float64(0.0):
                        break
                    h = wp.where(onward == 1, twin[after(h)], twin[before(h)])
        if best_f == f or best >= away * wp.float64(1.0 - 1.0e-12):
            return f, b, away
        f = best_f
        b = best_b
        away = best
    return f, b, away


@wp.func
def slide(
    vertex: wp.array(dtype=wp.vec3d),
    corner: wp.array(dtype=int),
    following: wp.array(dtype=int),
    leading: wp.array(dtype=int),
    halfedge: int,
    share: wp.float64,
    length: wp.float64,
):
    """Along the rim from ``share`` of a halfedge, forward for ``length``, or back where it is negative."""
    h = int(halfedge)
    s = wp.float64(share)
    left = wp.float64(length)
    for _ in range(MOST_FACES):
        long = wp.max(wp.length(vertex[corner[after(h)]] - vertex[corner[h]]), TINY)
        s = s + left / long
        if s > wp.float64(1.0):
            left = (s - wp.float64(1.0)) * long
            s = wp.float64(0.0)
            h = following[h]
        elif s < wp.float64(0.0):
            left = s * long
            s = wp.float64(1.0)
            h = leading[h]
        else:
            return h, s
    return h, wp.clamp(s, wp.float64(0.0), wp.float64(1.0))
