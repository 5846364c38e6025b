"""The cheapest cut is the cheapest: beside all others of small graphs, and beside straight ones of pictures."""

from itertools import product

import numpy as np
import pytest

from texloom.domain.grid import Grid
from texloom.synthesis.cuts import cheapest_cut, cheapest_side, seam_costs


@pytest.mark.parametrize("seed", range(6))
def test_no_other_cut_of_a_small_graph_is_cheaper(seed: int) -> None:
    rng = np.random.default_rng(seed)
    edges = np.array([(a, b) for a in range(9) for b in range(a) if rng.random() < 0.6])
    cost = rng.random(len(edges)) * 10.0 ** rng.integers(-3, 2)
    one, other = np.arange(9) < 2, np.arange(9) == 8
    side = cheapest_cut(edges, cost, one=one, other=other)
    assert side[one].all() and not side[other].any()

    def price(side: np.ndarray) -> float:
        return float(cost[side[edges[:, 0]] != side[edges[:, 1]]].sum())

    best = min(price(np.array([True, True, *free, False])) for free in product((False, True), repeat=6))
    assert price(side) == pytest.approx(best, rel=1e-6)


def test_a_seam_costs_no_more_than_any_straight_one() -> None:
    rng = np.random.default_rng(1)
    one, other = rng.random((2, 20 * 30, 4)).astype(np.float32)
    grid = Grid(20, 30)
    cost = seam_costs(one, other, grid.edges)
    column = np.arange(600) % 30
    side = cheapest_cut(grid.edges, cost, one=column < 2, other=column > 27)
    tried = [side, *(column < first for first in range(2, 28))]
    prices = [cost[s[grid.edges[:, 0]] != s[grid.edges[:, 1]]].sum() for s in tried]
    assert prices[0] < min(prices[1:])


def test_seams_are_cheap_where_pictures_agree_and_where_a_thing_ends() -> None:
    edges = np.array([[0, 1], [2, 3], [4, 5], [6, 7]])
    one = np.array([0.5, 0.5, 0, 0, 0, 0, 0, 0], np.float32)[:, None]
    other = np.array([0.5, 0.5, 1, 1, 0, 1, 1, 1], np.float32)[:, None]
    agree, differ, ends, also = seam_costs(one, other, edges)
    assert agree < 0.1 * differ and ends < 0.5 * differ and also == differ
    np.testing.assert_array_equal(seam_costs(other, one, edges), seam_costs(one, other, edges))


def test_no_edges_are_no_trouble() -> None:
    none = np.zeros((0, 2), np.int32)
    assert len(seam_costs(np.zeros((3, 4), np.float32), np.ones((3, 4), np.float32), none)) == 0
    side = cheapest_cut(none, np.zeros(0), one=np.array([True, False, False]), other=np.array([False, True, False]))
    np.testing.assert_array_equal(side, [True, False, False])


@pytest.mark.parametrize("seed", range(6))
def test_no_other_set_of_a_small_graph_is_cheaper(seed: int) -> None:
    rng = np.random.default_rng(seed)
    edges = rng.integers(0, 8, (14, 2))  # loops and doubles among them
    cost, own = rng.random(14), rng.normal(0, 1.5, 8)

    def price(side: np.ndarray) -> float:
        return float(cost[side[edges[:, 0]] != side[edges[:, 1]]].sum() + own[side].sum())

    best = min(price(np.array(side)) for side in product((False, True), repeat=8))
    assert price(cheapest_side(edges, cost, own)) == pytest.approx(best, abs=1e-6)
    fixed = np.arange(8)
    side = cheapest_cut(edges, cost, one=fixed == 0, other=fixed == 1, price=own)
    tied = (np.array([True, False, *rest]) for rest in product((False, True), repeat=6))
    assert side[0] and not side[1]
    assert price(side) == pytest.approx(min(map(price, tied)), abs=1e-6)
