"""Strings of textons: what the neighbours of a patch show along its rim, and how well a place in the sample fits them.

A patch shows the sample at ``place + turn * layout``, ``turn`` one of the field's symmetries. Places, layouts and
offsets are (column, row) vectors taken as complex numbers. The rim of a patch are its halfedges that have another patch
across, in compressed rows; ``twin`` is the halfedge there. A patch whose branch is -1 has no place yet. A string is
``length`` entries from ``own`` on: a texton, an offset from the patch's place, and the colours wanted there. Rows and
columns beyond the sample are its first or last.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.taps import mix4, tap_place

_MASKED = wp.constant(1.0e6)  # error of a point that would show a masked texel
_CIRCLE = wp.constant(6.283185307179586)


@wp.func
def times(a: wp.vec2, b: wp.vec2):
    """Product of complex numbers."""
    return wp.vec2(a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0])


@wp.func
def over(a: wp.vec2, b: wp.vec2):
    """Quotient of complex numbers; 1 where the divisor vanishes."""
    length2 = wp.dot(b, b)
    if length2 < 1.0e-12:
        return wp.vec2(1.0, 0.0)
    return wp.vec2(a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]) / length2


@wp.func
def symmetry(branch: int, order: int):
    """The turn by ``branch`` n-ths of a circle."""
    angle = _CIRCLE * float(branch) / float(order)
    return wp.vec2(wp.cos(angle), wp.sin(angle))


@wp.func
def corner_place(
    halfedge: int, layout: wp.array2d(dtype=wp.vec2), patch: wp.array(dtype=int), place: wp.array(dtype=wp.vec2),
    branch: wp.array(dtype=int), order: int,
):  # fmt: skip
    """Where in the sample the corner lies at which a halfedge of a placed patch begins."""
    f = halfedge / 3
    p = patch[f]
    return place[p] + times(symmetry(branch[p], order), layout[f, halfedge % 3])


@wp.func
def following(halfedge: int):
    """The next halfedge around the face."""
    return halfedge - halfedge % 3 + (halfedge % 3 + 1) % 3


@wp.func
def read_string(
    p: int, turn: wp.vec2, order: int, by_colour: int, spacing: float,
    rim_start: wp.array(dtype=int), rim: wp.array(dtype=int), twin: wp.array(dtype=int), patch: wp.array(dtype=int),
    layout: wp.array2d(dtype=wp.vec2), place: wp.array(dtype=wp.vec2), branch: wp.array(dtype=int),
    image: wp.array(dtype=float), channels: int, labels: wp.array3d(dtype=wp.int16), own: int,
    texton: wp.array(dtype=int), offset: wp.array(dtype=wp.vec2i), wanted: wp.array(dtype=float),
):  # fmt: skip
    """The string of a patch: along every border to a placed patch, what the neighbour shows, ``spacing`` texels apart.

    Offsets are whole texels in the patch's own plane; the neighbour's map is continued to them, and its textons are
    those of the orientation nearest to its turn against the patch. Masked texels tell nothing and are left out.
    Returns the length.
    """
    orientations = labels.shape[0]
    rows = labels.shape[1]
    columns = labels.shape[2]
    length = int(0)
    for j in range(rim_start[p], rim_start[p + 1]):
        h = rim[j]
        t = twin[h]
        if branch[patch[t / 3]] >= 0:
            a0 = times(turn, layout[h / 3, h % 3])
            along = times(turn, layout[h / 3, (h % 3 + 1) % 3]) - a0
            b0 = corner_place(following(t), layout, patch, place, branch, order)
            b1 = corner_place(t, layout, patch, place, branch, order)
            z = over(b1 - b0, along)
            turned = int(0)
            if orientations > 1:
                turned = int(wp.round(wp.atan2(z[1], z[0]) * float(orientations) / _CIRCLE))
                turned = (turned + orientations) % orientations
            count = wp.max(int(wp.ceil(wp.max(wp.abs(along[0]), wp.abs(along[1])) / spacing)), 1)
            for k in range(count):
                exact = a0 + ((float(k) + 0.5) / float(count)) * along
                o = wp.vec2(wp.round(exact[0]), wp.round(exact[1]))
                at = b0 + times(z, o - a0)
                r = wp.clamp(int(at[1] + 0.5), 0, rows - 1)
                c = wp.clamp(int(at[0] + 0.5), 0, columns - 1)
                shown = int(labels[turned, r, c])
                if shown >= 0:
                    texton[own + length] = shown
                    offset[own + length] = wp.vec2i(int(o[0]), int(o[1]))
                if shown >= 0 and by_colour != 0:
                    tap = tap_place(at[1], at[0], rows, columns)
                    upper = int(tap[0]) * columns
                    lower = wp.min(int(tap[0]) + 1, rows - 1) * columns
                    c0 = int(tap[1])
                    c1 = wp.min(c0 + 1, columns - 1)
                    for channel in range(channels):
                        wanted[(own + length) * channels + channel] = mix4(
                            image[(upper + c0) * channels + channel], image[(upper + c1) * channels + channel],
                            image[(lower + c0) * channels + channel], image[(lower + c1) * channels + channel],
                            tap[2], tap[3],
                        )  # fmt: skip
                if shown >= 0:
                    length += 1
    return length


@wp.func
def fit(
    x: int, own: int, length: int, enough: float, by_colour: int, columns: int, image: wp.array(dtype=float),
    channels: int, labels: wp.array(dtype=wp.int16), distance: wp.array2d(dtype=float), texton: wp.array(dtype=int),
    offset: wp.array(dtype=wp.vec2i), wanted: wp.array(dtype=float),
):  # fmt: skip
    """E of eq. 2 at flat position ``x``, plus differences of colour; given up where it exceeds ``enough``."""
    error = float(0.0)
    k = int(own)
    while k < own + length:
        o = offset[k]
        at = x + o[1] * columns + o[0]
        shown = int(labels[at])
        if shown < 0:
            error += _MASKED
        else:
            error += distance[texton[k], shown]
        if by_colour != 0:
            squared = float(0.0)
            for channel in range(channels):
                d = image[at * channels + channel] - wanted[k * channels + channel]
                squared += d * d
            error += wp.sqrt(squared)
        k += 1
        if error > enough:
            k = own + length
    return error


@wp.func
def fit_between(
    x: wp.vec2, own: int, length: int, enough: float, by_colour: int, rows: int, columns: int,
    image: wp.array(dtype=float), channels: int, labels: wp.array(dtype=wp.int16), distance: wp.array2d(dtype=float),
    texton: wp.array(dtype=int), offset: wp.array(dtype=wp.vec2i), wanted: wp.array(dtype=float),
):  # fmt: skip
    """The same at a place between texels: colours bilinear, textons of the nearest texel."""
    error = float(0.0)
    r_whole = wp.floor(x[1])
    c_whole = wp.floor(x[0])
    fr = x[1] - r_whole
    fc = x[0] - c_whole
    r_near = int(fr + 0.5)
    c_near = int(fc + 0.5)
    k = int(own)
    while k < own + length:
        r_at = int(r_whole) + offset[k][1]
        c_at = int(c_whole) + offset[k][0]
        r = wp.clamp(r_at, 0, rows - 1)
        c = wp.clamp(c_at, 0, columns - 1)
        down = wp.clamp(r_at + 1, 0, rows - 1) - r
        right = wp.clamp(c_at + 1, 0, columns - 1) - c
        shown = int(labels[(r + r_near * down) * columns + c + c_near * right])
        if shown < 0:
            error += _MASKED
        else:
            error += distance[texton[k], shown]
        if by_colour != 0:
            upper = (r * columns + c) * channels
            lower = upper + down * columns * channels
            squared = float(0.0)
            for channel in range(channels):
                a = upper + channel
                b = lower + channel
                d = mix4(image[a], image[a + right * channels], image[b], image[b + right * channels], fr, fc)
                d = d - wanted[k * channels + channel]
                squared += d * d
            error += wp.sqrt(squared)
        k += 1
        if error > enough:
            k = own + length
    return error


@wp.func
def nudged(
    x: wp.vec2, own: int, length: int, rows: int, columns: int, image: wp.array(dtype=float), channels: int,
    offset: wp.array(dtype=wp.vec2i), wanted: wp.array(dtype=float),
):  # fmt: skip
    """Where a Gauss-Newton step on the squared differences of colour leads, a texel away at most."""
    r_whole = wp.floor(x[1])
    c_whole = wp.floor(x[0])
    fr = x[1] - r_whole
    fc = x[0] - c_whole
    rr = float(1.0e-6)
    cc = float(1.0e-6)
    rc = float(0.0)
    r_pull = float(0.0)
    c_pull = float(0.0)
    for k in range(own, own + length):
        r_at = int(r_whole) + offset[k][1]
        c_at = int(c_whole) + offset[k][0]
        r = wp.clamp(r_at, 0, rows - 1)
        c = wp.clamp(c_at, 0, columns - 1)
        right = (wp.clamp(c_at + 1, 0, columns - 1) - c) * channels
        upper = (r * columns + c) * channels
        lower = upper + (wp.clamp(r_at + 1, 0, rows - 1) - r) * columns * channels
        for channel in range(channels):
            v00 = image[upper + channel]
            v01 = image[upper + right + channel]
            v10 = image[lower + channel]
            v11 = image[lower + right + channel]
            d = mix4(v00, v01, v10, v11, fr, fc) - wanted[k * channels + channel]
            by_row = (1.0 - fc) * (v10 - v00) + fc * (v11 - v01)
            by_column = (1.0 - fr) * (v01 - v00) + fr * (v11 - v10)
            rr += by_row * by_row
            cc += by_column * by_column
            rc += by_row * by_column
            r_pull += by_row * d
            c_pull += by_column * d
    determinant = rr * cc - rc * rc
    if determinant < 1.0e-9:
        return x
    r_step = wp.clamp((cc * r_pull - rc * c_pull) / determinant, -1.0, 1.0)
    c_step = wp.clamp((rr * c_pull - rc * r_pull) / determinant, -1.0, 1.0)
    return wp.vec2(x[0] - c_step, x[1] - r_step)


@wp.func
def hidden_texels(low: wp.vec2, high: wp.vec2, hidden: wp.array2d(dtype=int)):
    """Masked texels under a box (its corners are exemplar positions); ``hidden`` are sums over upper left parts."""
    rows = hidden.shape[0] - 1
    columns = hidden.shape[1] - 1
    r0 = wp.clamp(int(wp.floor(low[1])), 0, rows)
    c0 = wp.clamp(int(wp.floor(low[0])), 0, columns)
    r1 = wp.clamp(int(wp.ceil(high[1])) + 1, 0, rows)
    c1 = wp.clamp(int(wp.ceil(high[0])) + 1, 0, columns)
    return hidden[r1, c1] - hidden[r0, c1] - hidden[r1, c0] + hidden[r0, c0]
