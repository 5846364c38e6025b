"""Triangles on pixels: one item is a row of the picture, and walks the faces that may touch it in increasing order.

Corners are (column, row) in pixels with pixel centres at integers, snapped to 1/256 by the caller, so that edge
functions in doubles are exact and two faces that share an edge leave no gap. ``row_start``/``row_faces`` are the faces
of each row in compressed rows.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp


@wp.func
def edge(a: wp.vec2d, b: wp.vec2d, p: wp.vec2d):
    """Twice the signed area of (a, b, p)."""
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


@wp.func
def holds(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, p: wp.vec2d):
    """1 where p lies inside triangle (a, b, c), 0 on its border, -1 outside; a triangle without area holds nothing."""
    zero = wp.float64(0.0)
    area = edge(a, b, c)
    s = wp.sign(area)
    u = s * edge(b, c, p)
    v = s * edge(c, a, p)
    w = s * edge(a, b, p)
    if area == zero or u < zero or v < zero or w < zero:
        return -1
    if u > zero and v > zero and w > zero:
        return 1
    return 0


@wp.func
def segment_gap(a: wp.vec2d, b: wp.vec2d, p: wp.vec2d):
    """Squared distance from p to segment (a, b)."""
    along = b - a
    length2 = wp.dot(along, along)
    t = wp.float64(0.0)
    if length2 > wp.float64(0.0):
        t = wp.clamp(wp.dot(p - a, along) / length2, wp.float64(0.0), wp.float64(1.0))
    away = p - a - t * along
    return wp.dot(away, away)


@wp.func
def first_column(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, reach: wp.float64):
    return wp.max(0, int(wp.ceil(wp.min(a[0], wp.min(b[0], c[0])) - reach)))


@wp.func
def last_column(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, reach: wp.float64, columns: int):
    return wp.min(columns - 1, int(wp.floor(wp.max(a[0], wp.max(b[0], c[0])) + reach)))


@wp.kernel(enable_backward=False)
def own_texels(
    start: int, row_start: wp.array(dtype=int), row_faces: wp.array(dtype=int), corners: wp.array2d(dtype=wp.vec2d),
    reach: wp.float64, owner: wp.array2d(dtype=int), gap: wp.array2d(dtype=float),
):  # fmt: skip
    """owner = the lowest face that covers the texel's centre, else the nearest one within ``reach`` texels, else -1."""
    row = start + wp.tid()
    columns = owner.shape[1]
    reach2 = float(reach * reach)
    for column in range(columns):
        owner[row, column] = -1
        gap[row, column] = 3.0e38
    for entry in range(row_start[row], row_start[row + 1]):
        face = row_faces[entry]
        a = wp.vec2d(corners[face, 0])
        b = wp.vec2d(corners[face, 1])
        c = wp.vec2d(corners[face, 2])
        for column in range(first_column(a, b, c, reach), last_column(a, b, c, reach, columns) + 1):
            best = gap[row, column]
            if best > 0.0:
                p = wp.vec2d(wp.float64(column), wp.float64(row))
                if holds(a, b, c, p) >= 0:
                    gap[row, column] = 0.0
                    owner[row, column] = face
                elif reach2 > 0.0:
                    away = float(wp.min(segment_gap(a, b, p), wp.min(segment_gap(b, c, p), segment_gap(c, a, p))))
                    if away <= reach2 and away < best:
                        gap[row, column] = wp.max(away, 1.0e-12)
                        owner[row, column] = face


@wp.kernel(enable_backward=False)
def count_covers(
    start: int, row_start: wp.array(dtype=int), row_faces: wp.array(dtype=int), corners: wp.array2d(dtype=wp.vec2d),
    covers: wp.array2d(dtype=int), last: wp.array2d(dtype=int),
):  # fmt: skip
    """covers = how many faces hold the texel's centre strictly inside; last = the highest of them, -1 if none."""
    row = start + wp.tid()
    columns = covers.shape[1]
    for column in range(columns):
        covers[row, column] = 0
        last[row, column] = -1
    for entry in range(row_start[row], row_start[row + 1]):
        face = row_faces[entry]
        a = wp.vec2d(corners[face, 0])
        b = wp.vec2d(corners[face, 1])
        c = wp.vec2d(corners[face, 2])
        none = wp.float64(0.0)
        for column in range(first_column(a, b, c, none), last_column(a, b, c, none, columns) + 1):
            if holds(a, b, c, wp.vec2d(wp.float64(column), wp.float64(row))) == 1:
                covers[row, column] = covers[row, column] + 1
                last[row, column] = face


@wp.kernel(enable_backward=False)
def gap_in_column(start: int, covered: wp.array2d(dtype=wp.uint8), width: int, step: wp.array2d(dtype=int)):
    """step = signed rows to the nearest covered texel of the same column within ``width`` (up first), or 2^20."""
    row = start + wp.tid()
    rows = covered.shape[0]
    for column in range(covered.shape[1]):
        step[row, column] = 1048576
        if covered[row, column] != wp.uint8(0):
            step[row, column] = 0
        else:
            for away in range(1, width + 1):
                if row - away >= 0 and covered[wp.max(row - away, 0), column] != wp.uint8(0):
                    step[row, column] = -away
                    break
                if row + away < rows and covered[wp.min(row + away, rows - 1), column] != wp.uint8(0):
                    step[row, column] = away
                    break


