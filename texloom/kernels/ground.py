"""Points on a triangle mesh (the ground): straight walks over it, the closest place from nearby, slides along its rim.

A point is a face and barycentric coordinates in it, so it never leaves the surface. Halfedge 3 f + c runs from corner c
of face f to the next. A point of the rim stays on its edge there.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.frames import across, between, exit_of, inverse_of, rates, shape_of, times, turn_between

MOST_FACES = wp.constant(4096)  # crossed by one walk
TINY = wp.constant(wp.float64(1.0e-290))


@wp.struct
class Ground:
    """The mesh; to walk and descend on it takes no more than the first three."""

    vertex: wp.array(dtype=wp.vec3d)  # from the origin
    corner: wp.array(dtype=int)  # the vertex that each halfedge runs from
    twin: wp.array(dtype=int)  # the halfedge on the other side of each, -1: the rim
    following: wp.array(dtype=int)  # the halfedge of the rim after each, -1 inside
    leading: wp.array(dtype=int)  # the one before it
    scale: wp.array(dtype=wp.float64)  # of each vertex
    normal: wp.array(dtype=wp.vec3d)  # unit, where each halfedge begins


@wp.struct
class Places:
    """Points on the ground."""

    at: wp.array(dtype=wp.vec3d)  # from the origin
    scale: wp.array(dtype=wp.float64)  # how far apart they want to be, relative
    normal: wp.array(dtype=wp.vec3d)  # unit
    face: wp.array(dtype=int)
    barycentric: wp.array(dtype=wp.vec3d)
    side: wp.array(dtype=int)  # the face's edge on the rim that a point keeps to, -1 inside


@wp.func
def after(h: int) -> int:
    """The next halfedge of the face."""
    return wp.where(h % 3 == 2, h - 2, h + 1)


@wp.func
def before(h: int) -> int:
    return wp.where(h % 3 == 0, h + 2, h - 1)


@wp.func
def tail_at(ground: Ground, h: int) -> wp.vec3d:
    """The point where halfedge h begins."""
    return ground.vertex[ground.corner[h]]


@wp.func
def length_of(ground: Ground, h: int) -> wp.float64:
    return wp.length(tail_at(ground, after(h)) - tail_at(ground, h))


@wp.func
def place_at(ground: Ground, f: int, b: wp.vec3d) -> wp.vec3d:
    """The point of face f with these barycentric coordinates."""
    return b[0] * tail_at(ground, 3 * f) + b[1] * tail_at(ground, 3 * f + 1) + b[2] * tail_at(ground, 3 * f + 2)


@wp.func
def scale_at(ground: Ground, f: int, b: wp.vec3d) -> wp.float64:
    scale = wp.vec3d()
    for c in range(3):
        scale[c] = ground.scale[ground.corner[3 * f + c]]
    return b[0] * scale[0] + b[1] * scale[1] + b[2] * scale[2]


@wp.func
def normal_at(ground: Ground, f: int, b: wp.vec3d) -> wp.vec3d:
    return wp.normalize(b[0] * ground.normal[3 * f] + b[1] * ground.normal[3 * f + 1] + b[2] * ground.normal[3 * f + 2])


@wp.func
def put(ground: Ground, f: int, b: wp.vec3d, side: int, i: int, places: Places):
    """places[i] = this place, with what the ground tells of it."""
    places.at[i] = place_at(ground, f, b)
    places.scale[i] = scale_at(ground, f, b)
    places.normal[i] = normal_at(ground, f, b)
    places.face[i] = f
    places.barycentric[i] = b
    places.side[i] = side


@wp.func
def cross_of(ground: Ground, f: int) -> wp.vec3d:
    """The normal of face f, twice as long as its area."""
    a = tail_at(ground, 3 * f)
    return wp.cross(tail_at(ground, 3 * f + 1) - a, tail_at(ground, 3 * f + 2) - a)


@wp.func
def shape_in(ground: Ground, f: int) -> wp.vec3d:
    """The shape of face f (``texloom.kernels.frames``)."""
    return shape_of(tail_at(ground, 3 * f), tail_at(ground, 3 * f + 1), tail_at(ground, 3 * f + 2))


@wp.func
def walk(ground: Ground, face: int, barycentric: wp.vec3d, way: wp.vec3d, length: wp.float64):
    """Straight on over the ground for ``length``, starting along the part of ``way`` in the first face's plane.

    Faces are laid flat one after the other. It ends early at the rim, and in a face whose first edge has no length.
    Returns face, place and whether it went all the way.
    """
    f = int(face)
    at = barycentric
    left = wp.float64(length)
    shape = shape_in(ground, f)
    first = wp.normalize(tail_at(ground, 3 * f + 1) - tail_at(ground, 3 * f))
    second = wp.normalize(wp.cross(cross_of(ground, f), first))
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
        h = ground.twin[3 * f + e]
        if h < 0:
            return f, at / (at[0] + at[1] + at[2]), False
        f = h // 3
        t = h - 3 * f
        at = across(at, e, t)
        entry = (t + 2) % 3
        onto = shape_in(ground, f)
        heading = times(heading, turn_between(shape, e, onto, t))
        shape = onto
    return f, at, False


@wp.func
def share_between(p: wp.vec3d, a: wp.vec3d, b: wp.vec3d) -> wp.float64:
    """How far along the segment from a to b its point nearest to p lies."""
    ab = b - a
    return wp.clamp(wp.dot(p - a, ab) / wp.max(wp.dot(ab, ab), TINY), wp.float64(0.0), wp.float64(1.0))


@wp.func
def nearest_in_face(ground: Ground, f: int, p: wp.vec3d):
    """Barycentric coordinates of the point of face f nearest to p, and its squared distance."""
    zero = wp.float64(0.0)
    normal = cross_of(ground, f)
    squared = wp.dot(normal, normal)
    b = wp.vec3d()
    inside = int(1)
    for c in range(3):
        from_ = tail_at(ground, 3 * f + (c + 1) % 3)
        side = tail_at(ground, 3 * f + (c + 2) % 3) - from_
        b[c] = wp.dot(normal, wp.cross(side, p - from_)) / wp.max(squared, TINY)
        if b[c] < zero or squared <= TINY:
            inside = 0
    if inside == 0:
        best = wp.float64(-1.0)
        for e in range(3):
            share = share_between(p, tail_at(ground, 3 * f + e), tail_at(ground, 3 * f + (e + 1) % 3))
            candidate = between(e, share)
            away = wp.length_sq(place_at(ground, f, candidate) - p)
            if best < zero or away < best:
                best = away
                b = candidate
        return b, best
    b = b / (b[0] + b[1] + b[2])
    return b, wp.length_sq(place_at(ground, f, b) - p)


@wp.func
def descend(ground: Ground, face: int, p: wp.vec3d):
    """The place of the ground nearest to p that is reached from ``face`` by coming ever nearer: never another sheet."""
    f = int(face)
    b, away = nearest_in_face(ground, f, p)
    for _ in range(MOST_FACES):
        best_f = int(f)
        best_b = b
        best = wp.float64(away)
        for e in range(3):
            if b[(e + 2) % 3] == wp.float64(0.0):
                # On this edge: across it; at a corner, on around that, which from the other edge goes the other way
                onward = int(b[(e + 1) % 3] == wp.float64(0.0))
                h = ground.twin[3 * f + e]
                for _ring in range(MOST_FACES):
                    if h < 0 or h // 3 == f:
                        break
                    at, far = nearest_in_face(ground, h // 3, p)
                    if far < best:
                        best_f = h // 3
                        best_b = at
                        best = far
                    if b[e] > wp.float64(0.0) and b[(e + 1) % 3] > wp.float64(0.0):
                        break
                    h = wp.where(onward == 1, ground.twin[after(h)], ground.twin[before(h)])
        if best_f == f or best >= away * wp.float64(1.0 - 1.0e-12):
            return f, b, away
        f = best_f
        b = best_b
        away = best
    return f, b, away


@wp.func
def slide(ground: Ground, halfedge: int, share: wp.float64, length: wp.float64):
    """Along the rim from ``share`` of a halfedge, forward for ``length``, or back where it is negative."""
    h = int(halfedge)
    s = wp.float64(share)
    left = wp.float64(length)
    for _ in range(MOST_FACES):
        long = wp.max(length_of(ground, h), TINY)
        s = s + left / long
        if s > wp.float64(1.0):
            left = (s - wp.float64(1.0)) * long
            s = wp.float64(0.0)
            h = ground.following[h]
        elif s < wp.float64(0.0):
            left = s * long
            s = wp.float64(1.0)
            h = ground.leading[h]
        else:
            return h, s
    return h, wp.clamp(s, wp.float64(0.0), wp.float64(1.0))
