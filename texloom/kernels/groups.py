"""Groups of faces laid flat together, grown face by face from seeds, each face glued to its group's edge.

Everything is in texels, complex numbers as (real, imaginary). ``flat`` holds the corners of every face laid flat by
itself, ``twin`` the halfedge across. In a group a vertex is one node, named by the corner that brought it in: node
``3 f + c`` lies at ``place[3 f + c]``. A group is a disc: a face joins only along one edge with its opposite vertex
new, or along two edges.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

BINS = wp.constant(256)  # of the queue, from the seed to the reach of a group
_FAN = wp.constant(64)  # faces around a vertex looked at
_FREE = wp.constant(-1)


@wp.func
def times(a: wp.vec2d, b: wp.vec2d):
    return wp.vec2d(a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0])


@wp.func
def conj_times(a: wp.vec2d, b: wp.vec2d):
    """conj(a) b."""
    return wp.vec2d(a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0])


@wp.func
def nearest_branch(turn: wp.vec2d, order: int):
    """Which of the n symmetries a rotation is nearest to."""
    return int(wp.round(wp.atan2(turn[1], turn[0]) * wp.float64(order) / wp.float64(6.283185307179586)))


@wp.func
def off_branch(turn: wp.vec2d, order: int):
    """1 - cos(n a), a the angle of a unit number from the nearest of the n symmetries."""
    power = wp.vec2d(turn[0], turn[1])
    for _ in range(order - 1):
        power = times(power, turn)
    return wp.float64(1.0) - power[0]


@wp.func
def similar_part(
    flat: wp.array(dtype=wp.vec2d),
    f: int,
    p: wp.vec2d,
    q: wp.vec2d,
    r: wp.vec2d,
):
    """The map w = α z + β conj(z) + γ that takes the corners of a flat face to p, q and r: α, and |β|.

    |α| + |β| and |α| - |β| are its greatest and least stretch, arg α is its turn.
    """
    u = flat[3 * f + 1] - flat[3 * f]
    v = flat[3 * f + 2] - flat[3 * f]
    big_u = q - p
    big_v = r - p
    cross = u[0] * v[1] - u[1] * v[0]
    along = conj_times(v, big_u) - conj_times(u, big_v)  # α times u conj(v) - conj(u) v = -2 i cross
    against = times(u, big_v) - times(v, big_u)
    double = wp.float64(2.0) * cross
    if wp.abs(double) < wp.float64(1.0e-30):
        return wp.vec2d(wp.float64(0.0), wp.float64(0.0)), wp.float64(1.0)
    alpha = wp.vec2d(-along[1], along[0]) / double
    return alpha, wp.length(against) / wp.abs(double)


@wp.func
def stretch_of(alpha: wp.vec2d, beta: wp.float64):
    """The greatest stretch or squeeze of a map, at least 1; huge where it flips."""
    size = wp.length(alpha)
    if size - beta <= wp.float64(1.0e-9):
        return wp.float64(1.0e9)
    return wp.max(size + beta, wp.float64(1.0) / (size - beta))


@wp.func
def unfolded(
    flat: wp.array(dtype=wp.vec2d),
    h: int,
    t: int,
    node: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec2d),
):
    """The face of halfedge h glued to halfedge t of its neighbour: where its opposite corner comes, and its turn."""
    f = h / 3
    e = h % 3
    g = t / 3
    head = node[3 * g + (t % 3 + 1) % 3]
    tail = node[t]
    a = flat[h]
    b = flat[3 * f + (e + 1) % 3]
    c = flat[3 * f + (e + 2) % 3]
    turn = wp.normalize(conj_times(b - a, place[tail] - place[head]))
    half = wp.float64(0.5)
    return half * (place[head] + place[tail]) + times(turn, c - half * (a + b)), turn


@wp.func
def offer(
    t: int,
    at_least: int,
    twin: wp.array(dtype=int),
    flat: wp.array(dtype=wp.vec2d),
    order: int,
    reach: wp.float64,
    bent: wp.float64,
    patch: wp.array(dtype=int),
    node: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec2d),
    centre: wp.array(dtype=wp.vec2d),
    first: wp.array(dtype=int),
    after: wp.array(dtype=int),
):
    """Queue the face across halfedge t by its distance from the group's centre, more where the field turned."""
    h = twin[t]
    if h >= 0:
        if patch[h / 3] == _FREE:
            apex, turn = unfolded(flat, h, t, node, place)
            off = off_branch(turn, order)
            g = t / 3
            ends = place[node[t]] + place[node[3 * g + (t % 3 + 1) % 3]]
            away = wp.length((ends + apex) / wp.float64(3.0) - centre[patch[g]])
            if off <= bent and away <= reach:
                key = wp.float64(256.0) * away / reach * (wp.float64(1.0) + off / bent)
                bin = wp.max(at_least, wp.min(int(key), BINS - 1))
                after[t] = first[bin]
                first[bin] = t


@wp.func
def touches(c: int, f: int, own: int, twin: wp.array(dtype=int), patch: wp.array(dtype=int)):
    """Whether a face around corner c of face f is in group ``own``; also where there are too many to look at."""
    h = int(3 * f + c)
    open = int(0)
    for _ in range(_FAN):
        t = twin[h]
        if t < 0:
            open = 1
            break
        if t / 3 == f:
            return False
        if patch[t / 3] == own:
            return True
        h = 3 * (t / 3) + (t % 3 + 1) % 3
    if open == 0:
        return True
    h = 3 * f + (c + 2) % 3
    for _ in range(_FAN):
        t = twin[h]
        if t < 0:
            return False
        if patch[t / 3] == own:
            return True
        h = 3 * (t / 3) + (t % 3 + 2) % 3
    return True


