"""Points that spread over a mesh (the ground) with their triangulation: forces and steps.

Arrays of the triangulation are those of ``halfedges``, arrays of the ground and of places on it those of ``ground``.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.delaunay import WELL_LAID, facing
from texloom.kernels.frames import between
from texloom.kernels.ground import after, before, descend, place_at, share_between, slide, walk
from texloom.kernels.halfedges import MOST_AROUND, fan_start, next_around

HALF = wp.constant(wp.float64(0.5))
FARTHEST = wp.constant(wp.float64(0.25))  # of the distance wanted, in one step


@wp.func
def scale_at(scale: wp.array(dtype=wp.float64), corner: wp.array(dtype=int), f: int, b: wp.vec3d) -> wp.float64:
    return b[0] * scale[corner[3 * f]] + b[1] * scale[corner[3 * f + 1]] + b[2] * scale[corner[3 * f + 2]]


@wp.func
def normal_at(normal: wp.array(dtype=wp.vec3d), f: int, b: wp.vec3d) -> wp.vec3d:
    return wp.normalize(b[0] * normal[3 * f] + b[1] * normal[3 * f + 1] + b[2] * normal[3 * f + 2])


@wp.func
def rim_shift(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    start: int,
) -> wp.float64:
    """How far a point of the rim goes to lie between its two neighbours there."""
    v = tail[start]
    n = tail[after(start)]
    h = int(start)
    for _ in range(MOST_AROUND):
        on = next_around(twin, h, start)
        if on < 0:
            break
        h = on
    p = tail[before(h)]
    ahead = wp.length(at[n] - at[v]) / (scale[n] + scale[v])
    behind = wp.length(at[p] - at[v]) / (scale[p] + scale[v])
    return HALF * (ahead - behind) * scale[v]


@wp.func
def push(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    start: int,
    reach: wp.float64,
) -> wp.vec3d:
    """Repulsion by the neighbours: 1 beside them, falling to 0 at ``reach`` (Turk 1991); its part in the surface."""
    v = tail[start]
    force = wp.vec3d()
    normal = wp.vec3d()
    h = int(start)
    for _ in range(MOST_AROUND):
        away = at[v] - at[tail[after(h)]]
        distance = wp.length(away)
        wanted = reach * HALF * (scale[v] + scale[tail[after(h)]])
        if distance < wanted and distance > wp.float64(0.0):
            force = force + away * (wp.float64(1.0) / distance - wp.float64(1.0) / wanted)
        u = tail[after(h)]
        w = tail[before(h)]
        normal = normal + wp.cross(at[u] - at[v], at[w] - at[v])
        if twin[after(h)] < 0:
            # The rim opposite pushes like a neighbour twice as far
            share = share_between(at[v], at[u], at[w])
            aside = at[v] - (at[u] + share * (at[w] - at[u]))
            rim_distance = wp.length(aside)
            if wp.float64(2.0) * rim_distance < wanted and rim_distance > wp.float64(0.0):
                force = force + aside * (wp.float64(1.0) / rim_distance - wp.float64(2.0) / wanted)
        h = next_around(twin, h, start)
        if h < 0:
            break
    normal = wp.normalize(normal)
    return force - normal * wp.dot(normal, force)


@wp.func
def turns_over(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    normal: wp.array(dtype=wp.vec3d),
    start: int,
    p: wp.vec3d,
    n: wp.vec3d,
) -> bool:
    """Whether a face around the tail of ``start`` would lie badly, and worse than now, with that point at p."""
    over = bool(False)
    h = int(start)
    for _ in range(MOST_AROUND):
        u = tail[after(h)]
        w = tail[before(h)]
        new = wp.dot(wp.normalize(wp.cross(at[u] - p, at[w] - p)), n + normal[u] + normal[w]) / wp.float64(3.0)
        if new < WELL_LAID and new < facing(at, normal, tail[h], u, w):
            over = True
        h = next_around(twin, h, start)
        if over or h < 0:
            break
    return over


@wp.kernel(enable_backward=False)
def repel(
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
    first: wp.array(dtype=int),
    rim: wp.array(dtype=int),
    who: wp.array(dtype=int),  # the points that move
    spacing: wp.float64,
    reach: wp.float64,  # of the repulsion, in spacings
    gain: wp.float64,
    swing: wp.float64,  # of the step before, how much is gone again
    last: wp.array(dtype=wp.vec3d),  # where the movers were before that step
    at: wp.array(dtype=wp.vec3d),
    scale: wp.array(dtype=wp.float64),
    normal: wp.array(dtype=wp.vec3d),
    face: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec3d),
    side: wp.array(dtype=int),
    new_at: wp.array(dtype=wp.vec3d),
    new_scale: wp.array(dtype=wp.float64),
    new_normal: wp.array(dtype=wp.vec3d),
    new_face: wp.array(dtype=int),
    new_place: wp.array(dtype=wp.vec3d),
    new_side: wp.array(dtype=int),
):
    """One step of every point away from its neighbours, straight over the ground."""
    i = start + wp.tid()
    v = who[i]
    begin = fan_start(twin, first[v], rim[v])
    f = int(face[v])
    b = place[v]
    e = int(side[v])
    if rim[v] == 1:
        h, share = slide(
            vertex, corner, following, leading, 3 * f + e, b[(e + 1) % 3], rim_shift(tail, twin, at, scale, begin)
        )
        f = h // 3
        e = h - 3 * f
        b = between(e, share)
    else:
        local = spacing * scale[v]
        way = gain * local * push(tail, twin, at, scale, begin, reach * spacing) + swing * (at[v] - last[i])
        length = wp.min(wp.length(way), FARTHEST * local)
        if length > wp.float64(0.0):
            f, b, whole = walk(vertex, corner, across, f, b, way, length)
            moved = place_at(vertex, corner, f, b)
            there = normal_at(ground_normal, f, b)
            if not whole or turns_over(tail, twin, at, normal, begin, moved, there):
                f = int(face[v])
                b = place[v]
    new_at[i] = place_at(vertex, corner, f, b)
    new_scale[i] = scale_at(ground_scale, corner, f, b)
    new_normal[i] = normal_at(ground_normal, f, b)
    new_face[i] = f
    new_place[i] = b
    new_side[i] = e


@wp.kernel(enable_backward=False)
def settle(
    start: int,
    vertex: wp.array(dtype=wp.vec3d),
    corner: wp.array(dtype=int),
    across: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    near: wp.array(dtype=int),
    face: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec3d),
):
    """The place nearest to each point that is reached from face ``near``, ever nearer."""
    i = start + wp.tid()
    f, b, _ = descend(vertex, corner, across, near[i], at[i])
    face[i] = f
    place[i] = b
