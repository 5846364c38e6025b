"""Values of an exemplar map read through sources: bilinear taps, blended by weight.

Maps are flat ``(rows * columns * channels)`` floats. An exemplar position outside the map reads its nearest edge. A
source's turn ``t`` takes an offset to ``(row cos t + column sin t, column cos t - row sin t) / scale``, the standard
rotation of (column, row) with rows running down.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp


@wp.func
def tap_place(row: float, column: float, rows: int, columns: int):
    """Upper left texel and fractions of a bilinear tap: (row, column, row fraction, column fraction)."""
    r = wp.clamp(row, 0.0, float(rows - 1))
    c = wp.clamp(column, 0.0, float(columns - 1))
    r0 = wp.floor(r)
    c0 = wp.floor(c)
    return wp.vec4(r0, c0, r - r0, c - c0)


@wp.func
def mix4(a: float, b: float, c: float, d: float, fr: float, fc: float):
    """Bilinear mean of the four texels around a point; exactly ``a`` where both fractions are 0."""
    return (1.0 - fr) * ((1.0 - fc) * a + fc * b) + fr * ((1.0 - fc) * c + fc * d)


@wp.func
def packed_normal(image: wp.array(dtype=float), at: int):
    """The vector stored at an element, unpacked from [0, 1] to [-1, 1]."""
    return wp.vec3(2.0 * image[at] - 1.0, 2.0 * image[at + 1] - 1.0, 2.0 * image[at + 2] - 1.0)


@wp.func
def add_values(
    image: wp.array(dtype=float), rows: int, columns: int, channels: int,
    row: float, column: float, weight: float, values: wp.array2d(dtype=float), i: int,
):  # fmt: skip
    """values[i] += weight * image(row, column)."""
    place = tap_place(row, column, rows, columns)
    r0 = int(place[0])
    c0 = int(place[1])
    a = (r0 * columns + c0) * channels
    b = (r0 * columns + wp.min(c0 + 1, columns - 1)) * channels
    down = (wp.min(r0 + 1, rows - 1) - r0) * columns * channels
    for channel in range(channels):
        k = a + channel
        m = b + channel
        value = mix4(image[k], image[m], image[k + down], image[m + down], place[2], place[3])
        values[i, channel] = values[i, channel] + weight * value


@wp.func
def turned_normal(
    image: wp.array(dtype=float), rows: int, columns: int, channels: int, row: float, column: float, turn: float
):
    """The vector at a point, turned counter-clockwise by ``turn``, and the mean stored length, as (x, y, z, length)."""
    place = tap_place(row, column, rows, columns)
    r0 = int(place[0])
    c0 = int(place[1])
    a = (r0 * columns + c0) * channels
    b = (r0 * columns + wp.min(c0 + 1, columns - 1)) * channels
    down = (wp.min(r0 + 1, rows - 1) - r0) * columns * channels
    na = packed_normal(image, a)
    nb = packed_normal(image, b)
    nc = packed_normal(image, a + down)
    nd = packed_normal(image, b + down)
    length = mix4(wp.length(na), wp.length(nb), wp.length(nc), wp.length(nd), place[2], place[3])
    x = mix4(na[0], nb[0], nc[0], nd[0], place[2], place[3])
    y = mix4(na[1], nb[1], nc[1], nd[1], place[2], place[3])
    z = mix4(na[2], nb[2], nc[2], nd[2], place[2], place[3])
    cosine = wp.cos(turn)
    sine = wp.sin(turn)
    return wp.vec4(x * cosine - y * sine, x * sine + y * cosine, z, length)


@wp.func
def pack(total: wp.vec4, values: wp.array2d(dtype=float), i: int):
    """Renormalise a blend of vectors to the mean stored length and pack it into [0, 1]."""
    blend = wp.vec3(total[0], total[1], total[2])
    length = wp.length(blend)
    unit = wp.vec3(0.0, 0.0, total[3])
    if length > 1.0e-6:
        unit = blend * (total[3] / length)
    values[i, 0] = 0.5 * unit[0] + 0.5
    values[i, 1] = 0.5 * unit[1] + 0.5
    values[i, 2] = 0.5 * unit[2] + 0.5


@wp.kernel(enable_backward=False)
def values_at_sites(
    start: int, image: wp.array(dtype=float), rows: int, columns: int, channels: int,
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float), values: wp.array2d(dtype=float),
):  # fmt: skip
    """values[i] = sum_k weight[i, k] * image(position[i, k])."""
    i = start + wp.tid()
    for channel in range(channels):
        values[i, channel] = 0.0
    for k in range(weight.shape[1]):
        w = weight[i, k]
        if w > 0.0:
            at = position[i, k]
            add_values(image, rows, columns, channels, at[0], at[1], w, values, i)


@wp.kernel(enable_backward=False)
def normals_at_sites(
    start: int, image: wp.array(dtype=float), rows: int, columns: int, channels: int,
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float),
    turn: wp.array2d(dtype=float), has_turn: int, values: wp.array2d(dtype=float),
):  # fmt: skip
    """Like ``values_at_sites`` for packed vectors: each turned by its source's turn, the blend renormalised."""
    i = start + wp.tid()
    total = wp.vec4(0.0, 0.0, 0.0, 0.0)
    for k in range(weight.shape[1]):
        w = weight[i, k]
        if w > 0.0:
            at = position[i, k]
            angle = float(0.0)
            if has_turn != 0:
                angle = turn[i, k]
            total += w * turned_normal(image, rows, columns, channels, at[0], at[1], angle)
    pack(total, values, i)


