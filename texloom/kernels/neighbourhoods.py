"""Walking outwards over a mesh from each site, as far as a few texels."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

MOST_STEPS = wp.constant(4096)  # from neighbour to nearer neighbour


@wp.func
def lay_flat(way: wp.vec3, direction: wp.vec3, up: wp.vec3, texel: float) -> wp.vec2:
    """[row, column] texels of a chord, laid into the tangent plane at full length."""
    row = -wp.dot(way, up)
    column = wp.dot(way, direction)
    seen = wp.sqrt(row * row + column * column)
    stretch = wp.length(way) / wp.max(seen, 1.0e-20) / texel
    return wp.vec2(row * stretch, column * stretch)


@wp.func
def turned_against(other: wp.vec3, direction: wp.vec3, up: wp.vec3) -> float:
    """The angle by which a frame is turned against another direction, seen in its own plane."""
    return -wp.atan2(wp.dot(other, up), wp.dot(other, direction))


@wp.kernel(enable_backward=False)
def spread(
    start: int,
    middle: wp.array(dtype=int),
    ring_start: wp.array(dtype=int),
    ring: wp.array(dtype=int),  # neighbours of each site, in compressed rows
    place: wp.array(dtype=wp.vec3),
    direction: wp.array(dtype=wp.vec3),
    normal: wp.array(dtype=wp.vec3),
    texel: wp.array(dtype=float),
    reach: float,
    sites: wp.array2d(dtype=int),
    offset: wp.array3d(dtype=float),
    turn: wp.array2d(dtype=float),
):
    """sites[i] = the sites within ``reach`` texels (rows and columns) of site middle[i], nearest rings first.

    A neighbour's offset is its chord, laid into the tangent plane at full length: true to second order in the angle
    between the normals. Sites whose normals are more than a right angle apart are not neighbours.
    """
    i = start + wp.tid()
    own = middle[i]
    d = direction[own]
    n = normal[own]
    up = wp.cross(n, d)
    most = sites.shape[1]
    sites[i, 0] = own
    offset[i, 0, 0] = 0.0
    offset[i, 0, 1] = 0.0
    turn[i, 0] = 0.0
    count = int(1)
    at = int(0)
    while at < count:
        for e in range(ring_start[sites[i, at]], ring_start[sites[i, at] + 1]):
            site = ring[e]
            known = int(0)
            for k in range(count):
                if sites[i, k] == site:
                    known = 1
                    break
            if known == 0 and count < most and wp.dot(normal[site], n) > 0.0:
                laid = lay_flat(place[site] - place[own], d, up, texel[own])
                if wp.max(wp.abs(laid[0]), wp.abs(laid[1])) <= reach:
                    sites[i, count] = site
                    offset[i, count, 0] = laid[0]
                    offset[i, count, 1] = laid[1]
                    turn[i, count] = turned_against(direction[site], d, up)
                    count += 1
        at += 1
    for k in range(count, most):
        sites[i, k] = -1
        offset[i, k, 0] = 0.0
        offset[i, k, 1] = 0.0
        turn[i, k] = 0.0


@wp.kernel(enable_backward=False)
def find_beside(
    start: int,
    near: wp.array(dtype=int),  # a site to begin at, for each place
    ring_start: wp.array(dtype=int),
    ring: wp.array(dtype=int),  # neighbours of each site, in compressed rows
    place: wp.array(dtype=wp.vec3),
    direction: wp.array(dtype=wp.vec3),
    normal: wp.array(dtype=wp.vec3),
    texel: wp.array(dtype=float),
    at: wp.array(dtype=wp.vec3),
    along: wp.array(dtype=wp.vec3),
    facing: wp.array(dtype=wp.vec3),
    site: wp.array(dtype=int),
    offset: wp.array2d(dtype=float),
    turn: wp.array(dtype=float),
):
    """site[i] = the site nearest to place at[i], by going from neighbour to nearer neighbour; offset and turn as above.

    In a Delaunay triangulation that ends at the nearest of all. A site that faces away is no neighbour.
    """
    i = start + wp.tid()
    own = int(near[i])
    least = float(wp.length_sq(place[own] - at[i]))
    if wp.dot(normal[own], facing[i]) <= 0.0:
        least = float(1.0e30)  # the walk may begin at one, not end there
    for _ in range(MOST_STEPS):
        nearer = int(own)
        for e in range(ring_start[own], ring_start[own + 1]):
            away = wp.length_sq(place[ring[e]] - at[i])
            if away < least and wp.dot(normal[ring[e]], facing[i]) > 0.0:
                least = away
                nearer = ring[e]
        if nearer == own:
            break
        own = nearer
    site[i] = own
    up = wp.cross(normal[own], direction[own])
    laid = lay_flat(at[i] - place[own], direction[own], up, texel[own])
    offset[i, 0] = laid[0]
    offset[i, 1] = laid[1]
    turn[i] = turned_against(along[i], direction[own], up)
