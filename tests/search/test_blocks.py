"""Where a block fits: the coarse costs and the refined ones against plain differences."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import ndarray

from tests import naive
from texloom.search.blocks import BlockSearch

FEW = settings(max_examples=12, deadline=None)


def averaged(image: ndarray, step: int) -> ndarray:
    rows, columns = image.shape[0] // step, image.shape[1] // step
    return image[: rows * step, : columns * step].reshape(rows, step, columns, step, -1).mean((1, 3))


@FEW
@given(rows=st.integers(8, 21), columns=st.integers(8, 21), masked=st.booleans(), seed=st.integers(0, 999))
def test_blocks_begin_where_they_are_wholly_usable(rows: int, columns: int, masked: bool, seed: int) -> None:
    rng = np.random.default_rng(seed)
    mask = rng.random((rows, columns)) < 0.98
    search = BlockSearch(np.zeros((rows, columns, 4), np.float32), 8, mask if masked else None)
    places = [(r, c) for r in range(rows - 7) for c in range(columns - 7)]
    whole = [not masked or bool(mask[r : r + 8, c : c + 8].all()) for r, c in places]
    np.testing.assert_array_equal(search.usable.ravel(), whole)
    coarse = [place for place, ok in zip(places, whole, strict=True) if ok and place[0] % 4 == 0 == place[1] % 4]
    np.testing.assert_array_equal(search.anchors, np.reshape(coarse, (-1, 2)))


@FEW
@given(seed=st.integers(0, 10**6), step=st.sampled_from([1, 2, 4]))
def test_coarse_costs_are_those_of_averaged_texels(seed: int, step: int) -> None:
    rng = np.random.default_rng(seed)
    image = rng.random((20, 17, 4), np.float32)
    search = BlockSearch(image, 8, step=step)
    values = rng.random((2, 64, 4), np.float32)
    known = np.zeros((2, 8, 8), np.float32)
    known[0, :, :4], known[1] = 1, 1  # whole cells, so that the averages of known texels are the cells' own
    known = known.reshape(2, 64)
    values *= known[..., None]
    cost = search.coarse_cost(values, known)

    small, cells = averaged(image, step), 8 // step
    for p in range(2):
        cell = averaged(values[p].reshape(8, 8, 4), step)
        there = averaged(known[p].reshape(8, 8, 1), step)[..., 0]
        expected = [naive.block_cost(small, tuple(a // step), cell, there) for a in search.anchors]
        np.testing.assert_allclose(cost[p], expected, rtol=1e-3, atol=1e-4)
        assert cells == len(cell)


def test_nothing_known_costs_nothing() -> None:
    search = BlockSearch(np.ones((12, 12, 4), np.float32), 8)
    cost = search.coarse_cost(np.zeros((1, 64, 4), np.float32), np.zeros((1, 64), np.float32))
    np.testing.assert_array_equal(cost, 0)


@pytest.mark.parametrize("place", [(0, 0), (3, 5), (9, 9), (12, 1)])
def test_a_block_of_the_exemplar_is_found_again(place: tuple[int, int]) -> None:
    """Half of it is known, and it begins off the lattice of coarse candidates."""
    rng = np.random.default_rng(1)
    image = np.cumsum(rng.normal(0, 0.1, (24, 24, 4)), axis=0).astype(np.float32)  # smooth enough for averages
    search = BlockSearch(image, 12)
    values = image[place[0] : place[0] + 12, place[1] : place[1] + 12].reshape(1, 144, 4).copy()
    known = np.zeros((1, 12, 12), np.float32)
    known[:, :, :6] = 1
    known = known.reshape(1, 144)
    values *= known[..., None]
    order = np.argsort(search.coarse_cost(values, known), axis=1)[:, : search.shortlist].astype(np.int32)
    best, cost = search.refine(order, values, known)
    np.testing.assert_array_equal(best[0, cost[0].argmin()], place)
    assert cost.min() == 0
    moved = np.abs(best[0] - search.anchors[order[0]])
    assert moved.max() <= search.step // 2
