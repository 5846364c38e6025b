"""Pixels lit: key, fill and sky light on vertex colours or a texture pyramid, over 2×2 samples."""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.raster import edge, near_weights


@wp.func
def texture_tap(texture: wp.array(dtype=wp.vec3), first: int, side_rows: int, side_columns: int, uv: wp.vec2):
    """Bilinear sample of one level of a texture pyramid, wrapping; uv has v up."""
    x = (uv[0] - wp.floor(uv[0])) * float(side_columns) - 0.5
    y = (1.0 - (uv[1] - wp.floor(uv[1]))) * float(side_rows) - 0.5
    x0 = wp.floor(x)
    y0 = wp.floor(y)
    fx = x - x0
    fy = y - y0
    c0 = (int(x0) + side_columns) % side_columns
    r0 = (int(y0) + side_rows) % side_rows
    c1 = (c0 + 1) % side_columns
    r1 = (r0 + 1) % side_rows
    upper = (1.0 - fx) * texture[first + r0 * side_columns + c0] + fx * texture[first + r0 * side_columns + c1]
    lower = (1.0 - fx) * texture[first + r1 * side_columns + c0] + fx * texture[first + r1 * side_columns + c1]
    return (1.0 - fy) * upper + fy * lower


@wp.func
def pyramid_tap(
    texture: wp.array(dtype=wp.vec3), level_first: wp.array(dtype=int), rows: int, columns: int, level: float,
    uv: wp.vec2,
):  # fmt: skip
    """Trilinear sample of a texture pyramid at a fractional level."""
    last = level_first.shape[0] - 1
    fine = wp.clamp(level, 0.0, float(last))
    low = int(wp.floor(fine))
    high = wp.min(low + 1, last)
    below = texture_tap(texture, level_first[low], rows >> low, columns >> low, uv)
    above = texture_tap(texture, level_first[high], rows >> high, columns >> high, uv)
    return below + (fine - float(low)) * (above - below)


@wp.func
def reflected(normal: wp.vec3, view: wp.vec3, albedo: wp.vec3, key: wp.vec3, fill: wp.vec3, up: wp.vec3, gloss: float):
    """Light towards the viewer: key and fill (Lambert plus a Blinn-Phong highlight), and a sky brighter above."""
    sharp = 24.0
    key_part = wp.max(wp.dot(normal, key), 0.0)
    fill_part = wp.max(wp.dot(normal, fill), 0.0)
    sky = 0.5 + 0.5 * wp.dot(normal, up)
    light = wp.vec3(0.86, 0.84, 0.80) * key_part + wp.vec3(0.17, 0.19, 0.23) * fill_part
    light += wp.vec3(0.11, 0.105, 0.10) + sky * wp.vec3(0.15, 0.16, 0.18)
    half = wp.normalize(key + view)
    shine = gloss * wp.pow(wp.max(wp.dot(normal, half), 0.0), sharp) * key_part
    rim = 0.25 * gloss * wp.pow(1.0 - wp.max(wp.dot(normal, view), 0.0), 4.0)
    return wp.cw_mul(albedo, light) + wp.vec3(shine + rim, shine + rim, shine + rim)


@wp.kernel(enable_backward=False)
def shade_pixels(
    start: int, visible: wp.array2d(dtype=int), corners: wp.array2d(dtype=wp.vec2d), nearness: wp.array2d(dtype=float),
    faces: wp.array2d(dtype=int), vertices: wp.array(dtype=wp.vec3), normals: wp.array(dtype=wp.vec3),
    colours: wp.array(dtype=wp.vec3), uv: wp.array2d(dtype=wp.vec2), texture: wp.array(dtype=wp.vec3),
    level_first: wp.array(dtype=int), rows: int, columns: int, bumps: wp.array(dtype=wp.vec3), has_bumps: int,
    tangents: wp.array2d(dtype=wp.vec4), eye: wp.vec3, ahead: wp.vec3, perspective: int, key: wp.vec3, fill: wp.vec3,
    up: wp.vec3, gloss: float, light: wp.array(dtype=wp.vec3), cover: wp.array(dtype=float),
):  # fmt: skip
    """Linear light (times cover) and cover of each pixel, over its 2×2 samples.

    ``nearness`` is what screen-space weights are multiplied by to make them true to perspective (1 / distance, or 1).
    ``texture`` is a pyramid of ``rows × columns`` at its finest; without one (``rows`` 0) vertices have ``colours``.
    """
    pixel = start + wp.tid()
    width = visible.shape[1] / 2
    total = wp.vec3(0.0, 0.0, 0.0)
    hits = float(0.0)
    for sample in range(4):
        row = 2 * (pixel / width) + sample / 2
        column = 2 * (pixel % width) + sample % 2
        face = visible[row, column]
        if face >= 0:
            a = wp.vec2d(corners[face, 0])
            b = wp.vec2d(corners[face, 1])
            c = wp.vec2d(corners[face, 2])
            flat = near_weights(a, b, c, wp.vec2d(wp.float64(column), wp.float64(row)))
            w0 = float(flat[0]) * nearness[face, 0]
            w1 = float(flat[1]) * nearness[face, 1]
            w2 = float(flat[2]) * nearness[face, 2]
            whole = w0 + w1 + w2
            w0 = w0 / whole
            w1 = w1 / whole
            w2 = w2 / whole
            i0 = faces[face, 0]
            i1 = faces[face, 1]
            i2 = faces[face, 2]
            normal = wp.normalize(w0 * normals[i0] + w1 * normals[i1] + w2 * normals[i2])
            place = w0 * vertices[i0] + w1 * vertices[i1] + w2 * vertices[i2]
            view = -ahead
            if perspective != 0:
                view = wp.normalize(eye - place)
            albedo = wp.vec3(0.0, 0.0, 0.0)
            if rows == 0:
                albedo = w0 * colours[i0] + w1 * colours[i1] + w2 * colours[i2]
            else:
                t0 = wp.vec2(uv[face, 0])
                t1 = wp.vec2(uv[face, 1])
                t2 = wp.vec2(uv[face, 2])
                e1 = t1 - t0
                e2 = t2 - t0
                texels = wp.abs(e1[0] * e2[1] - e1[1] * e2[0]) * float(rows) * float(columns)
                samples = wp.max(wp.abs(float(edge(a, b, c))), 1.0e-6)
                level = 0.5 * wp.log2(wp.max(texels / samples, 1.0e-6))
                at = w0 * t0 + w1 * t1 + w2 * t2
                albedo = pyramid_tap(texture, level_first, rows, columns, level, at)
                if has_bumps != 0:
                    q = w0 * tangents[face, 0] + w1 * tangents[face, 1] + w2 * tangents[face, 2]
                    tangent = wp.vec3(q[0], q[1], q[2])
                    bump = 2.0 * pyramid_tap(bumps, level_first, rows, columns, level, at) - wp.vec3(1.0, 1.0, 1.0)
                    side = q[3] * wp.cross(normal, tangent)
                    normal = wp.normalize(bump[0] * tangent + bump[1] * side + bump[2] * normal)
            if wp.dot(normal, view) < -0.2:  # a back side; smooth normals may lean a little away at the outline
                normal = -normal
            total += reflected(normal, view, albedo, key, fill, up, gloss)
            hits += 1.0
    light[pixel] = 0.25 * total
    cover[pixel] = 0.25 * hits
