"""Values of an exemplar map read through sources: cubic between texels, blended by weight.

Maps are (row, column, group) with four channels a group; those of normals have the length of each vector as the fourth.
An exemplar position outside the map reads its nearest edge. A source's turn ``t`` takes an offset to
``(row cos t + column sin t, column cos t - row sin t) / scale``, the standard rotation of (column, row) with rows
running down. Arrays of turns and scales are empty where all are 0, or 1.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.taps import cubic, four_around

SAME = wp.constant(1.0e-3)  # texels, or radians: corners that read nearer to each other than that read once


@wp.func
def bounded(value: wp.vec4, low: wp.vec4, high: wp.vec4) -> wp.vec4:
    """A value that leaves [low, high] by no more than its length, and [0, 1] only where that does."""
    within = wp.vec4()
    for k in range(4):
        least = low[k] + low[k] - high[k]
        most = high[k] + high[k] - low[k]
        if low[k] >= 0.0:
            least = wp.max(least, 0.0)
        if high[k] <= 1.0:
            most = wp.min(most, 1.0)
        within[k] = wp.clamp(value[k], least, most)
    return within


@wp.func
def read(image: wp.array3d(dtype=wp.vec4), row: float, column: float, group: int) -> wp.vec4:
    """Four channels at a place, bounded by the four texels around; exact at texels. Borders repeat for a texel."""
    r = wp.clamp(row, -1.0, float(image.shape[0]))
    c = wp.clamp(column, -1.0, float(image.shape[1]))
    down = four_around(wp.floor(r), image.shape[0])
    across = four_around(wp.floor(c), image.shape[1])
    if r == wp.floor(r) and c == wp.floor(c):
        return image[down[1], across[1], group]
    by_row = cubic(r - wp.floor(r))
    by_column = cubic(c - wp.floor(c))
    value = wp.vec4(0.0, 0.0, 0.0, 0.0)
    for i in range(4):
        value += by_row[i] * (
            by_column[0] * image[down[i], across[0], group]
            + by_column[1] * image[down[i], across[1], group]
            + by_column[2] * image[down[i], across[2], group]
            + by_column[3] * image[down[i], across[3], group]
        )
    one = image[down[1], across[1], group]
    two = image[down[1], across[2], group]
    three = image[down[2], across[1], group]
    four = image[down[2], across[2], group]
    low = wp.min(wp.min(one, two), wp.min(three, four))
    return bounded(value, low, wp.max(wp.max(one, two), wp.max(three, four)))


@wp.func
def add_values(
    image: wp.array3d(dtype=wp.vec4), row: float, column: float, weight: float, values: wp.array2d(dtype=float), i: int
):
    """values[i] += weight * image(row, column)."""
    for group in range(image.shape[2]):
        value = weight * read(image, row, column, group)
        for k in range(4):
            if 4 * group + k < values.shape[1]:
                values[i, 4 * group + k] = values[i, 4 * group + k] + value[k]


@wp.func
def turned_normal(image: wp.array3d(dtype=wp.vec4), row: float, column: float, turn: float):
    """The vector at a point, turned counter-clockwise by ``turn``, and the stored length there: (x, y, z, length)."""
    packed = read(image, row, column, 0)
    x = 2.0 * packed[0] - 1.0
    y = 2.0 * packed[1] - 1.0
    cosine = wp.cos(turn)
    sine = wp.sin(turn)
    return wp.vec4(x * cosine - y * sine, x * sine + y * cosine, 2.0 * packed[2] - 1.0, packed[3])


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


@wp.func
def turn_of(turn: wp.array2d(dtype=float), s: int, k: int) -> float:
    """A source's turn; 0 where none has any."""
    angle = float(0.0)
    if turn.shape[0] > 0:
        angle = turn[s, k]
    return angle


@wp.kernel(enable_backward=False)
def values_at_sites(
    start: int, image: wp.array3d(dtype=wp.vec4),
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float), values: wp.array2d(dtype=float),
):  # fmt: skip
    """values[i] = sum_k weight[i, k] * image(position[i, k])."""
    i = start + wp.tid()
    for channel in range(values.shape[1]):
        values[i, channel] = 0.0
    for k in range(weight.shape[1]):
        w = weight[i, k]
        if w > 0.0:
            at = position[i, k]
            add_values(image, at[0], at[1], w, values, i)


