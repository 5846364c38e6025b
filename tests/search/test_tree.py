"""The kd-tree finds what looking at every point finds, equals included."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import ndarray

from texloom.arrays import fours
from texloom.exemplar.pca import fit
from texloom.kernels.launch import launch
from texloom.kernels.tree import nearest_in_tree
from texloom.search.tree import KdTree, PcaTree


def naive(queries: ndarray, points: ndarray, count: int) -> tuple[ndarray, ndarray]:
    """The first of a stable sort; -1 at infinity where there are no more."""
    cost = ((queries[:, None].astype(float) - points) ** 2).sum(2)
    order = np.argsort(cost, axis=1, kind="stable")[:, :count]
    absent = ((0, 0), (0, max(0, count - len(points))))
    return (
        np.pad(order, absent, constant_values=-1),
        np.pad(np.take_along_axis(cost, order, 1), absent, constant_values=np.inf),
    )


@settings(max_examples=60, deadline=None)
@given(
    points=st.integers(1, 200),
    dim=st.integers(1, 9),
    count=st.integers(1, 6),
    levels=st.sampled_from([2, 5, 100]),
    seed=st.integers(0, 10**6),
)
def test_the_nearest_are_found_nearest_first_and_equals_by_index(
    points: int, dim: int, count: int, levels: int, seed: int
) -> None:
    """Whole coordinates, so that costs are exact; few of them, so that points and distances repeat."""
    rng = np.random.default_rng(seed)
    known = rng.integers(0, levels, (points, dim)).astype(np.float32)
    asked = rng.integers(-1, levels + 1, (30, dim)).astype(np.float32)
    found, cost = KdTree.of(known).nearest(asked, count)
    expected, expected_cost = naive(asked, known, count)
    np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(cost, expected_cost)


def test_a_large_tree_of_fractions() -> None:
    rng = np.random.default_rng(1)
    known = (rng.normal(0, 1, (5000, 10)) * 2.0 ** -np.arange(10)).astype(np.float32)
    asked = known[::25] + rng.normal(0, 0.1, (200, 10)).astype(np.float32)
    found, cost = KdTree.of(known).nearest(asked, 3)
    expected, expected_cost = naive(asked, known, 3)
    np.testing.assert_allclose(cost, expected_cost, rtol=1e-4)
    assert (found == expected).mean() > 0.999


@pytest.mark.parametrize("count", [1, 2, 12, 13, 25, 97])
def test_leaves_hold_every_point_once_and_boxes_are_tight(count: int) -> None:
    points = np.random.default_rng(count).random((count, 3), np.float32)
    tree = KdTree.of(points)
    leaves = (len(tree.first) + 1) // 2
    np.testing.assert_array_equal(np.sort(tree.index), np.arange(count))
    np.testing.assert_array_equal(tree.points[:, :3], points[tree.index])
    np.testing.assert_array_equal(tree.first[-leaves:][1:], tree.last[-leaves:][:-1])
    assert tree.first[-leaves] == 0 and tree.last[-1] == count
    assert (tree.last - tree.first)[-leaves:].max() <= 12
    for low, high, first, last in zip(tree.low, tree.high, tree.first, tree.last, strict=True):
        np.testing.assert_array_equal(low, tree.points[first:last].min(0))
        np.testing.assert_array_equal(high, tree.points[first:last].max(0))
    for node in range(len(tree.first) - leaves):
        assert tree.first[2 * node + 1] == tree.first[node] and tree.last[2 * node + 2] == tree.last[node]
        assert tree.last[2 * node + 1] == tree.first[2 * node + 2]


def test_guesses_given_in_advance_change_nothing_but_a_better_one_stays() -> None:
    rng = np.random.default_rng(2)
    points, asked = rng.random((300, 8), np.float32), rng.random((40, 8), np.float32)
    tree = KdTree.of(points)
    expected, expected_cost = tree.nearest(asked, 3)

    found, cost = np.full((40, 3), -1, np.int32), np.full((40, 3), np.inf, np.float32)
    found[:20, 0], found[20:, 0] = rng.integers(0, 300, 20), expected[20:, 1]  # the second nearest is not found twice
    cost[:, 0] = ((points[found[:, 0]] - asked) ** 2).sum(1)
    found[:7, 0], cost[:7, 0] = 999, 0  # nearer than any point
    launch(nearest_in_tree, 40, inputs=[*tree.arrays, fours(asked)], outputs=[found, cost])
    np.testing.assert_array_equal(found[7:], expected[7:])
    np.testing.assert_allclose(cost[7:], expected_cost[7:], rtol=1e-5)
    np.testing.assert_array_equal(found[:7], np.concatenate([np.full((7, 1), 999), expected[:7, :2]], 1))


def test_the_search_is_exact_among_the_projections() -> None:
    rng = np.random.default_rng(3)
    known = (rng.random((400, 5)) @ rng.random((5, 60)) + 0.05 * rng.random((400, 60))).astype(np.float32)
    asked = (known[:80] + 0.1 * rng.random((80, 60))).astype(np.float32)
    projection = fit(known, 6)
    expected = naive(projection(asked), projection(known), 1)[0][:, 0]
    match = PcaTree(dimensions=6).prepare(known).nearest(asked)
    assert (match.index == expected).mean() > 0.98
