"""Belts: the narrow bands along the borders between labels, where two samples both may show."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int32, Int64

from texloom.domain.domain import Domain
from texloom.domain.steps import steps_from


@dataclass(frozen=True, eq=False)
class Belts:
    """Where each sample may show.

    ``steps`` leads along edges from each region to each site (0: inside; no farther than its widest belt), ``half``
    holds the half widths of the belts between two labels. ``depth`` is how deep the region is around a site, or at
    least half its widest belt: in a narrow stroke, half the stroke's width.
    """

    labels: Int32[np.ndarray, "site"]
    steps: Int32[np.ndarray, "label site"]
    half: Int32[np.ndarray, "label label"]
    depth: Int32[np.ndarray, "site"]

    @property
    def allowed(self) -> Bool[np.ndarray, "label site"]:
        """Within half a belt of the label's region, by the belt of the two labels."""
        return self.steps <= self.half[:, self.labels]

    def nearest(self) -> Int32[np.ndarray, "site"]:
        """The other label whose region is nearest, the lowest among equals; -1 where none is within half a belt."""
        far = np.iinfo(np.int32).max
        steps = np.where(self.allowed, self.steps, far)
        steps[self.labels, np.arange(len(self.labels))] = far
        nearest = steps.argmin(0).astype(np.int32)
        return np.where(steps.min(0) < far, nearest, np.int32(-1))


def lay_belts(domain: Domain, labels: Int32[np.ndarray, "site"], scales: Float[np.ndarray, "label"]) -> Belts:
    """Belts half the larger window wide, that is as wide as the larger dominant scale of the two samples in texels.

    Distances are counted in steps along the domain's edges, so a belt follows any border on any surface.
    Shin & Shin 2004, section 4. O(edge + site · label) time, and what lies in belts.
    """
    half = np.maximum(np.rint(np.maximum(scales[:, None], scales) / 2), 1).astype(np.int32)
    steps = [steps_from(domain, labels == label, int(half[label].max())) for label in range(len(scales))]
    depth = np.empty(domain.count, np.int32)
    for label in range(len(scales)):
        own = labels == label
        depth[own] = _depth(domain, own, int(half[label].max()))[own]
    return Belts(labels, np.stack(steps), half, depth)


def pairs_of(labels: Int32[np.ndarray, "site"], other: Int32[np.ndarray, "site"]) -> Int64[np.ndarray, "pair 2"]:
    """Pairs of labels that meet, the lower first, in order; ``other`` is -1 where there is none."""
    both = np.stack([labels, other], 1)[other >= 0]
    return np.unique(np.sort(both, axis=1), axis=0).astype(np.int64).reshape(-1, 2)


def _depth(domain: Domain, own: Bool[np.ndarray, "site"], half: int) -> Int32[np.ndarray, "site"]:
    """How far from its border the region reaches around each of its sites, up to ``half``.

    Sites within ``half`` of one that deep have that; the others of each connected part share its deepest.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    inside = steps_from(domain, ~own, half)
    narrow = own & (steps_from(domain, inside > half, half) > half)
    depth = np.full(len(own), half, np.int32)
    if narrow.any():
        edges = domain.edges[narrow[domain.edges].all(1)]
        graph = coo_array((np.ones(len(edges), bool), tuple(edges.T)), shape=(len(own), len(own)))
        count, part = connected_components(graph, directed=False)
        deepest = np.zeros(count, np.int32)
        np.maximum.at(deepest, part[narrow], inside[narrow])
        depth[narrow] = deepest[part[narrow]]
    return depth
