"""Walking outwards over a mesh from each site, as far as a few texels."""

import warp as wp


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
                way = place[site] - place[own]
                row = -wp.dot(way, up)
                column = wp.dot(way, d)
                seen = wp.sqrt(row * row + column * column)
                stretch = wp.length(way) / wp.max(seen, 1.0e-20) / texel[own]
                row = row * stretch
                column = column * stretch
                if wp.max(wp.abs(row), wp.abs(column)) <= reach:
                    sites[i, count] = site
                    offset[i, count, 0] = row
                    offset[i, count, 1] = column
                    t = direction[site]
                    turn[i, count] = -wp.atan2(wp.dot(t, up), wp.dot(t, d))
                    count += 1
        at += 1
    for k in range(count, most):
        sites[i, k] = -1
        offset[i, k, 0] = 0.0
        offset[i, k, 1] = 0.0
        turn[i, k] = 0.0
