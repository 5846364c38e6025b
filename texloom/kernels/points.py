"""Points that spread over a mesh (the ground) with their triangulation: forces and steps."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.delaunay import WELL_LAID, facing
from texloom.kernels.frames import between
from texloom.kernels.ground import (
    Ground,
    Places,
    after,
    before,
    descend,
    normal_at,
    place_at,
    put,
    share_between,
    slide,
    walk,
)
from texloom.kernels.halfedges import MOST_AROUND, Net, fan_start, next_around

HALF = wp.constant(wp.float64(0.5))
FARTHEST = wp.constant(wp.float64(0.25))  # of the distance wanted, in one step


@wp.func
def rim_shift(net: Net, places: Places, start: int) -> wp.float64:
    """How far a point of the rim goes to lie between its two neighbours there."""
    v = net.tail[start]
    n = net.tail[after(start)]
    h = int(start)
    for _ in range(MOST_AROUND):
        on = next_around(net, h, start)
        if on < 0:
            break
        h = on
    p = net.tail[before(h)]
    ahead = wp.length(places.at[n] - places.at[v]) / (places.scale[n] + places.scale[v])
    behind = wp.length(places.at[p] - places.at[v]) / (places.scale[p] + places.scale[v])
    return HALF * (ahead - behind) * places.scale[v]


@wp.func
def push(net: Net, places: Places, start: int, reach: wp.float64) -> wp.vec3d:
    """Repulsion by the neighbours: 1 beside them, falling to 0 at ``reach`` (Turk 1991); its part in the surface."""
    v = net.tail[start]
    force = wp.vec3d()
    normal = wp.vec3d()
    h = int(start)
    for _ in range(MOST_AROUND):
        away = places.at[v] - places.at[net.tail[after(h)]]
        distance = wp.length(away)
        wanted = reach * HALF * (places.scale[v] + places.scale[net.tail[after(h)]])
        if distance < wanted and distance > wp.float64(0.0):
            force = force + away * (wp.float64(1.0) / distance - wp.float64(1.0) / wanted)
        u = net.tail[after(h)]
        w = net.tail[before(h)]
        normal = normal + wp.cross(places.at[u] - places.at[v], places.at[w] - places.at[v])
        if net.twin[after(h)] < 0:
            # The rim opposite pushes like a neighbour twice as far
            share = share_between(places.at[v], places.at[u], places.at[w])
            aside = places.at[v] - (places.at[u] + share * (places.at[w] - places.at[u]))
            rim_distance = wp.length(aside)
            if wp.float64(2.0) * rim_distance < wanted and rim_distance > wp.float64(0.0):
                force = force + aside * (wp.float64(1.0) / rim_distance - wp.float64(2.0) / wanted)
        h = next_around(net, h, start)
        if h < 0:
            break
    normal = wp.normalize(normal)
    return force - normal * wp.dot(normal, force)


@wp.func
def turns_over(net: Net, places: Places, start: int, p: wp.vec3d, n: wp.vec3d) -> bool:
    """Whether a face around the tail of ``start`` would lie badly, and worse than now, with that point at p."""
    over = bool(False)
    h = int(start)
    for _ in range(MOST_AROUND):
        u = net.tail[after(h)]
        w = net.tail[before(h)]
        across = wp.normalize(wp.cross(places.at[u] - p, places.at[w] - p))
        new = wp.dot(across, n + places.normal[u] + places.normal[w]) / wp.float64(3.0)
        if new < WELL_LAID and new < facing(places, net.tail[h], u, w):
            over = True
        h = next_around(net, h, start)
        if over or h < 0:
            break
    return over


@wp.kernel(enable_backward=False)
def repel(
    start: int,
    ground: Ground,
    net: Net,
    places: Places,
    who: wp.array(dtype=int),  # the points that move
    spacing: wp.float64,
    reach: wp.float64,  # of the repulsion, in spacings
    gain: wp.float64,
    swing: wp.float64,  # of the step before, how much is gone again
    last: wp.array(dtype=wp.vec3d),  # where the movers were before that step
    moved: Places,
):
    """One step of every point away from its neighbours, straight over the ground."""
    i = start + wp.tid()
    v = who[i]
    begin = fan_start(net, v)
    f = int(places.face[v])
    b = places.barycentric[v]
    e = int(places.side[v])
    if net.rim[v] == 1:
        h, share = slide(ground, 3 * f + e, b[(e + 1) % 3], rim_shift(net, places, begin))
        f = h // 3
        e = h - 3 * f
        b = between(e, share)
    else:
        local = spacing * places.scale[v]
        way = gain * local * push(net, places, begin, reach * spacing) + swing * (places.at[v] - last[i])
        length = wp.min(wp.length(way), FARTHEST * local)
        if length > wp.float64(0.0):
            f, b, whole = walk(ground, f, b, way, length)
            there = normal_at(ground, f, b)
            if not whole or turns_over(net, places, begin, place_at(ground, f, b), there):
                f = int(places.face[v])
                b = places.barycentric[v]
    put(ground, f, b, e, i, moved)


@wp.kernel(enable_backward=False)
def settle(
    start: int,
    ground: Ground,
    at: wp.array(dtype=wp.vec3d),
    near: wp.array(dtype=int),
    face: wp.array(dtype=int),
    barycentric: wp.array(dtype=wp.vec3d),
):
    """The place nearest to each point that is reached from face ``near``, ever nearer."""
    i = start + wp.tid()
    f, b, _ = descend(ground, near[i], at[i])
    face[i] = f
    barycentric[i] = b
