"""Exact nearest points in a kd-tree with tight boxes (Bentley 1975; Mount's ANN keeps boxes the same way).

The tree is complete: node ``i`` has the children ``2i + 1`` and ``2i + 2``, and the nodes of the last level are
leaves. A node's points are ``first[i] ... last[i] - 1`` of ``points``, which are stored in the order of the leaves.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

STACK = wp.constant(32)  # nodes waiting; a complete tree of 2^31 leaves needs one a level


@wp.func
def box_distance(
    low: wp.array2d(dtype=wp.vec4),
    high: wp.array2d(dtype=wp.vec4),
    node: int,
    queries: wp.array2d(dtype=wp.vec4),
    i: int,
) -> float:
    """Squared distance of query i to the box around a node's points."""
    total = float(0.0)
    for g in range(queries.shape[1]):
        q = queries[i, g]
        d = wp.max(wp.max(low[node, g] - q, q - high[node, g]), wp.vec4(0.0))
        total += wp.dot(d, d)
    return total


@wp.func
def offer(found: wp.array2d(dtype=int), cost: wp.array2d(dtype=float), i: int, candidate: int, distance: float):
    """Put a candidate into the sorted list of query i, unless it is there or the list is full of better ones."""
    k = int(found.shape[1] - 1)
    if distance > cost[i, k] or (distance == cost[i, k] and candidate >= found[i, k]):
        return
    for j in range(found.shape[1]):
        if found[i, j] == candidate:
            return
    while k > 0 and (cost[i, k - 1] > distance or (cost[i, k - 1] == distance and found[i, k - 1] > candidate)):
        found[i, k] = found[i, k - 1]
        cost[i, k] = cost[i, k - 1]
        k -= 1
    found[i, k] = candidate
    cost[i, k] = distance


@wp.func
def search_tree(
    points: wp.array2d(dtype=wp.vec4),  # in the order of the leaves, coordinates in fours
    index: wp.array(dtype=int),  # which candidate each point is
    low: wp.array2d(dtype=wp.vec4),  # boxes of the nodes
    high: wp.array2d(dtype=wp.vec4),
    first: wp.array(dtype=int),
    last: wp.array(dtype=int),
    queries: wp.array2d(dtype=wp.vec4),
    i: int,
    found: wp.array2d(dtype=int),
    cost: wp.array2d(dtype=float),
):
    """The nearest candidates of query i, nearest first, equal distances by the lower index, into row i of ``found``.

    What the row holds already bounds the search: start it with good guesses, or with -1 and infinite costs.
    """
    nodes = wp.zeros(shape=(STACK,), dtype=int)
    bounds = wp.zeros(shape=(STACK,), dtype=float)
    waiting = int(1)
    worst = found.shape[1] - 1
    leaves = (first.shape[0] + 1) / 2
    while waiting > 0:
        waiting -= 1
        node = int(nodes[waiting])
        if bounds[waiting] <= cost[i, worst]:
            while node < leaves - 1:  # down the nearer side, the farther one waits
                near = 2 * node + 1
                far = 2 * node + 2
                near_bound = box_distance(low, high, near, queries, i)
                far_bound = box_distance(low, high, far, queries, i)
                if far_bound < near_bound:
                    swap = near
                    near = far
                    far = swap
                    held = near_bound
                    near_bound = far_bound
                    far_bound = held
                if far_bound <= cost[i, worst]:
                    nodes[waiting] = far
                    bounds[waiting] = far_bound
                    waiting += 1
                node = near
                if near_bound > cost[i, worst]:
                    node = -1
                    break
            if node >= 0:
                for p in range(first[node], last[node]):
                    total = float(0.0)
                    for g in range(queries.shape[1]):
                        d = points[p, g] - queries[i, g]
                        total += wp.dot(d, d)
                        if total > cost[i, worst]:
                            break
                    if total <= cost[i, worst]:
                        offer(found, cost, i, index[p], total)


@wp.kernel(enable_backward=False)
def nearest_in_tree(
    start: int,
    points: wp.array2d(dtype=wp.vec4),  # in the order of the leaves, coordinates in fours
    index: wp.array(dtype=int),  # which candidate each point is
    low: wp.array2d(dtype=wp.vec4),  # boxes of the nodes
    high: wp.array2d(dtype=wp.vec4),
    first: wp.array(dtype=int),
    last: wp.array(dtype=int),
    queries: wp.array2d(dtype=wp.vec4),
    found: wp.array2d(dtype=int),
    cost: wp.array2d(dtype=float),
):
    """``search_tree`` for every query."""
    search_tree(points, index, low, high, first, last, queries, start + wp.tid(), found, cost)
