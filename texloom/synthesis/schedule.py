"""Order as data: which patches may be laid at the same time."""

import numpy as np
from jaxtyping import Bool, Int32

from texloom import draws
from texloom.domain.cover import group_by_site, ranges
from texloom.domain.patches import Patches

_TIES = 0x71E5  # purpose of the draws that order equals


def overlaps(patches: Patches) -> Bool[np.ndarray, "patch patch"]:
    """Whether two patches share a site. O(entries · cover) time, one byte a pair."""
    shared = np.zeros((patches.count, patches.count), bool)
    site_of_entry = np.repeat(np.arange(len(patches.cover_start) - 1, dtype=np.int32), np.diff(patches.cover_start))
    for step in range(1, int(np.diff(patches.cover_start).max(initial=0))):
        same = site_of_entry[step:] == site_of_entry[:-step]
        shared[patches.cover_patch[:-step][same], patches.cover_patch[step:][same]] = True
    return shared | shared.T


def batches(order: Int32[np.ndarray, "patch"], shared: Bool[np.ndarray, "patch patch"]) -> list[np.ndarray]:
    """Independent groups that keep the order wherever two patches overlap: each goes in the first group it can."""
    group = np.full(len(order), -1)
    for patch in order:
        group[patch] = group[shared[patch]].max(initial=-1) + 1
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    by_group = np.lexsort((rank, group))
    return np.split(by_group.astype(np.int32), np.flatnonzero(np.diff(group[by_group])) + 1)


def breadth_first(shared: Bool[np.ndarray, "patch patch"], seed: int) -> Int32[np.ndarray, "patch"]:
    """Patches by hops from the first through overlaps, in random order among equals so that many can be laid at once.

    Other parts of the domain follow, each from its first patch.
    """
    rank = draws.permutation(seed, _TIES, count=len(shared))
    left = np.ones(len(shared), bool)
    order: list[np.ndarray] = []
    while left.any():
        front = np.flatnonzero(left)[:1]
        while len(front):
            left[front] = False
            order.append(front[np.argsort(rank[front])])
            front = np.flatnonzero(shared[front].any(0) & left)
    return np.concatenate(order).astype(np.int32)


def touching(patches: Patches, sites: Bool[np.ndarray, "site"]) -> Int32[np.ndarray, "patch"]:
    """Patches that lie over any of ``sites``."""
    touched = np.zeros(patches.count, bool)
    touched[patches.cover_patch[ranges(patches.cover_start, np.flatnonzero(sites))]] = True
    return np.flatnonzero(touched).astype(np.int32)


def inwards(
    patches: Patches, known: Bool[np.ndarray, "site"], laid: Int32[np.ndarray, "laid"], seed: int
) -> Int32[np.ndarray, "laid"]:
    """The order that lays next, of ``laid``, the patch of which the largest share is known or laid; indices into it.

    Equals come in random order. O(laid² + entry) time.
    """
    start, entries = group_by_site(patches.cover_patch, patches.count)
    site = np.repeat(np.arange(len(known), dtype=np.int32), np.diff(patches.cover_start))[entries]
    size = np.maximum(np.diff(start), 1)
    context = np.bincount(patches.cover_patch[entries], weights=known[site], minlength=patches.count)
    known = known.copy()
    waiting = draws.permutation(seed, _TIES, count=len(laid))
    order = np.empty(len(laid), np.int32)
    for step in range(len(laid)):
        candidates = laid[waiting]
        best = int((context[candidates] / size[candidates]).argmax())
        order[step] = waiting[best]
        own = site[slice(*start[candidates[best] : candidates[best] + 2].tolist())]
        fresh = own[~known[own]]
        known[fresh] = True
        context += np.bincount(patches.cover_patch[ranges(patches.cover_start, fresh)], minlength=patches.count)
        waiting = np.delete(waiting, best)
    return order
