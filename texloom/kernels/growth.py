"""The order in which patches grow from seeds over the graph of their borders, and a colouring of that graph.

Patches are rows of a compressed table; ``across`` holds the patch beyond each piece of border, ``length`` its length.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

_STEPS = wp.constant(64)  # shares of a border told apart


@wp.func
def swap(key: wp.array(dtype=wp.int64), item: wp.array(dtype=int), a: int, b: int):
    """Exchange two entries of a heap."""
    k = wp.int64(key[a])
    i = int(item[a])
    key[a] = key[b]
    item[a] = item[b]
    key[b] = k
    item[b] = i


@wp.func
def sift_up(key: wp.array(dtype=wp.int64), item: wp.array(dtype=int), last: int):
    """Restore a binary heap whose last entry is new."""
    at = int(last)
    while at > 0 and key[at] < key[(at - 1) / 2]:
        above = (at - 1) / 2
        swap(key, item, at, above)
        at = above


@wp.func
def sift_down(key: wp.array(dtype=wp.int64), item: wp.array(dtype=int), size: int):
    """Restore a binary heap whose first entry is new."""
    at = int(0)
    busy = bool(True)
    while busy:
        least = int(at)
        for side in range(2):
            below = 2 * at + 1 + side
            if below < size:
                if key[below] < key[least]:
                    least = below
        if least == at:
            busy = False
        else:
            swap(key, item, at, least)
            at = least


@wp.kernel(enable_backward=False)
def growth_order(
    start: int, first_of_part: wp.array(dtype=int), rim_start: wp.array(dtype=int), across: wp.array(dtype=int),
    length: wp.array(dtype=float), chance: wp.array(dtype=wp.uint32), seeds: int, constrained: int,
    key: wp.array(dtype=wp.int64), item: wp.array(dtype=int), bordering: wp.array(dtype=float),
    step: wp.array(dtype=int), order: wp.array(dtype=int),
):  # fmt: skip
    """Patches as they are grown, and for each the step at which all it depends on is there. One item, sequential.

    Growth begins at ``seeds`` patches at once, then anew in ``first_of_part``'s order where parts are left. The next
    patch is the one of whose rim the greatest share borders grown patches, the earliest reached among equals
    (``constrained``), or else the one of lowest ``chance``.
    """
    done = int(0)
    pushed = int(0)
    for p in range(step.shape[0]):
        step[p] = -1
        bordering[p] = 0.0
    for part in range(first_of_part.shape[0] - seeds + 1):
        size = int(0)
        begun = int(part + seeds - 1)
        if part == 0:
            begun = int(0)
        for seed in range(begun, part + seeds):
            if step[first_of_part[seed]] < 0:
                key[size] = wp.int64(pushed)
                item[size] = first_of_part[seed]
                size += 1
                pushed += 1
        while size > 0:
            p = int(item[0])
            size -= 1
            key[0] = key[size]
            item[0] = item[size]
            sift_down(key, item, size)
            if step[p] < 0:
                latest = int(-1)
                for j in range(rim_start[p], rim_start[p + 1]):
                    latest = wp.max(latest, step[across[j]])
                step[p] = latest + 1
                order[done] = p
                done += 1
                for j in range(rim_start[p], rim_start[p + 1]):
                    q = across[j]
                    if step[q] < 0:
                        whole = float(0.0)
                        for i in range(rim_start[q], rim_start[q + 1]):
                            whole += length[i]
                        bordering[q] = bordering[q] + length[j]
                        rank = wp.int64(chance[q])
                        if constrained != 0:
                            share = int(wp.floor(float(_STEPS) * bordering[q] / wp.max(whole, 1.0e-20) + 0.5))
                            rank = (wp.int64(_STEPS - share) << wp.int64(40)) + wp.int64(pushed)
                        key[size] = rank
                        item[size] = q
                        sift_up(key, item, size)
                        size += 1
                        pushed += 1


@wp.kernel(enable_backward=False)
def colour_patches(
    start: int, rim_start: wp.array(dtype=int), across: wp.array(dtype=int), colour: wp.array(dtype=int)
):
    """The lowest colour that no neighbour has, patch by patch (colours start at -1). One item, sequential."""
    for p in range(colour.shape[0]):
        candidate = int(0)
        clashes = int(1)
        while clashes > 0:
            clashes = int(0)
            for j in range(rim_start[p], rim_start[p + 1]):
                if colour[across[j]] == candidate:
                    clashes += 1
            if clashes > 0:
                candidate += 1
        colour[p] = candidate
