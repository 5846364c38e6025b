"""Where the sites lie in traced patches: triangles laid flat around the samples, spreading from sample to sample."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.trace import CPU_FLAGS, conjugate, corner, texel_at, times, turn_across

wp.set_module_options({"cpu_compiler_flags": CPU_FLAGS})

FAR = wp.constant(1.0)  # texels from a sample to the farthest site it can place
BORDER = wp.constant(0.5)  # half a cell, at the border of the patch
FULL = wp.constant(-1)  # count of a patch whose tables were too small


@wp.func
def slot_of(table: wp.array2d(dtype=int), keys: wp.array2d(dtype=int), i: int, key: int) -> int:
    """Where a key stands in hash table i, or would: a row of numbers into ``keys[i]``, -1 where free."""
    mask = table.shape[1] - 1
    slot = int((wp.uint32(key) * wp.uint32(1640531527)) >> wp.uint32(15)) & mask
    for _ in range(table.shape[1]):
        k = int(table[i, slot])
        if k < 0:
            return slot
        if keys[i, k] == key:
            return slot
        slot = (slot + 1) & mask
    return slot


@wp.func
def distance_to(p: wp.vec2, q: wp.vec2) -> float:
    """From the origin to the segment p q, squared."""
    along = q - p
    t = wp.clamp(-wp.dot(p, along) / wp.max(wp.length_sq(along), 1.0e-30), 0.0, 1.0)
    return wp.length_sq(p + t * along)


@wp.func
def room_around(s: int, width: int) -> wp.vec4:
    """How far the cell of a sample may go: left, right, down, up; its neighbours' cells will cut it."""
    row = (s // width) % width
    column = s % width
    return wp.vec4(
        wp.where(column == 0, BORDER, FAR),
        wp.where(column == width - 1, BORDER, FAR),
        wp.where(row == width - 1, BORDER, FAR),
        wp.where(row == 0, BORDER, FAR),
    )


@wp.func
def place_site(
    site_table: wp.array2d(dtype=int),
    site: wp.array2d(dtype=int),
    sample: wp.array2d(dtype=int),
    offset: wp.array2d(dtype=wp.vec2),
    frame: wp.array2d(dtype=wp.vec2),
    i: int,
    count: int,
    v: int,
    s: int,
    p: wp.vec2,
    room: wp.vec4,
    own: wp.vec2,
) -> int:
    """Note that site v lies at p from sample s, if s is the nearest one yet; returns the number of sites known."""
    distance = wp.length_sq(p)
    if distance > FAR * FAR or p[0] < -room[0] or p[0] > room[1] or p[1] < -room[2] or p[1] > room[3]:
        return count
    slot = slot_of(site_table, site, i, v)
    k = int(site_table[i, slot])
    known = int(count)
    if k < 0:
        k = count
        known = count + 1
        site_table[i, slot] = k
        site[i, k] = v
    else:
        best = wp.length_sq(offset[i, k])
        if distance > best or (distance == best and s >= sample[i, k]):
            return count
    sample[i, k] = s
    offset[i, k] = p
    frame[i, k] = own
    return known


@wp.kernel(enable_backward=False)
def cover_squares(
    start: int,
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    faces: wp.array2d(dtype=int),
    axis: wp.array2d(dtype=wp.vec2),  # the site's frame at every face corner, in the face's frame
    order: int,
    width: int,
    face: wp.array(dtype=int),  # samples
    place: wp.array(dtype=wp.vec3),
    heading: wp.array(dtype=wp.vec2),
    face_table: wp.array2d(dtype=int),
    site_table: wp.array2d(dtype=int),
    queue: wp.array2d(dtype=int),  # faces laid flat
    owner: wp.array2d(dtype=int),  # the sample each is laid around,
    nearness: wp.array2d(dtype=float),  # squared, of the middle of a face that holds a sample,
    turn: wp.array2d(dtype=wp.vec2),  # from the face's frame to that of the patch, in texels,
    origin: wp.array2d(dtype=wp.vec2),  # and where the face's corner 0 falls
    count: wp.array(dtype=int),
    site: wp.array2d(dtype=int),
    sample: wp.array2d(dtype=int),
    offset: wp.array2d(dtype=wp.vec2),  # (right, up) in texels
    frame: wp.array2d(dtype=wp.vec2),  # of the site, in that of the patch
):
    """Sites of square i: the nearest sample of each, and the offset from it; ``count`` is ``FULL`` if the tables are.

    A face is laid flat around the sample in it that is nearest to its middle, a face without one around the sample of
    the neighbour that reaches it first, breadth first. A sample places the corners of its own face and of those laid
    around it; a tie keeps the lowest sample.
    """
    i = start + wp.tid()
    for k in range(face_table.shape[1]):
        face_table[i, k] = -1
    for k in range(site_table.shape[1]):
        site_table[i, k] = -1
    most_faces = queue.shape[1] - 3
    most_sites = site.shape[1] - 3
    queued = int(0)
    known = int(0)

    samples = width * width
    for s in range(samples):
        f = face[i * samples + s]
        if f >= 0 and known <= most_sites and queued <= most_faces:
            at = place[i * samples + s]
            way = heading[i * samples + s]
            at = wp.vec3(at[0], at[1], at[2])
            to_patch = conjugate(wp.vec2(way[0], way[1])) / texel_at(record, f, at)
            base = times(to_patch, -(at[1] * corner(record, f, 1) + at[2] * corner(record, f, 2)))
            room = room_around(s, width)
            middle = base
            for c in range(3):
                p = base + times(to_patch, corner(record, f, c))
                middle = middle + (p - base) / 3.0
                own = times(to_patch, axis[f, c])
                known = place_site(site_table, site, sample, offset, frame, i, known, faces[f, c], s, p, room, own)
            slot = slot_of(face_table, queue, i, f)
            k = int(face_table[i, slot])
            near = wp.length_sq(middle)
            if k < 0 or near < nearness[i, wp.max(k, 0)]:
                if k < 0:
                    k = queued
                    queued = queued + 1
                    face_table[i, slot] = k
                    queue[i, k] = f
                owner[i, k] = s
                nearness[i, k] = near
                turn[i, k] = to_patch
                origin[i, k] = base

    head = int(0)
    while head < queued and known <= most_sites and queued <= most_faces:
        s = int(owner[i, head])
        f = int(queue[i, head])
        to_patch = turn[i, head]
        to_patch = wp.vec2(to_patch[0], to_patch[1])
        base = origin[i, head]
        base = wp.vec2(base[0], base[1])
        room = room_around(s, width)
        for e in range(3):
            halfedge = twin[f, e]
            if halfedge >= 0:
                g = halfedge // 3
                slot = slot_of(face_table, queue, i, g)
                if face_table[i, slot] < 0:
                    p = base + times(to_patch, corner(record, f, e))
                    q = base + times(to_patch, corner(record, f, (e + 1) % 3))
                    out = wp.max(p[0], q[0]) < -room[0] or wp.min(p[0], q[0]) > room[1]
                    out = out or wp.max(p[1], q[1]) < -room[2] or wp.min(p[1], q[1]) > room[3]
                    if not out and distance_to(p, q) <= FAR * FAR:
                        onward = times(to_patch, conjugate(turn_across(record, f, e)))
                        t = halfedge - 3 * g
                        beyond = q - times(onward, corner(record, g, t))
                        face_table[i, slot] = queued
                        queue[i, queued] = g
                        owner[i, queued] = s
                        turn[i, queued] = onward
                        origin[i, queued] = beyond
                        queued = queued + 1
                        c = wp.where(t == 0, 2, t - 1)
                        r = beyond + times(onward, corner(record, g, c))
                        own = times(onward, axis[g, c])
                        known = place_site(
                            site_table, site, sample, offset, frame, i, known, faces[g, c], s, r, room, own
                        )
        head = head + 1
    count[i] = wp.where(known > most_sites or queued > most_faces, FULL, known)


@wp.kernel(enable_backward=False)
def collect_entries(
    start: int,
    order: int,
    width: int,
    first: wp.array(dtype=int),  # place of each square's entries, one more at the end
    sites: wp.array2d(dtype=int),
    sample: wp.array2d(dtype=int),
    offset: wp.array2d(dtype=wp.vec2),
    frame: wp.array2d(dtype=wp.vec2),
    site: wp.array(dtype=int),
    position: wp.array(dtype=wp.vec2),
    steps: wp.array(dtype=wp.int8),
):
    """The entries of all squares one after the other: [row, column] in the patch, n-ths of a turn from the site."""
    i = start + wp.tid()
    for k in range(first[i + 1] - first[i]):
        e = first[i] + k
        s = sample[i, k]
        site[e] = sites[i, k]
        position[e] = wp.vec2(float(s // width) - offset[i, k][1], float(s % width) + offset[i, k][0])
        if order > 1:
            n = -wp.round(wp.atan2(frame[i, k][1], frame[i, k][0]) * float(order) / 6.2831853)
            steps[e] = wp.int8((int(n) + order) % order)


@wp.kernel(enable_backward=False)
def group_cover(
    start: int,
    first: wp.array(dtype=int),  # of each patch's entries
    site: wp.array(dtype=int),
    position: wp.array(dtype=wp.vec2),
    steps: wp.array(dtype=wp.int8),
    turn_of: wp.array(dtype=float),
    free: wp.array(dtype=int),  # the next place of each site; used up
    cover_patch: wp.array(dtype=int),
    cover_position: wp.array(dtype=wp.vec2),
    cover_turn: wp.array(dtype=float),
):
    """The last pass of a counting sort, one thread: entries by site, patches increasing within a site."""
    for p in range(first.shape[0] - 1):
        for e in range(first[p], first[p + 1]):
            s = site[e]
            at = int(free[s])
            free[s] = at + 1
            cover_patch[at] = p
            cover_position[at] = position[e]
            if cover_turn.shape[0] > 0:
                cover_turn[at] = turn_of[int(steps[e])]
