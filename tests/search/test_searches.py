"""Every search against the naive one, and all of them by the same laws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from texloom.kernels.launch import use
from texloom.search import SEARCHES, Clusters, Exhaustive, PcaClusters, PcaNearest
from texloom.search.kmeans import cluster

RNG = np.random.default_rng(8)
ALL = pytest.mark.parametrize("search", SEARCHES.values(), ids=SEARCHES)


def vectors(count=600, dim=40, seed=0):
    """Vectors around a few places, most of their variance in a few directions, as patches are."""
    rng = np.random.default_rng(seed)
    places = rng.random((12, dim))[rng.integers(0, 12, count)]
    spread = 0.3 * rng.random((count, 6)) @ rng.random((6, dim))
    return (places + spread + 0.02 * rng.random((count, dim))).astype(np.float32)


def naive(queries, candidates):
    """Index and cost of the nearest by differences in double precision."""
    costs = ((queries[:, None].astype(float) - candidates) ** 2).sum(axis=2)
    return costs.argmin(axis=1), costs.min(axis=1)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 300), st.integers(1, 300), st.integers(1, 30), st.floats(-50, 50))
def test_exhaustive_is_the_naive_search(queries, candidates, dim, offset):
    asked = (RNG.random((queries, dim)) + offset).astype(np.float32)
    known = (RNG.random((candidates, dim)) + offset).astype(np.float32)
    match = Exhaustive().prepare(known).nearest(asked)
    index, cost = naive(asked, known)
    np.testing.assert_allclose(match.cost, cost, rtol=1e-4, atol=1e-8)
    assert (match.index == index).mean() > 0.99
    assert match.index.dtype == np.int32 and match.cost.dtype == np.float32


def test_candidates_in_several_blocks_are_all_seen():
    known = RNG.random((20000, 3), np.float32)
    match = Exhaustive().prepare(known).nearest(known[::37])
    np.testing.assert_array_equal(match.index, np.arange(20000)[::37])


def test_equal_costs_take_the_lowest_index():
    known = np.repeat(vectors(40), 30, axis=0)
    match = Exhaustive().prepare(known).nearest(known[::30])
    np.testing.assert_array_equal(match.index, np.arange(40) * 30)


def test_equal_costs_in_different_blocks_take_the_lowest_index():
    known = np.tile(vectors(3000, 8), (4, 1))
    np.testing.assert_array_equal(Exhaustive().prepare(known).nearest(known[9000:]).index, np.arange(3000))


def test_near_ties_are_told_apart():
    """A difference of one part in 10⁴ on one of many values is far under the rounding of the product."""
    base = 100 * RNG.random(200).astype(np.float32)
    known = np.tile(base, (6, 1))
    known[range(6), range(6)] += np.float32(0.01)
    np.testing.assert_array_equal(Exhaustive().prepare(known).nearest(known).index, range(6))


@ALL
def test_candidates_find_themselves_at_no_cost(search):
    known = vectors()
    match = search.prepare(known).nearest(known)
    np.testing.assert_array_equal(match.index, np.arange(len(known)))
    assert not match.cost.any()


@ALL
def test_threads_do_not_matter(search):
    known, asked = vectors(1000), vectors(777, seed=1)
    found = []
    try:
        for threads in (1, 2, 3):
            use(threads=threads)
            found.append(search.prepare(known).nearest(asked))
    finally:
        use(threads=2)
    for match in found[1:]:
        np.testing.assert_array_equal(match.index, found[0].index)
        np.testing.assert_array_equal(match.cost, found[0].cost)


@ALL
def test_costs_are_those_of_the_whole_vectors(search):
    known, asked = vectors(), vectors(100, seed=1)
    match = search.prepare(known).nearest(asked)
    np.testing.assert_allclose(match.cost, ((asked - known[match.index]) ** 2).sum(axis=1), rtol=1e-5)
    assert (match.cost >= naive(asked, known)[1] * (1 - 1e-4)).all()


@ALL
def test_what_was_learnt_restores_the_search(search):
    known, asked = vectors(), vectors(100, seed=1)
    index = search.prepare(known)
    restored = search.restore(known, index.state())
    np.testing.assert_array_equal(restored.nearest(asked).index, index.nearest(asked).index)


@ALL
def test_equal_candidates_and_no_queries_are_fine(search):
    known = np.ones((50, 7), np.float32)
    index = search.prepare(known)
    assert index.nearest(known[:3]).index.tolist() == [0, 0, 0]
    assert index.nearest(known[:0]).index.shape == (0,)


@pytest.mark.parametrize(
    "exact", [PcaNearest(dimensions=40), Clusters(clusters=1), PcaClusters(dimensions=40, clusters=1)]
)
def test_with_nothing_left_out_each_is_exhaustive(exact):
    known, asked = vectors(), vectors(200, seed=1)
    reference = Exhaustive().prepare(known).nearest(asked)
    match = exact.prepare(known).nearest(asked)
    np.testing.assert_allclose(match.cost, reference.cost, rtol=1e-3)
    assert (match.index == reference.index).mean() > 0.99


@pytest.mark.parametrize(
    "search, recall, excess",
    [(PcaNearest(dimensions=12), 0.6, 1.05), (Clusters(), 0.6, 1.4), (PcaClusters(), 0.6, 1.4)],
)
def test_approximate_searches_are_nearly_right(search, recall, excess):
    known = vectors(2000)
    asked = (known[:500] + 0.01 * np.random.default_rng(1).standard_normal((500, 40))).astype(np.float32)
    reference = Exhaustive().prepare(known).nearest(asked)
    match = search.prepare(known).nearest(asked)
    assert (match.index == reference.index).mean() > recall
    assert match.cost.mean() < excess * reference.cost.mean()


def test_clusters_are_where_the_vectors_are():
    places = 10 * RNG.random((5, 3)).astype(np.float32)
    known = (np.repeat(places, 40, axis=0) + 0.01 * RNG.random((200, 3))).astype(np.float32)
    centres, label = cluster(known, 40)
    assert len(np.unique(label)) == len(centres) <= 40
    for i in range(len(centres)):
        np.testing.assert_allclose(centres[i], known[label == i].mean(axis=0), atol=1e-4)
    assert naive(places, centres)[1].max() < 0.01