@wp.kernel(enable_backward=False)
def nearest_covered(start: int, step: wp.array2d(dtype=int), width: int, nearest: wp.array2d(dtype=int)):
    """nearest = flat index of the covered texel nearest to each texel within ``width``; ties keep the left; else -1."""
    row = start + wp.tid()
    columns = step.shape[1]
    for column in range(columns):
        best = width * width + 1
        index = int(-1)
        if step[row, column] == 0:
            index = row * columns + column
        else:
            for other in range(wp.max(column - width, 0), wp.min(column + width, columns - 1) + 1):
                down = step[row, other]
                if wp.abs(down) <= width:
                    gap2 = down * down + (other - column) * (other - column)
                    if gap2 < best:
                        best = gap2
                        index = (row + down) * columns + other
        nearest[row, column] = index


@wp.kernel(enable_backward=False)
def draw_rows(
    start: int, row_start: wp.array(dtype=int), row_faces: wp.array(dtype=int), corners: wp.array2d(dtype=wp.vec2d),
    closeness: wp.array2d(dtype=float), visible: wp.array2d(dtype=int), depth: wp.array2d(dtype=float),
):  # fmt: skip
    """visible = the closest face at each sample (ties: the lowest), depth = its closeness there (greater is closer)."""
    row = start + wp.tid()
    columns = visible.shape[1]
    for column in range(columns):
        visible[row, column] = -1
        depth[row, column] = -3.0e38
    none = wp.float64(0.0)
    for entry in range(row_start[row], row_start[row + 1]):
        face = row_faces[entry]
        a = wp.vec2d(corners[face, 0])
        b = wp.vec2d(corners[face, 1])
        c = wp.vec2d(corners[face, 2])
        area = edge(a, b, c)
        for column in range(first_column(a, b, c, none), last_column(a, b, c, none, columns) + 1):
            p = wp.vec2d(wp.float64(column), wp.float64(row))
            if holds(a, b, c, p) >= 0:
                u = float(edge(b, c, p) / area)
                v = float(edge(c, a, p) / area)
                close = u * closeness[face, 0] + v * closeness[face, 1] + (1.0 - u - v) * closeness[face, 2]
                if close > depth[row, column]:
                    depth[row, column] = close
                    visible[row, column] = face


@wp.func
def near_weights(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d, p: wp.vec2d):
    """Barycentric coordinates of p; those of a place on the border near it if p lies outside."""
    area = edge(a, b, c)
    third = wp.float64(1.0) / wp.float64(3.0)
    weights = wp.vec3d(third, third, third)
    if area != wp.float64(0.0):
        zero = wp.float64(0.0)
        u = wp.max(zero, edge(b, c, p) / area)
        v = wp.max(zero, edge(c, a, p) / area)
        w = wp.max(zero, edge(a, b, p) / area)
        weights = wp.vec3d(u, v, w) / (u + v + w)
    return weights


@wp.kernel(enable_backward=False)
def place_texels(
    start: int, copy: wp.array(dtype=int), texel: wp.array(dtype=int), columns: int,
    corners: wp.array2d(dtype=wp.vec2d), copied: wp.array(dtype=int), faces: wp.array2d(dtype=int),
    vertices: wp.array(dtype=wp.vec3d), direction: wp.array(dtype=wp.vec3), upward: wp.array(dtype=wp.vec3),
    texel_length: wp.array(dtype=float), tangents: wp.array2d(dtype=wp.vec4), has_tangents: int,
    sites: wp.array2d(dtype=int), barycentric: wp.array2d(dtype=float), offsets: wp.array2d(dtype=wp.vec2),
    frame_turn: wp.array2d(dtype=float), handed: wp.array(dtype=float),
):  # fmt: skip
    """The place on the surface behind a texel: three sites, barycentric weights, offsets and turns in their frames.

    The way from a site to the place is laid into the site's tangent plane at its full length.
    """
    i = start + wp.tid()
    f = copy[i]
    face = copied[f]
    p = wp.vec2d(wp.float64(texel[i] % columns), wp.float64(texel[i] / columns))
    b = near_weights(wp.vec2d(corners[f, 0]), wp.vec2d(corners[f, 1]), wp.vec2d(corners[f, 2]), p)
    place = b[0] * vertices[faces[face, 0]] + b[1] * vertices[faces[face, 1]] + b[2] * vertices[faces[face, 2]]
    tangent = wp.vec3(0.0, 0.0, 0.0)
    handed[i] = 1.0
    if has_tangents != 0:
        for corner in range(3):
            t = tangents[face, corner]
            tangent += float(b[corner]) * wp.vec3(t[0], t[1], t[2])
        handed[i] = tangents[face, 0][3]
    for corner in range(3):
        site = faces[face, corner]
        way = wp.vec3(place - vertices[site])
        row = -wp.dot(way, upward[site])
        column = wp.dot(way, direction[site])
        seen = wp.sqrt(row * row + column * column)
        stretch = float(0.0)
        if seen > 0.0:
            stretch = wp.length(way) / (seen * texel_length[site])
        sites[i, corner] = site
        barycentric[i, corner] = float(b[corner])
        offsets[i, corner] = wp.vec2(row * stretch, column * stretch)
        frame_turn[i, corner] = wp.atan2(-wp.dot(tangent, upward[site]), wp.dot(tangent, direction[site]))
