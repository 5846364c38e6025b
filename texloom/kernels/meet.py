"""Two paths to every sample of a square, and the point half way between their ends."""

import warp as wp

from texloom.kernels.trace import CPU_FLAGS, conjugate, nearest_root, power_at, texel_at, times, walk

wp.set_module_options({"cpu_compiler_flags": CPU_FLAGS})


@wp.func
def point(position: wp.array(dtype=wp.vec3), faces: wp.array2d(dtype=int), f: int, at: wp.vec3, period: wp.vec3):
    """A place in space; across a torus's border, near the face's first corner."""
    p = position[faces[f, 0]]
    q = nearest_image(position[faces[f, 1]] - p, period)
    r = nearest_image(position[faces[f, 2]] - p, period)
    return p + at[1] * q + at[2] * r


@wp.func
def nearest_image(difference: wp.vec3, period: wp.vec3) -> wp.vec3:
    d = wp.vec3(difference[0], difference[1], difference[2])
    for k in range(3):
        if period[k] > 0.0:
            d[k] = d[k] - period[k] * wp.round(d[k] / period[k])
    return d


@wp.func
def axes_of(position: wp.array(dtype=wp.vec3), faces: wp.array2d(dtype=int), f: int, period: wp.vec3):
    """A face's own 2-D axes in space, and its normal."""
    p = position[faces[f, 0]]
    q = nearest_image(position[faces[f, 1]] - p, period)
    r = nearest_image(position[faces[f, 2]] - p, period)
    x = wp.normalize(q)
    normal = wp.normalize(wp.cross(q, r))
    return x, wp.cross(normal, x), normal


@wp.kernel(enable_backward=False)
def meet_half_way(
    start: int,
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    order: int,
    position: wp.array(dtype=wp.vec3),
    faces: wp.array2d(dtype=int),
    period: wp.vec3,
    width: int,
    apart_at_least: float,  # texels two paths may always end apart,
    apart_per_texel: float,  # and for each texel of their shorter leg
    patches: int,
    face: wp.array(dtype=int),  # the squares of all patches, then those of the other paths
    place: wp.array(dtype=wp.vec3),
    heading: wp.array(dtype=wp.vec2),
):
    """Every sample moves half way to where the other path put it; -1 where the two disagree too much.

    Half way is half the chord between them, laid into the sample's face and walked straight.
    """
    s = start + wp.tid()
    f = face[s]
    o = s + patches * width * width
    g = face[o]
    if g < 0:
        return
    if f < 0:
        face[s] = g
        place[s] = place[o]
        heading[s] = heading[o]
        return

    if f == g:
        a = heading[s]
        if wp.dot(a, heading[o]) < 0.5:
            face[s] = -1
            return
        middle = 0.5 * (place[s] + place[o])
        place[s] = middle
        heading[s] = nearest_root(power_at(record, f, middle), wp.vec2(a[0], a[1]), order)
        return

    x, y, n = axes_of(position, faces, f, period)
    u, v, m = axes_of(position, faces, g, period)
    cosine = wp.dot(n, m)
    here = heading[s]
    there = heading[o][0] * u + heading[o][1] * v
    there = there - wp.dot(there, n) / wp.max(1.0 + cosine, 0.1) * (n + m)  # into this face's plane, least turn
    apart = nearest_image(
        point(position, faces, g, place[o], period) - point(position, faces, f, place[s], period), period
    )
    distance = wp.length(apart)
    row = wp.abs((s // width) % width - width // 2)
    column = wp.abs(s % width - width // 2)
    farthest = apart_at_least + apart_per_texel * float(wp.min(row, column))
    agree = wp.dot(there, here[0] * x + here[1] * y)
    if distance > farthest * texel_at(record, f, place[s]) or cosine < -0.5 or agree < 0.5:
        face[s] = -1
        return

    way = wp.vec2(wp.dot(apart, x), wp.dot(apart, y))
    half = 0.5 * distance / texel_at(record, f, place[s])
    if wp.length(way) < 1.0e-6 * texel_at(record, f, place[s]):
        return
    way = wp.normalize(way)
    h, at, end = walk(record, twin, 0, f, place[s], way, wp.vec2(1.0, 0.0), half)
    if h >= 0:
        turned = times(times(here, conjugate(way)), end)
        root = nearest_root(power_at(record, h, at), turned, order)
        if root[0] == 0.0 and root[1] == 0.0:
            h = -1
        place[s] = at
        heading[s] = root
    face[s] = h
