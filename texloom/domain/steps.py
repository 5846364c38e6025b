"""How many steps along edges lie between sites."""

import numpy as np
from jaxtyping import Bool, Int32

from texloom.domain.cover import group_by_site, ranges
from texloom.domain.domain import Domain


def within(domain: Domain, sites: Bool[np.ndarray, "site"], steps: int) -> Bool[np.ndarray, "site"]:
    """``sites`` and all that lie at most that many steps along edges from them."""
    return steps_from(domain, sites, steps) <= steps


def steps_from(domain: Domain, sites: Bool[np.ndarray, "site"], most: int) -> Int32[np.ndarray, "site"]:
    """Steps along edges from the nearest of ``sites``; ``most + 1`` where they are more. O(edge) time."""
    start, neighbour = _neighbours(domain)
    steps = np.where(sites, np.int32(0), np.int32(most + 1))
    front = np.flatnonzero(sites)
    for step in range(1, most + 1):
        near = neighbour[ranges(start, front)]
        front = np.unique(near[steps[near] > step])
        if not len(front):
            break
        steps[front] = step
    return steps


def _neighbours(domain: Domain) -> tuple[Int32[np.ndarray, "sites_plus_one"], Int32[np.ndarray, "entry"]]:
    """The other ends of each site's edges, in compressed rows."""
    first, second = domain.edges.T
    start, order = group_by_site(np.concatenate([first, second]), domain.count)
    return start, np.concatenate([second, first])[order]
