"""Middles of edges of a triangulation on the ground, around the borders of thin sheets too."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import math

import warp as wp

from texloom.kernels.frames import between
from texloom.kernels.ground import (
    Ground,
    Places,
    after,
    before,
    descend,
    length_of,
    normal_at,
    place_at,
    put,
    slide,
    walk,
)
from texloom.kernels.halfedges import Net
from texloom.kernels.points import HALF

PARTED = wp.constant(wp.float64(0.3))  # cosine between the normals of an edge's ends, below which it may cut a ridge
WAYS = wp.constant(16)  # tried around the border of a sheet, each at so many lengths
STRIDES = wp.constant(8)
TURN = wp.constant(wp.float64(math.tau / 16.0))  # from one way to the next
STRIDE = wp.constant(wp.float64(0.25))  # of the longest side of the faces at an edge, from one length to the next
SAME = wp.constant(wp.float64(1.0e-6))  # of that side: places so near are one


@wp.func
def side_of(net: Net, places: Places, h: int, t: int) -> wp.float64:
    """The longest side of the two faces at an edge."""
    size = wp.float64(0.0)
    for k in range(2):
        g = wp.where(k == 0, h, t)
        a = places.at[net.tail[g]]
        b = places.at[net.tail[after(g)]]
        c = places.at[net.tail[before(g)]]
        size = wp.max(size, wp.max(wp.length(b - a), wp.max(wp.length(c - b), wp.length(a - c))))
    return size


@wp.func
def half_way(ground: Ground, places: Places, p: int, q: int, size: wp.float64):
    """Half the shortest of some straight ways from point p to q, and whether there is one.

    They go in all directions until they come by q, on its side of the sheet, and can go down to it.
    """
    face = places.face[p]
    place = places.barycentric[p]
    n = places.normal[p]
    goal = places.at[q]
    aside = wp.normalize(wp.cross(n, goal - place_at(ground, face, place)))
    best = wp.float64(-1.0)
    ahead = wp.vec3d()
    for trial in range(WAYS * STRIDES):
        angle = TURN * wp.float64(trial // STRIDES)
        way = wp.cos(angle) * aside + wp.sin(angle) * wp.cross(n, aside)
        length = size * STRIDE * wp.float64(trial % STRIDES + 1)
        g, c, whole = walk(ground, face, place, way, length)
        total = length + wp.length(place_at(ground, g, c) - goal)
        there = wp.dot(normal_at(ground, g, c), places.normal[q]) > HALF
        if whole and there and (best < wp.float64(0.0) or total < best):
            g, c, _away = descend(ground, g, goal)
            if wp.length(place_at(ground, g, c) - goal) < SAME * size:
                best = total
                ahead = way
    f, b, _whole = walk(ground, face, place, ahead, HALF * wp.max(best, wp.float64(0.0)))
    return f, b, best > wp.float64(0.0)


@wp.kernel(enable_backward=False)
def halve(start: int, ground: Ground, net: Net, places: Places, halfedge: wp.array(dtype=int), middles: Places):
    """The place of the ground in the middle of an edge of the triangulation; on the rim, half way along it."""
    i = start + wp.tid()
    p = net.tail[halfedge[i]]
    q = net.tail[after(halfedge[i])]
    f = int(0)
    e = int(-1)
    b = wp.vec3d()
    if net.twin[halfedge[i]] < 0:
        h = 3 * places.face[p] + places.side[p]
        s = places.barycentric[p][(places.side[p] + 1) % 3]
        target = 3 * places.face[q] + places.side[q]
        t = places.barycentric[q][(places.side[q] + 1) % 3]
        length = length_of(ground, h) * (t - s)
        if h != target or t < s:
            length = length_of(ground, h) * (wp.float64(1.0) - s)
            g = ground.following[h]
            for _ in range(ground.corner.shape[0]):
                if g == target:
                    break
                length = length + length_of(ground, g)
                g = ground.following[g]
            length = length + length_of(ground, g) * t
        h, s = slide(ground, h, s, HALF * length)
        f = h // 3
        e = h - 3 * f
        b = between(e, s)
    else:
        # From either end half way straight on, with and without going down to the nearest place. The normal tells the
        # wrong side of a sheet; around its border the middle of the chord says nothing
        middle = HALF * (places.at[p] + places.at[q])
        mean = wp.normalize(places.normal[p] + places.normal[q])
        length = HALF * wp.length(places.at[q] - places.at[p])
        best = wp.float64(-1.0)
        for way in range(4):
            v = wp.where(way % 2 == 0, p, q)
            g, c, _whole = walk(ground, places.face[v], places.barycentric[v], middle - places.at[v], length)
            if way < 2:
                g, c, _away = descend(ground, g, middle)
            n = normal_at(ground, g, c)
            cost = wp.length_sq(place_at(ground, g, c) - middle) + length * length * wp.length_sq(n - mean)
            if best < wp.float64(0.0) or cost < best:
                best = cost
                f = g
                b = c
        if wp.dot(places.normal[p], places.normal[q]) < PARTED:
            size = side_of(net, places, halfedge[i], net.twin[halfedge[i]])
            g, c, found = half_way(ground, places, p, q, size)
            if found:
                f = g
                b = c
    put(ground, f, b, e, i, middles)
