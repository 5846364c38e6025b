"""Maps of a texture mesh: its nearest edges, and where those draw a texel."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

TILE = wp.constant(32)  # texels a side of what is looked at together
PART = wp.constant(8)  # of a tile
BIT = wp.constant(4)  # of a part
LEVELS = wp.constant(3)


@wp.func
def to_chord(p: wp.vec2, a: wp.vec2, b: wp.vec2) -> wp.vec2:
    """From p to the nearest point of the chord between a and b; at an end the same for all chords that end there."""
    along = b - a
    t = wp.dot(p - a, along)
    length = wp.dot(along, along)
    gap = a + wp.clamp(t / wp.max(length, 1.0e-20), 0.0, 1.0) * along - p
    if t <= 0.0:
        gap = a - p
    elif t >= length:
        gap = b - p
    return gap


@wp.func
def behind(p: wp.vec2, a: wp.vec2, b: wp.vec2) -> float:
    """How far along its line p lies beyond the end of a chord; 0 beside it."""
    along = b - a
    return wp.abs(wp.dot(to_chord(p, a, b), along)) / wp.max(wp.length(along), 1.0e-20)


@wp.func
def end_of(first: wp.vec2i, side: int, last: wp.vec2i) -> wp.vec2i:
    """One past the last texel of a square that is cut off at ``last``."""
    return wp.vec2i(wp.min(first[0] + side, last[0]), wp.min(first[1] + side, last[1]))


@wp.func
def from_middle(disc: wp.vec3, p: wp.vec2) -> float:
    """The squared distance of a place from the middle of a disc."""
    return (disc[0] - p[0]) * (disc[0] - p[0]) + (disc[1] - p[1]) * (disc[1] - p[1])


@wp.func
def look(
    first: wp.vec2i,
    last: wp.vec2i,
    disc: wp.array(dtype=wp.vec3),
    lists: wp.array(dtype=int),
    listed: int,
    count: int,
    to: int,
) -> int:
    """List, from ``to`` on, the chords that may be nearest to a texel of a square, of those listed for a larger one.

    A chord that may is no further from the square's middle than the nearest one and the diagonal. Returns how many.
    """
    middle = 0.5 * wp.vec2(float(first[0] + last[0] - 1), float(first[1] + last[1] - 1))
    diagonal = wp.vec2(float(last[0] - 1 - first[0]), float(last[1] - 1 - first[1]))
    squared = float(1.0e20)
    for m in range(count):
        squared = wp.min(squared, from_middle(disc[lists[listed + m]], middle))
    reach = wp.sqrt(squared) + wp.length(diagonal) + 1.0e-3
    found = int(0)
    for m in range(count):
        k = lists[listed + m]
        chord = disc[k]
        room = reach + chord[2]
        if from_middle(chord, middle) <= room * room:
            lists[to + found] = k
            found = found + 1
    return found


@wp.kernel(enable_backward=False)
def nearest_edges(
    start: int,
    first: wp.vec2i,  # of the window, and one past its last
    last: wp.vec2i,
    across: int,  # tiles in a row of the window
    a: wp.array(dtype=wp.vec2),  # the ends of every chord
    b: wp.array(dtype=wp.vec2),
    disc: wp.array(dtype=wp.vec3),  # around it: middle and radius
    edge: wp.array(dtype=int),
    lists: wp.array(dtype=int),  # all chords, then those that may be nearest: for each tile room for three lists
    nearest: wp.array2d(dtype=wp.vec2),
    away: wp.array2d(dtype=float),
    halfedge: wp.array2d(dtype=int),
):
    """nearest[p] = the shortest q - p to any chord; away its length; halfedge the one there that has p at its left.

    Where several chords end at q the one counts that p lies least behind. An item is a tile.
    """
    i = start + wp.tid()
    tile = wp.vec2i(first[0] + TILE * (i // across), first[1] + TILE * (i % across))
    end = end_of(tile, TILE, last)
    chords = a.shape[0]
    room_of_tile = (1 + LEVELS * i) * chords
    near = look(tile, end, disc, lists, 0, chords, room_of_tile)
    for n in range((TILE // PART) * (TILE // PART)):
        part = wp.vec2i(tile[0] + PART * (n // (TILE // PART)), tile[1] + PART * (n % (TILE // PART)))
        if part[0] < last[0] and part[1] < last[1]:
            end = end_of(part, PART, last)
            nearer = look(part, end, disc, lists, room_of_tile, near, room_of_tile + chords)
            for m in range((PART // BIT) * (PART // BIT)):
                bit = wp.vec2i(part[0] + BIT * (m // (PART // BIT)), part[1] + BIT * (m % (PART // BIT)))
                if bit[0] < last[0] and bit[1] < last[1]:
                    end = end_of(bit, BIT, last)
                    few = look(bit, end, disc, lists, room_of_tile + chords, nearer, room_of_tile + 2 * chords)
                    best = int(-1)
                    for r in range(bit[0], end[0]):
                        for c in range(bit[1], end[1]):
                            p = wp.vec2(float(r), float(c))
                            least = float(1.0e20)
                            if best >= 0:  # the texel before has its nearest edge near that of this one
                                least = wp.length_sq(to_chord(p, a[best], b[best]))
                            bound = wp.sqrt(least)
                            for j in range(few):
                                k = lists[room_of_tile + 2 * chords + j]
                                chord = disc[k]
                                room = bound + chord[2]
                                if from_middle(chord, p) <= room * room:
                                    squared = wp.length_sq(to_chord(p, a[k], b[k]))
                                    if squared < least:
                                        least = squared
                                        bound = wp.sqrt(squared)
                                        best = k
                                    elif squared == least:
                                        if behind(p, a[k], b[k]) < behind(p, a[best], b[best]):
                                            best = k
                            nearest[r, c] = wp.vec2(1.0e10, 0.0)
                            halfedge[r, c] = -1
                            if best >= 0:
                                nearest[r, c] = to_chord(p, a[best], b[best])
                                along = b[best] - a[best]
                                off = p - a[best]
                                halfedge[r, c] = 2 * edge[best]
                                if along[1] * off[0] - along[0] * off[1] > 0.0:
                                    halfedge[r, c] = 2 * edge[best] + 1
                            away[r, c] = wp.length(nearest[r, c])


@wp.kernel(enable_backward=False)
def toward_edges(
    start: int,
    columns: int,  # of the window
    side: int,  # of a neighbourhood
    weight: wp.array(dtype=float),  # 1 / |p pi| over it, 0 at its middle
    closeness: wp.array(dtype=float),  # of the window and half a neighbourhood around it
    toward: wp.array2d(dtype=wp.vec2),  # of the window
):
    """V(p) = Σ w(pi) p pi / Σ w(pi), w(pi) = D(pi) / |p pi| (eqs 11, 12); 0 where no edge is near."""
    i = start + wp.tid()
    row = i // columns
    column = i % columns
    stride = columns + side - 1
    reach = float(side // 2)
    down = float(0.0)
    across = float(0.0)
    total = float(0.0)
    for r in range(side):
        sum_of_row = float(0.0)
        for c in range(side):
            w = weight[r * side + c] * closeness[(row + r) * stride + column + c]
            sum_of_row = sum_of_row + w
            across = across + w * (float(c) - reach)
        down = down + sum_of_row * (float(r) - reach)
        total = total + sum_of_row
    toward[row, column] = wp.vec2(down, across) / wp.max(total, 1.0e-20)
