"""Which sites lie around a sample: triangles unfolded around its face once, then one look for every sample in it."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.trace import conjugate, corner, texel_at, times, turn_across

MOST = wp.constant(96)  # faces unfolded around one face, and sites seen there
Indices = wp.types.vector(length=96, dtype=wp.int32)
Points = wp.types.vector(length=192, dtype=wp.float32)

FAR = wp.constant(1.0)  # texels from a sample to the farthest site it can place
SIDE = wp.constant(0.65)  # half a cell, and enough to close the gaps where samples spread
BORDER = wp.constant(0.5)  # half a cell, at the border of the patch


@wp.func
def distance_to(p: wp.vec2, q: wp.vec2) -> float:
    """From the origin to the segment p q."""
    along = q - p
    t = wp.clamp(-wp.dot(p, along) / wp.max(wp.length_sq(along), 1.0e-30), 0.0, 1.0)
    return wp.length(p + t * along)


@wp.kernel(enable_backward=False)
def unfold_around(
    start: int,
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    faces: wp.array2d(dtype=int),
    axis: wp.array2d(dtype=wp.vec2),  # the site's frame at every face corner, in the face's frame
    wanted: wp.array(dtype=wp.uint8),
    order: int,
    first: wp.array(dtype=int),  # where each face's sites go; empty to count only
    count: wp.array(dtype=int),
    site: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec2),
    frame: wp.array(dtype=wp.vec2),
):
    """Sites that a sample in face i can place, with their places and frames in the frame of i.

    Breadth first over edges within reach of the face. Frames are left out where the field has one direction only.
    """
    i = start + wp.tid()
    count[i] = 0
    if wanted[i] == wp.uint8(0):
        return
    middle = (corner(record, i, 1) + corner(record, i, 2)) / 3.0
    far = wp.max(wp.length(middle), wp.length(corner(record, i, 1) - middle))
    far = wp.max(far, wp.length(corner(record, i, 2) - middle))
    far = far + FAR * wp.max(wp.max(record[i, 9], record[i, 10]), record[i, 11])

    queue = Indices()  # halfedges come in by, the rotation of each face's frame, its corner 0 against the middle
    turns = Points()
    origins = Points()
    seen = Indices()  # sites
    queue[0] = 3 * i
    turns[0] = 1.0
    turns[1] = 0.0
    origins[0] = -middle[0]
    origins[1] = -middle[1]
    queued = int(1)
    seen_count = int(0)
    found = int(0)
    head = int(0)
    while head < queued:
        f = queue[head] // 3
        entry = queue[head] % 3
        turn = wp.vec2(turns[2 * head], turns[2 * head + 1])
        origin = wp.vec2(origins[2 * head], origins[2 * head + 1])
        for d in range(3):
            # Edges in turn; beyond the first face the corner opposite the entry is the only one not seen from before
            c = (entry + d) % 3
            p = origin + times(turn, corner(record, f, c))
            if (head == 0 or d == 2) and wp.length_sq(p) <= far * far:
                v = faces[f, c]
                k = int(0)
                while k < seen_count:
                    if seen[k] == v:
                        k = MOST
                    k = k + 1
                if k < MOST:
                    seen[seen_count] = v
                    seen_count = seen_count + 1
                    if first.shape[0] > 0:
                        e = first[i] + found
                        site[e] = v
                        place[e] = p + middle
                        if order > 1:
                            frame[e] = times(turn, axis[f, c])
                    found = found + 1

            halfedge = twin[f, c]
            if halfedge >= 0 and queued < MOST and (head == 0 or d > 0):
                q = origin + times(turn, corner(record, f, (c + 1) % 3))
                if distance_to(p, q) <= far:
                    g = halfedge // 3
                    k = int(0)
                    while k < queued:
                        if queue[k] // 3 == g:
                            k = MOST
                        k = k + 1
                    if k < MOST:
                        onward = times(turn, conjugate(turn_across(record, f, c)))
                        base = q - times(onward, corner(record, g, halfedge % 3))
                        queue[queued] = halfedge
                        turns[2 * queued] = onward[0]
                        turns[2 * queued + 1] = onward[1]
                        origins[2 * queued] = base[0]
                        origins[2 * queued + 1] = base[1]
                        queued = queued + 1
        head = head + 1
    count[i] = found


@wp.func
def side_of(face: wp.array(dtype=int), neighbour: int, inside: bool) -> float:
    """How far a sample's cell goes towards a neighbour: all the way where that could not be traced."""
    if not inside:
        return BORDER
    if face[neighbour] < 0:
        return FAR
    return SIDE


@wp.kernel(enable_backward=False)
def sites_in_cells(
    start: int,
    record: wp.array2d(dtype=float),
    order: int,
    width: int,
    around_first: wp.array(dtype=int),
    around_count: wp.array(dtype=int),
    around_site: wp.array(dtype=int),
    around_place: wp.array(dtype=wp.vec2),
    around_frame: wp.array(dtype=wp.vec2),
    face: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec3),
    heading: wp.array(dtype=wp.vec2),
    first: wp.array(dtype=int),  # where each sample's sites go; empty to count only
    count: wp.array(dtype=int),
    site: wp.array(dtype=int),
    offset: wp.array(dtype=wp.vec2),
    steps: wp.array(dtype=int),
):
    """Sites of every sample's cell: offsets [row, column] in texels, and n-ths of a turn from their own frames."""
    s = start + wp.tid()
    count[s] = 0
    f = face[s]
    if f < 0:
        return
    row = (s // width) % width
    column = s % width
    up = side_of(face, s - width, row > 0)
    down = side_of(face, s + width, row + 1 < width)
    left = side_of(face, s - 1, column > 0)
    right = side_of(face, s + 1, column + 1 < width)

    at = place[s]
    here = at[1] * corner(record, f, 1) + at[2] * corner(record, f, 2)
    way = wp.vec2(heading[s][0], heading[s][1])
    to_texels = conjugate(way) / texel_at(record, f, wp.vec3(at[0], at[1], at[2]))
    found = int(0)
    for k in range(around_first[f], around_first[f] + around_count[f]):
        p = times(to_texels, around_place[k] - here)
        if p[0] >= -left and p[0] <= right and -p[1] >= -up and -p[1] <= down and wp.length_sq(p) <= FAR * FAR:
            if first.shape[0] > 0:
                e = first[s] + found
                site[e] = around_site[k]
                offset[e] = wp.vec2(-p[1], p[0])
                if order > 1:
                    own = around_frame[k]
                    turn = times(way, conjugate(wp.vec2(own[0], own[1])))
                    n = wp.round(wp.atan2(turn[1], turn[0]) * float(order) / 6.2831853)
                    steps[e] = (int(n) + order) % order
            found = found + 1
    count[s] = found


@wp.kernel(enable_backward=False)
def nearest_of_patch(
    start: int,
    samples: int,  # of a patch
    first: wp.array(dtype=int),  # of each site, in ``order``
    order: wp.array(dtype=int),
    sample: wp.array(dtype=int),
    offset: wp.array(dtype=wp.vec2),
    keep: wp.array(dtype=wp.uint8),
):
    """Of a site's entries from one patch keep the one whose sample is nearest; ties keep the first."""
    i = start + wp.tid()
    best = int(-1)
    patch = int(-1)
    least = float(0.0)
    for k in range(first[i], first[i + 1]):
        e = order[k]
        distance = wp.length_sq(offset[e])
        p = sample[e] // samples
        if p != patch or distance < least:
            if p == patch:
                keep[best] = wp.uint8(0)
            keep[k] = wp.uint8(1)
            best = k
            patch = p
            least = distance