@wp.kernel(enable_backward=False)
def normals_at_sites(
    start: int, image: wp.array3d(dtype=wp.vec4),
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float),
    turn: wp.array2d(dtype=float), values: wp.array2d(dtype=float),
):  # fmt: skip
    """Like ``values_at_sites`` for packed vectors: each turned by its source's turn, the blend renormalised."""
    i = start + wp.tid()
    total = wp.vec4(0.0, 0.0, 0.0, 0.0)
    for k in range(weight.shape[1]):
        w = weight[i, k]
        if w > 0.0:
            at = position[i, k]
            total += w * turned_normal(image, at[0], at[1], turn_of(turn, i, k))
    pack(total, values, i)


@wp.func
def shown_at(at: wp.vec2, turn: wp.array2d(dtype=float), scale: wp.array2d(dtype=float), s: int, k: int, d: wp.vec2):
    """Where a source of site s reads at an offset from it."""
    offset = d
    if turn.shape[0] > 0:
        cosine = wp.cos(turn[s, k])
        sine = wp.sin(turn[s, k])
        offset = wp.vec2(cosine * d[0] + sine * d[1], cosine * d[1] - sine * d[0])
    if scale.shape[0] > 0:
        offset = offset / scale[s, k]
    return at + offset


@wp.kernel(enable_backward=False)
def values_at_points(
    start: int, image: wp.array3d(dtype=wp.vec4),
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float),
    turn: wp.array2d(dtype=float), scale: wp.array2d(dtype=float),
    sites: wp.array2d(dtype=int), barycentric: wp.array2d(dtype=float), offsets: wp.array2d(dtype=wp.vec2),
    values: wp.array2d(dtype=float),
):  # fmt: skip
    """values[i] = sum_c barycentric[i, c] sum_k weight[s, k] * image(position[s, k] + R(turn) offset / scale)."""
    i = start + wp.tid()
    for channel in range(values.shape[1]):
        values[i, channel] = 0.0
    for k in range(weight.shape[1]):
        place = wp.vec2(0.0, 0.0)
        total = float(0.0)  # of the weights that read there
        for corner in range(3):
            s = sites[i, corner]
            w = float(0.0)
            if barycentric[i, corner] > 0.0:  # a corner that does not count may have no site
                w = barycentric[i, corner] * weight[s, k]
            if w > 0.0:
                there = shown_at(position[s, k], turn, scale, s, k, offsets[i, corner])
                if total > 0.0 and wp.length(there - place) > SAME:
                    add_values(image, place[0], place[1], total, values, i)
                    total = 0.0
                place = there
                total += w
        if total > 0.0:
            add_values(image, place[0], place[1], total, values, i)


@wp.kernel(enable_backward=False)
def normals_at_points(
    start: int, image: wp.array3d(dtype=wp.vec4),
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float),
    turn: wp.array2d(dtype=float), scale: wp.array2d(dtype=float),
    sites: wp.array2d(dtype=int), barycentric: wp.array2d(dtype=float), offsets: wp.array2d(dtype=wp.vec2),
    frame_turn: wp.array2d(dtype=float), values: wp.array2d(dtype=float),
):  # fmt: skip
    """Like ``values_at_points`` for packed vectors: each turned by its source's turn and by its site's frame_turn."""
    i = start + wp.tid()
    blend = wp.vec4(0.0, 0.0, 0.0, 0.0)
    for k in range(weight.shape[1]):
        place = wp.vec2(0.0, 0.0)
        angle = float(0.0)
        total = float(0.0)  # of the weights that read there, turned so
        for corner in range(3):
            s = sites[i, corner]
            w = float(0.0)
            if barycentric[i, corner] > 0.0:  # a corner that does not count may have no site
                w = barycentric[i, corner] * weight[s, k]
            if w > 0.0:
                there = shown_at(position[s, k], turn, scale, s, k, offsets[i, corner])
                turned = turn_of(turn, s, k) + frame_turn[i, corner]
                if total > 0.0 and (wp.length(there - place) > SAME or wp.abs(turned - angle) > SAME):
                    blend += total * turned_normal(image, place[0], place[1], angle)
                    total = 0.0
                place = there
                angle = turned
                total += w
        if total > 0.0:
            blend += total * turned_normal(image, place[0], place[1], angle)
    pack(blend, values, i)