@wp.kernel(enable_backward=False)
def values_at_points(
    start: int, image: wp.array(dtype=float), rows: int, columns: int, channels: int,
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float),
    turn: wp.array2d(dtype=float), scale: wp.array2d(dtype=float), has_turn: int, has_scale: int,
    sites: wp.array2d(dtype=int), barycentric: wp.array2d(dtype=float), offsets: wp.array2d(dtype=wp.vec2),
    values: wp.array2d(dtype=float),
):  # fmt: skip
    """values[i] = sum_c barycentric[i, c] sum_k weight[s, k] * image(position[s, k] + R(turn) offset / scale)."""
    i = start + wp.tid()
    for channel in range(channels):
        values[i, channel] = 0.0
    for corner in range(3):
        share = barycentric[i, corner]
        if share > 0.0:
            s = sites[i, corner]
            offset = offsets[i, corner]
            for k in range(weight.shape[1]):
                w = weight[s, k]
                if w > 0.0:
                    at = position[s, k]
                    d = wp.vec2(offset[0], offset[1])
                    if has_turn != 0:
                        cosine = wp.cos(turn[s, k])
                        sine = wp.sin(turn[s, k])
                        d = wp.vec2(cosine * offset[0] + sine * offset[1], cosine * offset[1] - sine * offset[0])
                    if has_scale != 0:
                        d = d / scale[s, k]
                    add_values(image, rows, columns, channels, at[0] + d[0], at[1] + d[1], share * w, values, i)


@wp.kernel(enable_backward=False)
def normals_at_points(
    start: int, image: wp.array(dtype=float), rows: int, columns: int, channels: int,
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float),
    turn: wp.array2d(dtype=float), scale: wp.array2d(dtype=float), has_turn: int, has_scale: int,
    sites: wp.array2d(dtype=int), barycentric: wp.array2d(dtype=float), offsets: wp.array2d(dtype=wp.vec2),
    frame_turn: wp.array2d(dtype=float), values: wp.array2d(dtype=float),
):  # fmt: skip
    """Like ``values_at_points`` for packed vectors: each turned by its source's turn and by its site's frame_turn."""
    i = start + wp.tid()
    total = wp.vec4(0.0, 0.0, 0.0, 0.0)
    for corner in range(3):
        share = barycentric[i, corner]
        if share > 0.0:
            s = sites[i, corner]
            offset = offsets[i, corner]
            for k in range(weight.shape[1]):
                w = weight[s, k]
                if w > 0.0:
                    at = position[s, k]
                    d = wp.vec2(offset[0], offset[1])
                    angle = frame_turn[i, corner]
                    if has_turn != 0:
                        cosine = wp.cos(turn[s, k])
                        sine = wp.sin(turn[s, k])
                        d = wp.vec2(cosine * offset[0] + sine * offset[1], cosine * offset[1] - sine * offset[0])
                        angle += turn[s, k]
                    if has_scale != 0:
                        d = d / scale[s, k]
                    r = at[0] + d[0]
                    c = at[1] + d[1]
                    total += share * w * turned_normal(image, rows, columns, channels, r, c, angle)
    pack(total, values, i)
