"""The cheapest cut of a graph into two sides (Kwatra et al. 2003, section 3)."""

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

_RANGE = 2.0**29  # all capacities together: flows are 32-bit, and twice as much may go back
_LENGTH = 0.03  # of the mean: what any edge costs, so that equals are cut along short lines
_EDGE = 0.3  # of the mean step: steps in either picture that make a cut there half as dear


def seam_costs(
    one: Float32[np.ndarray, "site channel"],
    other: Float32[np.ndarray, "site channel"],
    edges: Int[np.ndarray, "edge 2"],
) -> Float32[np.ndarray, "edge"]:
    """What it costs to pass from one picture to the other along each edge, between sites that both show.

    Squared differences of the pictures at both ends, less where either has an edge of its own: there a thing ends, and
    may end before another. Kwatra et al. 2003, equation 5, with squares, which rather go around than through, and a
    little for length.
    """
    first, second = edges.T
    differ = ((one - other) ** 2).sum(1)
    step = sum(np.sqrt(((picture[first] - picture[second]) ** 2).sum(1)) for picture in (one, other))
    if not len(edges):
        return np.zeros(0, np.float32)
    usual = np.float32(_EDGE * max(float(np.mean(step)), 1e-6))
    cost = (differ[first] + differ[second]) * (usual / (usual + step))
    return cost + np.float32(max(_LENGTH * float(cost.mean()), 1e-9))


def cheapest_cut(
    edges: Int[np.ndarray, "edge 2"],
    cost: Float[np.ndarray, "edge"],
    *,
    one: Bool[np.ndarray, "node"],
    other: Bool[np.ndarray, "node"],
    price: Float[np.ndarray, "node"] | None = None,
) -> Bool[np.ndarray, "node"]:
    """Nodes on the side of ``one``, where the edges between the sides cost least in all.

    Nodes of ``one`` and ``other`` (which share none) stay on their side; ``price`` is what that of ``one`` costs a
    free node more than that of ``other``. Among cheapest cuts, the one closest to ``one``; nodes that neither side
    reaches go to ``other``. See ``cheapest_side``.
    """
    free = ~(one | other)
    number = np.cumsum(free, dtype=np.int32) - np.int32(1)
    first, second = edges.T
    price = np.zeros(len(one)) if price is None else price.astype(np.float64)
    # An edge to a node that stays is a price of its other end.
    for this, that in ((first, second), (second, first)):
        price += np.bincount(this, np.where(one[that], -cost, np.where(other[that], cost, 0)), len(one))
    inner = free[first] & free[second]
    side = one.copy()
    side[free] = cheapest_side(number[edges[inner]], cost[inner], price[free])
    return side


def cheapest_side(
    edges: Int[np.ndarray, "edge 2"], cost: Float[np.ndarray, "edge"], price: Float[np.ndarray, "node"]
) -> Bool[np.ndarray, "node"]:
    """The set of nodes that is cheapest by its ``price`` (below 0: it pays) and the cost of edges to all others.

    Edges cost 0 or more; of equally cheap sets the smallest. All are compared as whole shares of their sum, about
    nine digits.
    """
    from scipy.sparse import coo_array, csr_array
    from scipy.sparse.csgraph import breadth_first_order, maximum_flow

    # Nodes that pay hang on the source, the others on the sink: what joins is what the source reaches past the flow.
    count = len(price)
    source, sink, node = count, count + 1, np.arange(count, dtype=np.int32)
    apart = edges[:, 0] != edges[:, 1]
    one = np.concatenate([edges[apart, 0], node])
    other = np.concatenate([edges[apart, 1], np.where(price < 0, np.int32(source), np.int32(sink))])
    capacity = np.concatenate([cost[apart], np.abs(price)])
    capacity = np.rint(capacity * (_RANGE / max(float(capacity.sum()), 1e-30))).astype(np.int32)
    pairs = np.concatenate([one, other]), np.concatenate([other, one])
    graph = coo_array((np.concatenate([capacity, capacity]), pairs), shape=(count + 2, count + 2)).tocsr()
    # Every edge goes both ways, so that the flow has the same entries.
    left = graph.data > maximum_flow(graph, source, sink).flow.data
    start = np.concatenate([[0], np.cumsum(left, dtype=np.int32)])[graph.indptr]
    residual = csr_array((np.ones(start[-1], np.int32), graph.indices[left], start), shape=graph.shape)
    reached = np.zeros(count + 2, bool)
    reached[breadth_first_order(residual, source, return_predecessors=False)] = True
    return reached[:count]
