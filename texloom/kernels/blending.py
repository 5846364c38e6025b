"""Faces that each show their own piece of an exemplar: how much neighbours differ along an edge, and their blend.

Exemplar positions are (row, column). Halfedge ``3 f + c`` runs from corner ``c`` of face ``f`` to the next; its twin
runs the other way.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.taps import mix4, tap_place


@wp.kernel(enable_backward=False)
def edge_differences(
    start: int, image: wp.array(dtype=float), rows: int, columns: int, channels: int,
    position: wp.array2d(dtype=wp.vec2), first: wp.array(dtype=int), second: wp.array(dtype=int),
    mean: wp.array(dtype=float), root: wp.array(dtype=float),
):  # fmt: skip
    """mean = mean over points a texel apart of |image(p) - image(q)|, root = the root of the mean square.

    p walks along halfedge ``first`` in its face's map, q beside it along its twin ``second`` in the other's. Where both
    walk the same way, inside a patch, there is nothing to compare.
    """
    e = start + wp.tid()
    h = first[e]
    t = second[e]
    a = position[h / 3, h % 3]
    b = position[h / 3, (h % 3 + 1) % 3]
    c = position[t / 3, (t % 3 + 1) % 3]
    d = position[t / 3, t % 3]
    if a == c and b == d:
        mean[e] = 0.0
        root[e] = 0.0
        return
    count = wp.max(int(wp.ceil(wp.max(wp.length(b - a), wp.length(d - c)))), 1)
    total = float(0.0)
    squares = float(0.0)
    for k in range(count):
        along = (float(k) + 0.5) / float(count)
        p = a + along * (b - a)
        q = c + along * (d - c)
        here = tap_place(p[0], p[1], rows, columns)
        there = tap_place(q[0], q[1], rows, columns)
        i = (int(here[0]) * columns + int(here[1])) * channels
        j = (int(there[0]) * columns + int(there[1])) * channels
        i_right = wp.min(columns - 1 - int(here[1]), 1) * channels
        j_right = wp.min(columns - 1 - int(there[1]), 1) * channels
        i_down = wp.min(rows - 1 - int(here[0]), 1) * columns * channels
        j_down = wp.min(rows - 1 - int(there[0]), 1) * columns * channels
        apart = float(0.0)
        for channel in range(channels):
            x = i + channel
            y = j + channel
            ours = mix4(image[x], image[x + i_right], image[x + i_down], image[x + i_down + i_right], here[2], here[3])
            theirs = mix4(
                image[y], image[y + j_right], image[y + j_down], image[y + j_down + j_right], there[2], there[3]
            )
            apart += (ours - theirs) * (ours - theirs)
        total += wp.sqrt(apart)
        squares += apart
    mean[e] = total / float(count)
    root[e] = wp.sqrt(squares / float(count))


@wp.func
def share(own: float, second: float, third: float, reach: float):
    """A neighbour's share beside 1 for the own map: 1 on its edge (own = 0), 0 on the other two, smooth between.

    b_j b_k / ((b_i + b_j)(b_i + b_k)), less by a smooth step that ends at b_i = reach.
    """
    x = wp.min(own / reach, 1.0)
    fall = 1.0 - x * x * (3.0 - 2.0 * x)
    return fall * second * third / wp.max((own + second) * (own + third), 1.0e-12)


@wp.func
def swap(
    position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float), turn: wp.array2d(dtype=float),
    i: int, a: int, b: int,
):  # fmt: skip
    """Put the heavier of two sources first."""
    if weight[i, b] > weight[i, a]:
        p = position[i, a]
        w = weight[i, a]
        t = turn[i, a]
        position[i, a] = position[i, b]
        weight[i, a] = weight[i, b]
        turn[i, a] = turn[i, b]
        position[i, b] = p
        weight[i, b] = w
        turn[i, b] = t


@wp.kernel(enable_backward=False)
def blend_points(
    start: int, face: wp.array(dtype=int), barycentric: wp.array(dtype=wp.vec3), own: wp.array2d(dtype=wp.vec2),
    across: wp.array3d(dtype=wp.vec2), turns: wp.array2d(dtype=float), blended: wp.array2d(dtype=wp.uint8),
    reach: float, position: wp.array2d(dtype=wp.vec2), weight: wp.array2d(dtype=float), turn: wp.array2d(dtype=float),
):  # fmt: skip
    """The own map's place and those in the maps of the neighbours across blended edges, heaviest first."""
    i = start + wp.tid()
    f = face[i]
    b = barycentric[i]
    position[i, 0] = b[0] * own[f, 0] + b[1] * own[f, 1] + b[2] * own[f, 2]
    total = float(1.0)
    for k in range(3):
        position[i, k + 1] = b[0] * across[f, k, 0] + b[1] * across[f, k, 1] + b[2] * across[f, k, 2]
        turn[i, k + 1] = turns[f, k]
        w = float(0.0)
        if blended[f, k] != wp.uint8(0):
            w = share(b[k], b[(k + 1) % 3], b[(k + 2) % 3], reach)
        weight[i, k + 1] = w
        total += w
    weight[i, 0] = 1.0 / total
    turn[i, 0] = 0.0
    for k in range(1, 4):
        weight[i, k] = weight[i, k] / total
    swap(position, weight, turn, i, 1, 2)
    swap(position, weight, turn, i, 2, 3)
    swap(position, weight, turn, i, 1, 2)