@wp.kernel(enable_backward=False)
def grow_groups(
    start: int,
    seeds: wp.array(dtype=int),  # faces that start a group each, and
    middles: wp.array(dtype=wp.vec2d),  # the groups' centres in the seeds' planes
    number: int,  # of the first of these groups
    oldest: int,  # group that still grows
    twin: wp.array(dtype=int),
    flat: wp.array(dtype=wp.vec2d),
    order: int,
    reach: wp.float64,  # of a face's middle from its group's centre
    bent: wp.float64,  # between a face's field and its group's: 1 - cos(n angle)
    gap: wp.float64,  # between a corner and the node it closes on, to the length of the edge between
    first: wp.array(dtype=int),  # scratch: -1 for each bin
    after: wp.array(dtype=int),  # scratch: of each halfedge
    patch: wp.array(dtype=int),  # group of each face; -1 is free, less is none
    branch: wp.array(dtype=int),  # which symmetry of its field a face takes
    node: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec2d),
    centre: wp.array(dtype=wp.vec2d),  # of each group, in its plane
):
    """All groups grow at once, the nearest face first, over the free faces. One item: faces depend on each other.

    Equal distances (to a bin) take the face offered last.
    """
    for k in range(seeds.shape[0]):
        f = seeds[k]
        patch[f] = number + k
        branch[f] = 0
        centre[number + k] = middles[k]
        for c in range(3):
            node[3 * f + c] = 3 * f + c
            place[3 * f + c] = flat[3 * f + c]
    for t in range(twin.shape[0]):
        if patch[t / 3] >= oldest:
            offer(t, 0, twin, flat, order, reach, bent, patch, node, place, centre, first, after)

    bin = int(0)
    while bin < BINS:
        t = first[bin]
        if t < 0:
            bin += 1
            continue
        first[bin] = after[t]
        h = twin[t]
        f = h / 3
        if patch[f] != _FREE:
            continue
        own = patch[t / 3]
        c = (h % 3 + 2) % 3

        # The opposite corner: a node already if another edge of the face is the group's too
        right = twin[3 * f + (h % 3 + 1) % 3]  # across the edge that leads to c
        left = twin[3 * f + c]  # and the one that leads away
        by_right = int(0)
        by_left = int(0)
        if right >= 0:
            if patch[right / 3] == own:
                by_right = 1
        if left >= 0:
            if patch[left / 3] == own:
                by_left = 1
        if by_right + by_left == 2:
            continue  # the last hole of a closed surface
        apex, turn = unfolded(flat, h, t, node, place)
        apex_node = int(3 * f + c)
        if by_right + by_left == 1:
            side = flat[3 * f + c]
            if by_right == 1:
                apex_node = node[right]
                side = side - flat[3 * f + (h % 3 + 1) % 3]
            else:
                apex_node = node[3 * (left / 3) + (left % 3 + 1) % 3]
                side = side - flat[h]
            if wp.length(place[apex_node] - apex) > gap * wp.length(side):
                continue
        elif touches(c, f, own, twin, patch):
            continue
        else:
            place[apex_node] = apex

        patch[f] = own
        branch[f] = nearest_branch(turn, order)
        node[h] = node[3 * (t / 3) + (t % 3 + 1) % 3]
        node[3 * f + (h % 3 + 1) % 3] = node[t]
        node[3 * f + c] = apex_node
        for i in range(3):
            offer(3 * f + i, bin, twin, flat, order, reach, bent, patch, node, place, centre, first, after)


@wp.kernel(enable_backward=False)
def recentre(
    start: int,
    flat: wp.array(dtype=wp.vec2d),
    patch: wp.array(dtype=int),
    node: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec2d),
    area: wp.array(dtype=wp.float64),  # 0 for each group, and their other sums
    centre: wp.array(dtype=wp.vec2d),
    least: wp.array(dtype=wp.float64),  # huge for each group
    seeds: wp.array(dtype=int),
    middles: wp.array(dtype=wp.vec2d),
):
    """The face nearest to the middle of each group's area, and that middle in the face's own plane. One item."""
    third = wp.float64(1.0) / wp.float64(3.0)
    faces = patch.shape[0]
    for f in range(faces):
        own = patch[f]
        if own >= 0:
            u = flat[3 * f + 1] - flat[3 * f]
            v = flat[3 * f + 2] - flat[3 * f]
            share = wp.abs(u[0] * v[1] - u[1] * v[0])
            middle = third * (place[node[3 * f]] + place[node[3 * f + 1]] + place[node[3 * f + 2]])
            area[own] = area[own] + share
            centre[own] = centre[own] + share * middle
    for k in range(area.shape[0]):
        centre[k] = centre[k] / wp.max(area[k], wp.float64(1.0e-300))
    for f in range(faces):
        own = patch[f]
        if own >= 0:
            p = place[node[3 * f]]
            q = place[node[3 * f + 1]]
            r = place[node[3 * f + 2]]
            away = centre[own] - third * (p + q + r)
            if wp.length_sq(away) < least[own]:
                least[own] = wp.length_sq(away)
                seeds[own] = f
                alpha, beta = similar_part(flat, f, p, q, r)
                own_middle = third * (flat[3 * f] + flat[3 * f + 1] + flat[3 * f + 2])
                middles[own] = own_middle + conj_times(wp.normalize(alpha), away)
