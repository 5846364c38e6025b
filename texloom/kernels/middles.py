"""Middles of edges of a triangulation on the ground, around the borders of thin sheets too.

Arrays of the triangulation are those of ``halfedges``, arrays of the ground and of places on it those of ``ground``.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import math

import warp as wp

from texloom.kernels.frames import between
from texloom.kernels.ground import after, before, descend, place_at, slide, walk
from texloom.kernels.points import HALF, normal_at, scale_at

PARTED = wp.constant(wp.float64(0.3))  # cosine between the normals of an edge's ends, below which it may cut a ridge
WAYS = wp.constant(16)  # tried around the border of a sheet, each at so many lengths
STRIDES = wp.constant(8)
TURN = wp.constant(wp.float64(math.tau / 16.0))  # from one way to the next
STRIDE = wp.constant(wp.float64(0.25))  # of the longest side of the faces at an edge, from one length to the next
SAME = wp.constant(wp.float64(1.0e-6))  # of that side: places so near are one


@wp.func
def side_of(tail: wp.array(dtype=int), at: wp.array(dtype=wp.vec3d), h: int, t: int) -> wp.float64:
    """The longest side of the two faces at an edge."""
    size = wp.float64(0.0)
    for k in range(2):
        g = wp.where(k == 0, h, t)
        a = at[tail[g]]
        b = at[tail[after(g)]]
        c = at[tail[before(g)]]
        size = wp.max(size, wp.max(wp.length(b - a), wp.max(wp.length(c - b), wp.length(a - c))))
    return size


@wp.func
def half_way(
    vertex: wp.array(dtype=wp.vec3d),
    corner: wp.array(dtype=int),
    across: wp.array(dtype=int),
    ground_normal: wp.array(dtype=wp.vec3d),
    face: int,
    place: wp.vec3d,
    n: wp.vec3d,
    q: wp.vec3d,
    nq: wp.vec3d,
    size: wp.float64,
):
    """Half the shortest of some straight ways from a place to point q, and whether there is one.

    They go in all directions until they come by q, on its side of the sheet, and can go down to it.
    """
    aside = wp.normalize(wp.cross(n, q - place_at(vertex, corner, face, place)))
    best = wp.float64(-1.0)
    ahead = wp.vec3d()
    for trial in range(WAYS * STRIDES):
        angle = TURN * wp.float64(trial // STRIDES)
        way = wp.cos(angle) * aside + wp.sin(angle) * wp.cross(n, aside)
        length = size * STRIDE * wp.float64(trial % STRIDES + 1)
        g, c, whole = walk(vertex, corner, across, face, place, way, length)
        total = length + wp.length(place_at(vertex, corner, g, c) - q)
        there = wp.dot(normal_at(ground_normal, g, c), nq) > HALF
        if whole and there and (best < wp.float64(0.0) or total < best):
            g, c, _away = descend(vertex, corner, across, g, q)
            if wp.length(place_at(vertex, corner, g, c) - q) < SAME * size:
                best = total
                ahead = way
    f, b, _whole = walk(vertex, corner, across, face, place, ahead, HALF * wp.max(best, wp.float64(0.0)))
    return f, b, best > wp.float64(0.0)


@wp.kernel(enable_backward=False)
def halve(
    start: int,
    vertex: wp.array(dtype=wp.vec3d),
    corner: wp.array(dtype=int),
    across: wp.array(dtype=int),
    following: wp.array(dtype=int),
    leading: wp.array(dtype=int),
    ground_scale: wp.array(dtype=wp.float64),
    ground_normal: wp.array(dtype=wp.vec3d),
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    face: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec3d),
    side: wp.array(dtype=int),
    halfedge: wp.array(dtype=int),
    middle_at: wp.array(dtype=wp.vec3d),
    middle_scale: wp.array(dtype=wp.float64),
    middle_normal: wp.array(dtype=wp.vec3d),
    middle_face: wp.array(dtype=int),
    middle_place: wp.array(dtype=wp.vec3d),
    middle_side: wp.array(dtype=int),
):
    """The place of the ground in the middle of an edge of the triangulation; on the rim, half way along it."""
    i = start + wp.tid()
    p = tail[halfedge[i]]
    q = tail[after(halfedge[i])]
    f = int(0)
    e = int(-1)
    b = wp.vec3d()
    if twin[halfedge[i]] < 0:
        h = 3 * face[p] + side[p]
        s = place[p][(side[p] + 1) % 3]
        target = 3 * face[q] + side[q]
        t = place[q][(side[q] + 1) % 3]
        length = wp.length(vertex[corner[after(h)]] - vertex[corner[h]]) * (t - s)
        if h != target or t < s:
            length = wp.length(vertex[corner[after(h)]] - vertex[corner[h]]) * (wp.float64(1.0) - s)
            g = following[h]
            for _ in range(corner.shape[0]):
                if g == target:
                    break
                length = length + wp.length(vertex[corner[after(g)]] - vertex[corner[g]])
                g = following[g]
            length = length + wp.length(vertex[corner[after(g)]] - vertex[corner[g]]) * t
        h, s = slide(vertex, corner, following, leading, h, s, HALF * length)
        f = h // 3
        e = h - 3 * f
        b = between(e, s)
    else:
        # From either end half way straight on, with and without going down to the nearest place. The normal tells the
        # wrong side of a sheet; around its border the middle of the chord says nothing
        middle = HALF * (at[p] + at[q])
        mean = wp.normalize(normal[p] + normal[q])
        length = HALF * wp.length(at[q] - at[p])
        best = wp.float64(-1.0)
        for way in range(4):
            v = wp.where(way % 2 == 0, p, q)
            g, c, _whole = walk(vertex, corner, across, face[v], place[v], middle - at[v], length)
            if way < 2:
                g, c, _away = descend(vertex, corner, across, g, middle)
            n = normal_at(ground_normal, g, c)
            cost = wp.length_sq(place_at(vertex, corner, g, c) - middle) + length * length * wp.length_sq(n - mean)
            if best < wp.float64(0.0) or cost < best:
                best = cost
                f = g
                b = c
        if wp.dot(normal[p], normal[q]) < PARTED:
            size = side_of(tail, at, halfedge[i], twin[halfedge[i]])
            g, c, found = half_way(
                vertex, corner, across, ground_normal, face[p], place[p], normal[p], at[q], normal[q], size
            )
            if found:
                f = g
                b = c
    middle_at[i] = place_at(vertex, corner, f, b)
    middle_scale[i] = scale_at(ground_scale, corner, f, b)
    middle_normal[i] = normal_at(ground_normal, f, b)
    middle_face[i] = f
    middle_place[i] = b
    middle_side[i] = e
