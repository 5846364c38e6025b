"""The shapes of cells, which of the sample's each shows, and the place in the sample that each texel shows."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

STEPS = wp.constant(3)  # towards a depth


@wp.func
def bearing(v: wp.vec2) -> float:
    """The direction of a vector as a number in [0, 4): the way along |row| + |column| = 1, linear in each quarter."""
    t = v[0] / wp.max(wp.abs(v[0]) + wp.abs(v[1]), 1.0e-20)
    if v[1] < 0.0:
        t = 2.0 - t
    elif v[0] < 0.0:
        t = 4.0 + t
    return t


@wp.func
def direction(bearing: float) -> wp.vec2:
    """The unit vector in a direction given as such a number, any multiple of 4 more or less."""
    t = bearing - 4.0 * wp.floor(bearing / 4.0)
    row = t
    if t > 3.0:
        row = t - 4.0
    elif t > 1.0:
        row = 2.0 - t
    column = 1.0 - wp.abs(row)
    if t > 1.0 and t < 3.0:
        column = -column
    return wp.normalize(wp.vec2(row, column))


@wp.kernel(enable_backward=False)
def rims(
    start: int,
    opens: wp.array(dtype=int),  # of every outline, and one past the last
    point: wp.array(dtype=wp.vec2),
    centre: wp.array(dtype=wp.vec2),
    rim: wp.array2d(dtype=wp.vec2),
):
    """rim[i, j] = how far cell i reaches from its centre in direction j, and the cosine between ray and normal there.

    Where a ray meets the outline more than once the first time counts; (0, 1) where it never does, or comes from
    without. An item is a cell.
    """
    i = start + wp.tid()
    bins = rim.shape[1]
    step = 4.0 / float(bins)
    for j in range(bins):
        rim[i, j] = wp.vec2(1.0e10, 1.0)
    for k in range(opens[i], opens[i + 1]):
        following = wp.where(k + 1 < opens[i + 1], k + 1, opens[i])
        a = point[k] - centre[i]
        along = point[following] - point[k]
        first = bearing(a)
        turn = bearing(a + along) - first
        turn = turn - 4.0 * wp.floor(turn / 4.0 + 0.5)
        low = int(wp.ceil((first + wp.min(turn, 0.0)) / step - 1.0e-3))
        high = int(wp.floor((first + wp.max(turn, 0.0)) / step + 1.0e-3))
        for j in range(low, high + 1):
            to = direction(float(j) * step)
            sine = to[0] * along[1] - to[1] * along[0]
            if wp.abs(sine) > 1.0e-9:
                length = (a[0] * along[1] - a[1] * along[0]) / sine
                at = (j + bins) % bins
                if length > 0.0 and length < rim[i, at][0]:
                    rim[i, at] = wp.vec2(length, wp.where(turn < 0.0, 1.0, -1.0) * wp.abs(sine) / wp.length(along))
    for j in range(bins):
        if rim[i, j][0] > 1.0e9 or rim[i, j][1] < 0.0:
            rim[i, j] = wp.vec2(0.0, 1.0)


@wp.kernel(enable_backward=False)
def deepest(
    start: int,
    opens: wp.array(dtype=int),  # of every outline, and one past the last
    point: wp.array(dtype=wp.vec2),
    probes: int,  # a side
    place: wp.array(dtype=wp.vec2),
    depth: wp.array(dtype=float),
):
    """The place within each outline that is furthest from it, of a lattice over its box, and how far that is."""
    i = start + wp.tid()
    low = point[opens[i]]
    high = point[opens[i]]
    for k in range(opens[i], opens[i + 1]):
        low = wp.min(low, point[k])
        high = wp.max(high, point[k])
    pitch = (high - low) / float(probes)
    place[i] = 0.5 * (low + high)
    depth[i] = 0.0
    for n in range(probes * probes):
        share = wp.vec2(float(n // probes) + 0.5, float(n % probes) + 0.5)
        p = low + wp.cw_mul(share, pitch)
        least = float(1.0e20)
        inside = int(0)
        for k in range(opens[i], opens[i + 1]):
            a = point[k]
            along = point[wp.where(k + 1 < opens[i + 1], k + 1, opens[i])] - a
            off = p - a
            t = wp.clamp(wp.dot(off, along) / wp.max(wp.dot(along, along), 1.0e-20), 0.0, 1.0)
            least = wp.min(least, wp.length_sq(off - t * along))
            if (off[0] < 0.0) != (off[0] - along[0] < 0.0):
                if (along[0] * off[1] - along[1] * off[0] > 0.0) == (along[0] > 0.0):
                    inside = 1 - inside
        if inside == 1 and wp.sqrt(least) > depth[i]:
            depth[i] = wp.sqrt(least)
            place[i] = p


@wp.func
def rim_at(rim: wp.array2d(dtype=wp.vec2), cell: int, v: wp.vec2) -> wp.vec2:
    """The rim of a cell in the direction of a vector, on the chord between the directions beside it."""
    bins = rim.shape[1]
    at = bearing(v) * float(bins) / 4.0
    j = int(wp.floor(at))
    f = at - float(j)
    one = rim[cell, j % bins]
    other = rim[cell, (j + 1) % bins]
    length = 1.0 / ((1.0 - f) / wp.max(one[0], 1.0e-3) + f / wp.max(other[0], 1.0e-3))
    return wp.vec2(length, wp.max((1.0 - f) * one[1] + f * other[1], 0.2))


@wp.func
def at_depth(
    away: wp.array2d(dtype=float), wrap: int, centre: wp.vec2, to: wp.vec2, rim: wp.vec2, depth: float
) -> float:
    """How far from a centre, along a ray to the rim, the nearest edge is so far away.

    Begins where it would be behind a straight rim and steps by what is missing, which never leads past the place.
    """
    rho = rim[0] - depth / rim[1]
    for _step in range(STEPS):
        place = centre + wp.max(rho, 0.0) * to
        found = float(0.0)
        if wrap != 0:
            row = int(wp.round(place[0])) % away.shape[0]
            column = int(wp.round(place[1])) % away.shape[1]
            found = away[(row + away.shape[0]) % away.shape[0], (column + away.shape[1]) % away.shape[1]]
        else:
            row0 = wp.clamp(int(wp.floor(place[0])), 0, away.shape[0] - 1)
            column0 = wp.clamp(int(wp.floor(place[1])), 0, away.shape[1] - 1)
            row1 = wp.min(row0 + 1, away.shape[0] - 1)
            column1 = wp.min(column0 + 1, away.shape[1] - 1)
            fr = wp.clamp(place[0] - float(row0), 0.0, 1.0)
            fc = wp.clamp(place[1] - float(column0), 0.0, 1.0)
            above = (1.0 - fc) * away[row0, column0] + fc * away[row0, column1]
            below = (1.0 - fc) * away[row1, column0] + fc * away[row1, column1]
            found = (1.0 - fr) * above + fr * below
        rho = wp.min(rho + found - depth, rim[0])
    return wp.max(rho, 0.0)


@wp.kernel(enable_backward=False)
def carry_cells(
    start: int,
    first: wp.vec2i,  # of the window
    columns: int,  # of the window
    size: wp.vec2,  # of the torus that the texture is, else 0
    zone: float,  # texels from an edge that keep their distance to it; 0 for none
    cell: wp.array2d(dtype=int),
    away: wp.array2d(dtype=float),
    centre: wp.array(dtype=wp.vec2),  # of the texture's cells
    rim: wp.array2d(dtype=wp.vec2),
    depth: wp.array(dtype=float),  # of cells that no centre sees whole: of their deepest texel; of others 0
    source: wp.array(dtype=int),  # the sample's cell that each is given, and how it is fitted
    fit: wp.array(dtype=wp.mat22),
    bend: wp.vec2,
    turn: wp.array(dtype=float),
    sample_wraps: int,
    sample_away: wp.array2d(dtype=float),
    sample_centre: wp.array(dtype=wp.vec2),
    sample_rim: wp.array2d(dtype=wp.vec2),
    position: wp.array2d(dtype=wp.vec2),
    turns: wp.array2d(dtype=float),
    scales: wp.array2d(dtype=float),
):
    """position = c' + ρ' F o / |F o|, for o from the cell's centre c to the texel, ρ = |o|; texels of no cell are left.

    ρ' = (1 - t²) |F o| + t² ρ r' / r with the rims r and r' in these directions, t = bend · (1, ρ / r) within [0, 1].
    Within the zone it is where edges are as far away as in the texture; from one to two zones it passes to that.
    """
    i = start + wp.tid()
    row = first[0] + i // columns
    column = first[1] + i % columns
    c = cell[row, column]
    if c < 0:
        return
    o = wp.vec2(float(row), float(column)) - centre[c]
    if size[0] > 0.0:
        o = o - wp.vec2(wp.round(o[0] / size[0]) * size[0], wp.round(o[1] / size[1]) * size[1])
    rho = wp.length(o)
    if rho < 1.0e-4:
        o = wp.vec2(1.0e-4, 0.0)
        rho = 1.0e-4
    s = source[c]
    to = wp.normalize(fit[c] * o)
    there = rim_at(sample_rim, s, to)
    deep = away[row, column]
    whole = depth[c]
    if whole > 0.0:
        rho = wp.max(whole - deep, 0.0)
    else:
        whole = rim_at(rim, c, o)[0]

    share = wp.clamp(bend[0] + bend[1] * rho / wp.max(whole, 1.0e-3), 0.0, 1.0)
    share = share * share
    straight = rho * wp.length(fit[c] * o) / wp.length(o)
    shown = (1.0 - share) * straight + share * rho * there[0] / wp.max(whole, 1.0e-3)
    if share > 0.0:
        shown = wp.min(shown, there[0])
    enlarged = wp.max(rho, 0.1) / wp.max(shown, 0.1)
    if deep < 2.0 * zone:
        kept = wp.clamp(2.0 - deep / zone, 0.0, 1.0)
        at = at_depth(sample_away, sample_wraps, sample_centre[s], to, there, deep)
        shown = kept * at + (1.0 - kept) * shown
        enlarged = kept + (1.0 - kept) * enlarged
    position[row, column] = sample_centre[s] + shown * to
    turns[row, column] = turn[c]
    scales[row, column] = wp.clamp(enlarged, 0.25, 4.0)


@wp.kernel(enable_backward=False)
def deal(
    start: int,
    order: wp.array(dtype=int),
    cost: wp.array2d(dtype=float),  # of every choice for every cell, infinite where it is none
    even: float,
    share: wp.array2d(dtype=float),  # one over how often each cell of the sample may well be shown
    opens: wp.array(dtype=int),  # of every cell's neighbours, and one past the last
    beside: wp.array(dtype=int),
    source: wp.array(dtype=int),  # -1 to begin with
    used: wp.array(dtype=int),  # 0 to begin with
):
    """source[c] = the cheapest choice, cost + even * times used * share, that no neighbour has; if all are, of all.

    One item: each choice depends on those before.
    """
    for n in range(order.shape[0]):
        c = order[n]
        best = int(-1)
        spare = int(-1)
        least = float(1.0e30)
        least_spare = float(1.0e30)
        for s in range(cost.shape[1]):
            if cost[c, s] < 1.0e29:
                asked = cost[c, s] + even * float(used[s]) * share[c, s]
                taken = int(0)
                if asked < least:
                    for k in range(opens[c], opens[c + 1]):
                        if source[beside[k]] == s:
                            taken = 1
                    if taken == 0:
                        least = asked
                        best = s
                if asked < least_spare:
                    least_spare = asked
                    spare = s
        if best < 0:
            best = spare
        source[c] = best
        used[best] = used[best] + 1
