"""Where two textures that overlap meet: the least-cost border through their belt."""

import numpy as np
from jaxtyping import Bool, Int32

from texloom.domain.domain import Domain
from texloom.fusion.belts import Belts
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.cuts import cheapest_cut, seam_costs

# Cuts all around a site: what it costs to show the other sample half a belt inside a region, or amid a narrow one.
_PULL = 1.0


def cut_border(
    shown: Int32[np.ndarray, "site"], belts: Belts, pair: tuple[int, int], layers: list[Canvas], domain: Domain
) -> None:
    """Let the border of two labels run where their ``layers`` fit best, by changing ``shown`` in place.

    Only sites change that lie within half a belt of both regions and show one of the two; both layers are known there
    and one step around. To show the other sample costs a site by the square of its way into its own region, in depths
    of the region: so narrow ones are not cut off, and borders stay near those of the map.
    """
    one, other = pair
    half = belts.half[one, other]
    steps = belts.steps[[one, other]]
    free = (steps <= half).all(0) & ((shown == one) | (shown == other))
    if not free.any():
        return
    known = ((shown == one) | (shown == other)) & (layers[one].label >= 0) & (layers[other].label >= 0)
    sites, edges = _around(domain, free & known, known)
    if not len(edges):
        return
    cost = seam_costs(layers[one].colour[sites], layers[other].colour[sites], edges)
    into = steps[:, sites] / np.minimum(half, belts.depth[sites])
    pull = _PULL * cost.sum() / len(sites) * into**2

    # Sites that are not free stay as they are.
    free, first = free[sites], shown[sites] == one
    side = cheapest_cut(edges, cost, one=~free & first, other=~free & ~first, price=pull[0] - pull[1])
    shown[sites] = np.where(side, one, other)


def _around(
    domain: Domain, free: Bool[np.ndarray, "site"], known: Bool[np.ndarray, "site"]
) -> tuple[Int32[np.ndarray, "node"], Int32[np.ndarray, "edge 2"]]:
    """The free sites with what is known beside them, and the pairs that touch, as rows of these.

    The domain's edges, and once more the pairs within a texel, diagonals with them: along edges alone, a grid's cuts
    would run straight along rows and columns.
    """
    edges = domain.edges
    edges = edges[free[edges].any(1) & known[edges].all(1)]
    middle = np.flatnonzero(free).astype(np.int32)
    around = domain.neighbourhoods(middle, 1).sites[:, 1:]
    once = (around >= 0) & known[around] & (~free[around] | (around > middle[:, None]))
    near = np.stack([np.broadcast_to(middle[:, None], around.shape)[once], around[once]], 1)
    pairs = np.concatenate([edges, near])
    touched = free.copy()
    touched[pairs] = True
    sites = np.flatnonzero(touched).astype(np.int32)
    number = np.empty(len(free), np.int32)
    number[sites] = np.arange(len(sites), dtype=np.int32)
    return sites, number[pairs]
