"""Walking along a direction field over triangles laid flat one by one.

A triangle's record holds, in its own 2-D frame (corner 0 at the origin, corner 1 at (a, 0), corner 2 at (b, c)):
a, b, c; the n-th power of the field's direction at its corners, (re, im) each; the world length of a texel at its
corners; the rotation across each edge into the next triangle's frame, (re, im) each; 1 / a, b / (a c), 1 / c; and to
fill cache lines, nothing. Points are barycentric, so they never leave their triangle; ``twin[f, e]`` is the halfedge
``3 f' + e'`` on the other side of edge e (corner e to the next), -1 at a boundary. A walk that cannot go on ends in
face -1. Branches that depend on the place are avoided: a wrong guess costs as much as thirty products.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.frames import across, component, exit_of, rates, times

# Products and sums may fuse, divisions by one number share its inverse: a quarter of the time
CPU_FLAGS = f"{wp.config.cpu_compiler_flags or '-march=native'} -funsafe-math-optimizations -fno-slp-vectorize"
wp.set_module_options({"cpu_compiler_flags": CPU_FLAGS})

MOST_FACES = wp.constant(256)  # crossed for one sample
FAINTEST = wp.constant(0.05)  # power below this has no direction: a singularity
SHARPEST = wp.constant(0.8)  # radians turned within a face
HEAD_ON = wp.constant(0.5)  # cosine of the angle to an edge, below which two faces' fields meet head on
MOST_AMBIGUOUS = wp.constant(2.2)  # radians turned by the power: near π two roots are equally near


@wp.func
def conjugate(p: wp.vec2) -> wp.vec2:
    return wp.vec2(p[0], -p[1])


@wp.func
def right_angles(quarters: int) -> wp.vec2:
    """The rotation by 0, 1, 2 or 3 right angles, counter-clockwise."""
    along = float(wp.where(quarters == 0, 1, wp.where(quarters == 2, -1, 0)))
    return wp.vec2(along, float(wp.where(quarters == 1, 1, wp.where(quarters == 3, -1, 0))))


@wp.func
def power_at(record: wp.array2d(dtype=float), f: int, at: wp.vec3) -> wp.vec2:
    return wp.vec2(
        at[0] * record[f, 3] + at[1] * record[f, 5] + at[2] * record[f, 7],
        at[0] * record[f, 4] + at[1] * record[f, 6] + at[2] * record[f, 8],
    )


@wp.func
def texel_at(record: wp.array2d(dtype=float), f: int, at: wp.vec3) -> float:
    return at[0] * record[f, 9] + at[1] * record[f, 10] + at[2] * record[f, 11]


@wp.func
def raised(heading: wp.vec2, order: int) -> wp.vec2:
    """The order-th power, for orders 1, 2, 4 and 6."""
    if order == 1:
        return heading
    second = times(heading, heading)
    if order == 2:
        return second
    fourth = times(second, second)
    if order == 4:
        return fourth
    return times(fourth, second)


@wp.func
def nearest_root(power: wp.vec2, heading: wp.vec2, order: int) -> wp.vec2:
    """The order-th root of ``power`` nearest to ``heading``, a unit number; 0 where there is none to trust."""
    if wp.length_sq(power) < FAINTEST * FAINTEST:
        return wp.vec2(0.0, 0.0)
    change = times(power, conjugate(raised(heading, order)))
    if wp.abs(change[1]) < 0.2 * change[0]:
        # Nearly always: series to float precision, four times as fast
        t = change[1] / change[0]
        t2 = t * t
        x = t * (1.0 - t2 * (1.0 / 3.0 - t2 * (0.2 - t2 * (1.0 / 7.0 - t2 / 9.0)))) / float(order)
        x2 = x * x
        cosine = 1.0 - x2 * (0.5 - x2 * (1.0 / 24.0 - x2 / 720.0))
        return times(heading, wp.vec2(cosine, x * (1.0 - x2 * (1.0 / 6.0 - x2 / 120.0))))
    angle = wp.atan2(change[1], change[0])
    if wp.abs(angle) > wp.min(SHARPEST * float(order), MOST_AMBIGUOUS):
        return wp.vec2(0.0, 0.0)
    angle = angle / float(order)
    return wp.normalize(times(heading, wp.vec2(wp.cos(angle), wp.sin(angle))))


@wp.func
def corner(record: wp.array2d(dtype=float), f: int, c: int) -> wp.vec2:
    x = wp.where(c == 1, record[f, 0], record[f, 1])
    return wp.vec2(wp.where(c == 0, 0.0, x), wp.where(c == 2, record[f, 2], 0.0))


@wp.func
def edge(record: wp.array2d(dtype=float), f: int, e: int) -> wp.vec2:
    """From corner e to corner e + 1."""
    return corner(record, f, (e + 1) % 3) - corner(record, f, e)


@wp.func
def rates_along(record: wp.array2d(dtype=float), f: int, way: wp.vec2) -> wp.vec3:
    """Change of the barycentric coordinates in face f."""
    return rates(wp.vec3(record[f, 18], record[f, 19], record[f, 20]), way)


@wp.func
def turn_across(record: wp.array2d(dtype=float), f: int, e: int) -> wp.vec2:
    """The rotation from the frame of face f to that of the face across its edge e."""
    return wp.vec2(record[f, 12 + 2 * e], record[f, 13 + 2 * e])


@wp.func
def walk(
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    order: int,
    face: int,
    place: wp.vec3,
    direction: wp.vec2,
    aside: wp.vec2,
    texels: float,
):
    """Go on for ``texels`` along the field turned by ``aside``, from ``place``, where the field is ``direction``.

    In every face one midpoint step (second order). Lengths are in texels all along the way, so there and back is the
    same. Order 0 has no field: a straight line. Returns face, place and the field's direction there.
    """
    f = int(face)
    at = place
    heading = direction
    left = float(texels)
    entry = int(-1)  # the corner opposite the edge we came in by
    for _ in range(MOST_FACES):
        rate = rates_along(record, f, times(heading, aside))
        when, side = exit_of(at, rate)
        middle = at + (0.5 * wp.min(when, left * texel_at(record, f, at))) * rate
        texel = texel_at(record, f, middle)
        if order > 0:
            heading = nearest_root(power_at(record, f, middle), heading, order)
            if heading[0] == 0.0 and heading[1] == 0.0:
                return -1, at, heading
            rate = rates_along(record, f, times(heading, aside))
            if entry >= 0 and component(rate, entry) < 0.0:
                # The fields of two faces press towards their edge: slide along it, unless they meet head on
                along = wp.normalize(edge(record, f, (entry + 1) % 3))
                speed = wp.dot(times(heading, aside), along)
                if wp.abs(speed) < HEAD_ON:
                    return -1, at, heading
                rate = rates_along(record, f, wp.sign(speed) * along)
                rate[entry] = 0.0
            when, side = exit_of(at, rate)
        if left * texel <= when:
            at = wp.max(at + (left * texel) * rate, wp.vec3(0.0, 0.0, 0.0))
            at = at / (at[0] + at[1] + at[2])
            if order > 0:
                heading = nearest_root(power_at(record, f, at), heading, order)
                if heading[0] == 0.0 and heading[1] == 0.0:
                    return -1, at, heading
            return f, at, heading

        left = wp.max(left - when / texel, 0.0)
        at = at + when * rate
        e = wp.where(side == 2, 0, side + 1)
        halfedge = twin[f, e]
        if halfedge < 0:
            return -1, at, heading
        heading = times(heading, turn_across(record, f, e))
        f = halfedge // 3
        t = halfedge - 3 * f
        at = across(at, e, t)
        entry = wp.where(t == 0, 2, t - 1)
    return -1, at, heading


@wp.func
def trace_line(
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    order: int,
    first: int,
    stride: int,
    steps: int,
    quarters: int,
    face: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec3),
    heading: wp.array(dtype=wp.vec2),
):
    """Samples first + stride, ..., first + steps * stride: each one texel on from the one before."""
    s = int(first)
    f = int(face[s])
    at = place[s]
    way = heading[s]
    at = wp.vec3(at[0], at[1], at[2])
    way = wp.vec2(way[0], way[1])
    aside = right_angles(quarters)
    for _ in range(steps):
        s = s + stride
        if f >= 0:
            f, at, way = walk(record, twin, order, f, at, way, aside, 1.0)
        face[s] = f
        place[s] = at
        heading[s] = way


@wp.kernel(enable_backward=False)
def trace_lines(
    start: int,
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    order: int,
    first: wp.array(dtype=int),  # sample each line goes on from
    stride: int,  # between samples of a line
    steps: int,
    quarters: int,
    face: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec3),
    heading: wp.array(dtype=wp.vec2),
):
    """One line for every item, as in ``trace_line``."""
    i = start + wp.tid()
    trace_line(record, twin, order, first[i], stride, steps, quarters, face, place, heading)


@wp.kernel(enable_backward=False)
def trace_squares(
    start: int,
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    order: int,
    width: int,
    patches: int,
    face: wp.array(dtype=int),  # the squares of all patches, then those of the other paths
    place: wp.array(dtype=wp.vec3),
    heading: wp.array(dtype=wp.vec2),
):
    """Both paths to every sample of square i from its middle one: a spine through it, then lines off the spine.

    The first goes up and down and then left and right, the other left and right first.
    """
    i = start + wp.tid()
    before = width // 2
    for path in range(2):
        middle = (path * patches + i) * width * width + before * width + before
        for k in range(2 * (width + 1)):
            forward = k % 2
            spine = k < 2
            vertical = spine == (path == 0)
            stride = wp.where(vertical, width, 1)
            first = middle + wp.where(spine, 0, (k // 2 - 1 - before) * wp.where(vertical, 1, width))
            steps = wp.where(forward == 1, width - 1 - before, before)
            quarters = wp.where(vertical, 1, 2)
            if forward == 1:
                quarters = wp.where(vertical, 3, 0)
            else:
                stride = -stride
            trace_line(record, twin, order, first, stride, steps, quarters, face, place, heading)
