"""Triangle quilting: the place in the sample where a patch fits its neighbours (Magda & Kriegman 2003, section 3.2.2).

Places and offsets are (column, row), as in ``strings``; flat positions are row · columns + column.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.strings import (
    corner_place,
    fit,
    fit_between,
    following,
    hidden_texels,
    nudged,
    read_string,
    symmetry,
    times,
)

COUNT_BITS = 12
"""Lower bits of a vote: its count, and whether its place is listed. Above is the search it belongs to."""

_COUNT_BITS = wp.constant(COUNT_BITS)
_COUNT = wp.constant((1 << (COUNT_BITS - 1)) - 1)
_LISTED = wp.constant(1 << (COUNT_BITS - 1))
_NOWHERE = wp.constant(3.0e38)


@wp.func
def vote(
    search: int, most: int, thin: int, length: int, low: wp.vec2, high: wp.vec2, least: wp.vec2, greatest: wp.vec2,
    rows: int, columns: int, bucket_start: wp.array(dtype=int), bucket: wp.array(dtype=int),
    hidden: wp.array2d(dtype=int), texton: wp.array(dtype=int), offset: wp.array(dtype=wp.vec2i), string: int,
    own: int, lane: int, votes: wp.array(dtype=int), listed: wp.array(dtype=int), reached: wp.array2d(dtype=int),
):  # fmt: skip
    """Bucket voting: N[x] counts the points of the string (every ``thin``-th) whose texton is at x + offset.

    Places that may be among the ``most`` voted are listed as they get there. Returns how many are listed, and the
    votes that the last of the most voted has; of those with as many, some are beyond ``most``.
    """
    r_low = int(wp.ceil(low[1]))
    c_low = int(wp.ceil(low[0]))
    r_high = int(wp.floor(high[1]))
    c_high = int(wp.floor(high[0]))
    tag = search << _COUNT_BITS
    bar = int(1)
    found = int(0)
    for v in range(length / thin + 3):
        reached[lane, v] = 0
    for k in range(0, length, thin):
        t = texton[string + k]
        shift = offset[string + k]
        c_shift = shift[0]
        r_shift = shift[1]
        for n in range(bucket_start[t], bucket_start[t + 1]):
            at = bucket[n]
            r = (at >> 16) - r_shift
            c = (at & 0xFFFF) - c_shift
            if r >= r_low and r <= r_high and c >= c_low and c <= c_high:
                x = own + r * columns + c
                ballot = wp.max(votes[x], tag) + 1
                count = ballot & _COUNT
                if count >= bar:
                    usable = int(1)
                    if (ballot & _LISTED) == 0 and hidden.shape[0] > 1:
                        here = wp.vec2(float(c), float(r))
                        if hidden_texels(here + least, here + greatest, hidden) > 0:
                            usable = 0
                            ballot = tag  # its votes begin anew: it is never listed
                    if usable == 1:
                        if (ballot & _LISTED) == 0:
                            ballot = ballot | _LISTED
                            listed[own + found] = x - own
                            found += 1
                        reached[lane, count] = reached[lane, count] + 1
                        if reached[lane, bar + 1] >= most:
                            bar += 1
                votes[x] = ballot
    return found, bar


@wp.func
def anywhere(
    draw: wp.uint32, low: wp.vec2, high: wp.vec2, least: wp.vec2, greatest: wp.vec2, hidden: wp.array2d(dtype=int)
):
    """A random whole place; with masked texels the first from there on that has none, row by row; -1 without any."""
    r_low = int(wp.ceil(low[1]))
    c_low = int(wp.ceil(low[0]))
    across = int(wp.floor(high[0])) - c_low + 1
    down = int(wp.floor(high[1])) - r_low + 1
    first = int(draw % wp.uint32(across * down))
    tried = int(0)
    found = int(-1)
    while tried < across * down:
        at = (first + tried) % (across * down)
        here = wp.vec2(float(c_low + at % across), float(r_low + at / across))
        tried += 1
        if hidden.shape[0] <= 1 or hidden_texels(here + least, here + greatest, hidden) == 0:
            found = at
            tried = across * down
    if found < 0:
        return wp.vec2(-1.0, -1.0)
    return wp.vec2(float(c_low + found % across), float(r_low + found / across))


@wp.func
def continued(
    p: int, q: int, first: int, turn: wp.vec2, order: int, rim_start: wp.array(dtype=int), rim: wp.array(dtype=int),
    twin: wp.array(dtype=int), patch: wp.array(dtype=int), layout: wp.array2d(dtype=wp.vec2),
    place: wp.array(dtype=wp.vec2), branch: wp.array(dtype=int),
):  # fmt: skip
    """Where patch ``p`` continues its neighbour ``q``, in the mean over their border.

    Second is 1 if halfedge ``first`` of the rim is the first of that border, so that each neighbour is asked once.
    """
    total = wp.vec2(0.0, 0.0)
    whole = float(0.0)
    for j in range(rim_start[p], rim_start[p + 1]):
        h = rim[j]
        t = twin[h]
        if patch[t / 3] == q:
            if j < first:
                return total, 0
            a0 = layout[h / 3, h % 3]
            a1 = layout[h / 3, (h % 3 + 1) % 3]
            b0 = corner_place(following(t), layout, patch, place, branch, order)
            b1 = corner_place(t, layout, patch, place, branch, order)
            length = wp.length(a1 - a0)
            total += 0.5 * length * (b0 + b1 - times(turn, a0 + a1))
            whole += length
    return total / wp.max(whole, 1.0e-20), 1


@wp.kernel(enable_backward=False)
def choose_places(
    start: int, first: int, last: int, lanes: int, searched: int, keep: int, todo: wp.array(dtype=int),
    rim_start: wp.array(dtype=int), rim: wp.array(dtype=int), twin: wp.array(dtype=int), patch: wp.array(dtype=int),
    layout: wp.array2d(dtype=wp.vec2), least: wp.array2d(dtype=wp.vec2), greatest: wp.array2d(dtype=wp.vec2),
    image: wp.array(dtype=float), channels: int, labels: wp.array3d(dtype=wp.int16), upright: wp.array(dtype=wp.int16),
    bucket_start: wp.array(dtype=int), bucket: wp.array(dtype=int), distance: wp.array2d(dtype=float),
    hidden: wp.array2d(dtype=int), thin: int, most: int, by_colour: int, spacing: wp.array(dtype=float),
    chance: wp.array(dtype=wp.uint32), longest: int,
    votes: wp.array(dtype=int), listed: wp.array(dtype=int), reached: wp.array2d(dtype=int),
    texton: wp.array(dtype=int), offset: wp.array(dtype=wp.vec2i), wanted: wp.array(dtype=float),
    place: wp.array(dtype=wp.vec2), branch: wp.array(dtype=int), error: wp.array(dtype=float),
):  # fmt: skip
    """Place patches ``todo[first:last]``, none of which touches another, where they fit what is placed around them.

    The ``most`` places with most votes are compared by eq. 2. With ``keep`` the present place, and with ``by_colour``
    the continuations of the neighbours' own maps compete too, and the best moves between texels. Turns by which a patch
    is larger than the sample are passed over. An item is a lane with working arrays of its own (``longest`` entries of
    string); votes carry the number of their search, ``searched`` and on, so nothing has to be cleared. ``error`` is the
    mean over the string's points.
    """
    lane = start + wp.tid()
    rows = labels.shape[1]
    columns = labels.shape[2]
    order = least.shape[1]
    own = lane * rows * columns
    string = lane * longest
    search = int(searched)
    i = int(first + lane)
    while i < last:
        p = todo[i]
        least_error = float(_NOWHERE)
        chosen = wp.vec2(0.0, 0.0)
        chosen_branch = int(-1)
        for b in range(order):
            low = -least[p, b]
            high = wp.vec2(float(columns - 1), float(rows - 1)) - greatest[p, b]
            if wp.ceil(low[0]) > wp.floor(high[0]) or wp.ceil(low[1]) > wp.floor(high[1]):
                continue
            turn = symmetry(b, order)
            length = read_string(
                p, turn, order, by_colour, spacing[p], rim_start, rim, twin, patch, layout, place, branch,
                image, channels, labels, string, texton, offset, wanted,
            )  # fmt: skip
            search += 1
            found, bar = vote(
                search, most, thin, length, low, high, least[p, b], greatest[p, b], rows, columns, bucket_start,
                bucket, hidden, texton, offset, string, own, lane, votes, listed, reached,
            )  # fmt: skip
            tag = search << _COUNT_BITS
            above = int(0)  # the most voted come first on the list: they leave little to beat
            for n in range(found):
                x = listed[own + n]
                if votes[own + x] - tag > (bar | _LISTED):
                    listed[own + n] = listed[own + above]
                    listed[own + above] = x
                    above += 1
            best = float(_NOWHERE)
            spot = wp.vec2(-1.0, -1.0)
            equals = most - reached[lane, bar + 1]  # with just enough votes, from a random one on
            n = int(0)
            while n < found and (n < above or equals > 0):
                at = int(n)
                if n >= above:
                    at = above + (int(chance[p] >> wp.uint32(8)) + n) % (found - above)
                x = listed[own + at]
                n += 1
                if votes[own + x] - tag >= (bar | _LISTED):
                    if at >= above:
                        equals -= 1
                    e = fit(
                        x, string, length, best, by_colour, columns, image, channels, upright, distance, texton, offset,
                        wanted,
                    )  # fmt: skip
                    if e < best:
                        best = e
                        spot = wp.vec2(float(x % columns), float(x / columns))
            if spot[0] < 0.0:
                spot = anywhere(chance[p], low, high, least[p, b], greatest[p, b], hidden)
                if spot[0] < 0.0:
                    continue
                best = 0.0
            if length > 0:
                best = fit_between(
                    spot, string, length, _NOWHERE, by_colour, rows, columns, image, channels, upright, distance,
                    texton, offset, wanted,
                )  # fmt: skip
                first_rim = rim_start[p]
                end = first_rim
                if by_colour != 0:
                    end = rim_start[p + 1] + 2
                for candidate in range(first_rim - 1, end):
                    there = wp.vec2(-1.0, -1.0)
                    valid = int(0)
                    if candidate < first_rim:
                        if keep != 0 and branch[p] == b:
                            there = place[p]
                            valid = 1
                    elif candidate >= rim_start[p + 1]:
                        there = nudged(spot, string, length, rows, columns, image, channels, offset, wanted)
                        there = wp.max(wp.min(there, high), low)
                        valid = 1
                    else:
                        q = patch[twin[rim[candidate]] / 3]
                        if branch[q] >= 0:
                            there, valid = continued(
                                p, q, candidate, turn, order, rim_start, rim, twin, patch, layout, place, branch
                            )
                            if there[0] < low[0] or there[0] > high[0] or there[1] < low[1] or there[1] > high[1]:
                                valid = 0
                    if valid == 1 and hidden.shape[0] > 1:
                        if hidden_texels(there + least[p, b], there + greatest[p, b], hidden) > 0:
                            valid = 0
                    if valid == 1:
                        e = fit_between(
                            there, string, length, best, by_colour, rows, columns, image, channels, upright, distance,
                            texton, offset, wanted,
                        )  # fmt: skip
                        if e < best or (e == best and candidate < first_rim):
                            best = e
                            spot = there
            best = best / float(wp.max(length, 1))
            if best < least_error or chosen_branch < 0:
                least_error = best
                chosen = spot
                chosen_branch = b
        place[p] = chosen
        branch[p] = chosen_branch
        error[p] = least_error
        i += lanes
