"""The order of growth: every patch once, next to what is there, and in batches that never touch."""

import heapq
from typing import NamedTuple

import numpy as np
import pytest
from numpy import ndarray

from texloom.kernels.growth import colour_patches, growth_order
from texloom.kernels.launch import launch


class Graph(NamedTuple):
    """Patches and the borders between them, in compressed rows."""

    start: ndarray
    across: ndarray
    length: ndarray

    @property
    def count(self) -> int:
        return len(self.start) - 1

    def rim(self, patch: int) -> range:
        return range(self.start[patch], self.start[patch + 1])


def graph(count: int, pairs: ndarray, lengths: ndarray) -> Graph:
    """Both sides of every border, its length on either."""
    own = np.concatenate([pairs[:, 0], pairs[:, 1]])
    order = np.argsort(own, kind="stable")
    across = np.concatenate([pairs[:, 1], pairs[:, 0]])[order].astype(np.int32)
    start = np.searchsorted(own[order], np.arange(count + 1)).astype(np.int32)
    return Graph(start, across, np.tile(lengths, 2)[order].astype(np.float32))


def at_random(rng: np.random.Generator, count: int, borders: int) -> Graph:
    """Some patches alone, some with several borders in common. Lengths are eighths: their sums are exact."""
    pairs = rng.integers(0, count, (borders, 2))
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    return graph(count, pairs, rng.integers(1, 40, len(pairs)) / 8)


def strip(count: int) -> Graph:
    """Each patch beside the next."""
    pairs = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1)
    return graph(count, pairs, np.ones(len(pairs)))


def grow(patches: Graph, first: ndarray, chance: ndarray, *, seeds: int, constrained: bool) -> tuple[ndarray, ndarray]:
    """The kernel's order, and the steps."""
    size = len(patches.across) + seeds
    key, item = np.full(size + 1, -9, np.int64), np.full(size + 1, -9, np.int32)
    bordering = np.empty(patches.count, np.float32)
    step, order = np.full(patches.count, -7, np.int32), np.full(patches.count, -7, np.int32)
    inputs = [first, patches.start, patches.across, patches.length, chance, seeds, int(constrained)]
    launch(growth_order, 1, inputs=inputs, outputs=[key, item, bordering, step, order])
    assert key[-1] == item[-1] == -9  # the heap stays within what it was given
    return order, step


def grow_slowly(
    patches: Graph, first: ndarray, chance: ndarray, *, seeds: int, constrained: bool
) -> tuple[list[int], dict[int, int]]:
    """The same with a heap of the library."""
    order: list[int] = []
    step: dict[int, int] = {}
    known = np.zeros(patches.count, np.float32)
    pushed = 0
    for begin in [first[:seeds], *first[seeds:, None]]:
        heap = []
        for p in begin:
            if p not in step:
                heapq.heappush(heap, (0, pushed, int(p)))
                pushed += 1
        while heap:
            p = heapq.heappop(heap)[-1]
            if p in step:
                continue
            step[p] = 1 + max((step.get(int(patches.across[j]), -1) for j in patches.rim(p)), default=-1)
            order.append(p)
            for j in patches.rim(p):
                q = int(patches.across[j])
                if q in step:
                    continue
                known[q] += patches.length[j]
                share = np.floor(64 * known[q] / sum(patches.length[i] for i in patches.rim(q)) + 0.5)
                rank = (64 - share, pushed) if constrained else (int(chance[q]), pushed)
                heapq.heappush(heap, (*rank, q))
                pushed += 1
    return order, step


@pytest.mark.parametrize("constrained", [True, False], ids=["constrained", "random"])
def test_patches_grow_in_the_order_of_a_plain_heap(constrained):
    for trial in range(60):
        rng = np.random.default_rng(trial)
        count = int(rng.integers(1, 40))
        patches = at_random(rng, count, int(rng.integers(0, 3 * count)))
        first = rng.permutation(count).astype(np.int32)
        chance = rng.permutation(count).astype(np.uint32) * np.uint32(97_000_003)
        seeds = int(rng.integers(1, min(count, 5) + 1)) if constrained else 1
        order, step = grow(patches, first, chance, seeds=seeds, constrained=constrained)
        slowly, steps = grow_slowly(patches, first, chance, seeds=seeds, constrained=constrained)
        assert order.tolist() == slowly
        assert step.tolist() == [steps[p] for p in range(count)]


def test_every_patch_grows_once_and_a_step_after_what_it_depends_on():
    rng = np.random.default_rng(3)
    patches = at_random(rng, 500, 700)  # many parts, some patches alone
    order, step = grow(patches, np.arange(500, dtype=np.int32), np.zeros(500, np.uint32), seeds=7, constrained=True)
    assert sorted(order) == list(range(500))
    rank = np.empty(500, int)
    rank[order] = np.arange(500)
    own = np.repeat(np.arange(500), np.diff(patches.start))
    earlier = rank[patches.across] < rank[own]
    assert (step[own[earlier]] > step[patches.across[earlier]]).all()
    assert (step[own] != step[patches.across]).all()  # a batch never touches itself
    latest = np.full(500, -1)
    np.maximum.at(latest, own[earlier], step[patches.across[earlier]])
    np.testing.assert_array_equal(step, latest + 1)  # nor waits for anything else


def test_constrained_growth_closes_gaps_first():
    # Of 2 most is known at first, then of 1; then all of 3, and of 4 little
    pairs = np.array([[0, 1], [0, 2], [1, 3], [2, 3], [1, 4], [4, 5]])
    patches = graph(6, pairs, np.array([4.0, 4, 1, 1, 1, 8]))
    order, _ = grow(patches, np.arange(6, dtype=np.int32), np.zeros(6, np.uint32), seeds=1, constrained=True)
    assert order.tolist() == [0, 2, 1, 3, 4, 5]
    chance = np.array([0, 1, 5, 4, 2, 3], np.uint32)
    order, _ = grow(patches, np.arange(6, dtype=np.int32), chance, seeds=1, constrained=False)
    assert order.tolist() == [0, 1, 4, 5, 3, 2]


def test_several_seeds_shorten_the_way():
    first = np.array([0, 50, 99, *range(1, 50), *range(51, 99)], np.int32)
    nobody = np.zeros(100, np.uint32)
    _, alone = grow(strip(100), first, nobody, seeds=1, constrained=True)
    _, three = grow(strip(100), first, nobody, seeds=3, constrained=True)
    assert alone.max() == 99 and 24 <= three.max() <= 50
    assert three[0] == three[50] == three[99] == 0


def test_patches_without_borders_all_grow_at_once():
    empty = Graph(np.zeros(6, np.int32), np.empty(0, np.int32), np.empty(0, np.float32))
    first = np.array([3, 0, 4, 1, 2], np.int32)
    order, step = grow(empty, first, np.zeros(5, np.uint32), seeds=1, constrained=True)
    assert order.tolist() == first.tolist() and not step.any()


def test_neighbours_have_different_colours_and_few_are_needed():
    for trial in range(20):
        patches = at_random(np.random.default_rng(trial), 60, 90)
        colour = np.full(60, -1, np.int32)
        launch(colour_patches, 1, inputs=[patches.start, patches.across], outputs=[colour])
        own = np.repeat(np.arange(60), np.diff(patches.start))
        assert (colour >= 0).all() and (colour[own] != colour[patches.across]).all()
        for p in range(60):  # the lowest that none of the lower patches has
            taken = {int(colour[q]) for q in patches.across[patches.start[p] : patches.start[p + 1]] if q < p}
            assert colour[p] == next(c for c in range(61) if c not in taken)
