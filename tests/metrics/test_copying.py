"""Known pieces copied by hand are found, at their exact size."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom.metrics.copying import copy_side, copy_side_of_sources
from texloom.sources import SourceMap


def _noise(seed: int, shape: tuple[int, int]) -> np.ndarray:
    """8-bit noise, as float, with no two patches alike."""
    return np.random.default_rng(seed).integers(0, 256, (*shape, 3)).astype(np.float32) / 255.0


def test_naive_tiling_copies_whole_tiles() -> None:
    sample = _noise(1, (24, 24))
    # All patches inside the 4 tiles: 18² each; patches across borders are not in the sample.
    assert copy_side(sample, np.tile(sample, (2, 2, 1))) == pytest.approx(24.0)


def test_nothing_copied() -> None:
    assert copy_side(_noise(1, (24, 24)), _noise(2, (30, 30))) == 0.0


@given(st.integers(7, 20), st.integers(7, 20), st.integers(0, 9))
def test_one_pasted_block(rows: int, columns: int, seed: int) -> None:
    sample, result = _noise(3, (24, 26)), _noise(4, (30, 31))
    random = np.random.default_rng(seed)
    row, column = random.integers(0, 24 - rows + 1), random.integers(0, 26 - columns + 1)
    result[5 : 5 + rows, 8 : 8 + columns] = sample[row : row + rows, column : column + columns]
    assert copy_side(sample, result) == pytest.approx(np.sqrt((rows - 6) * (columns - 6)) + 6)


def test_two_blocks_weigh_by_area() -> None:
    sample, result = _noise(5, (40, 40)), _noise(6, (40, 60))
    result[:30, :30] = sample[:30, :30]
    result[:16, 40:56] = sample[20:36, 20:36]
    large, small = 24**2, 10**2
    assert copy_side(sample, result) == pytest.approx(np.sqrt((large**2 + small**2) / (large + small)) + 6)


def test_a_piece_that_fits_in_many_places_is_one_piece() -> None:
    """Stripes that repeat every 8 rows fit at many offsets; a coherent copy is still one piece."""
    stripe = np.tile(_noise(7, (8, 1)), (4, 32, 1))
    assert copy_side(stripe, stripe) == pytest.approx(32.0)


def test_a_copy_off_by_rounding_still_counts_once_one_patch_is_known() -> None:
    sample = _noise(8, (30, 30))
    off = np.random.default_rng(9).integers(-1, 2, sample.shape) / np.float32(255.0)
    result = np.clip(sample + off, 0, 1).astype(np.float32)
    seeds = (np.array([[4, 5]]), np.array([[4, 5]]))
    assert copy_side(sample, result, seeds=seeds) == pytest.approx(30.0)
    assert copy_side(sample, np.clip(sample + 3 * off, 0, 1).astype(np.float32), seeds=seeds) == 0.0


def test_a_wrong_seed_plants_nothing() -> None:
    sample, result = _noise(1, (24, 24)), _noise(2, (30, 30))
    assert copy_side(sample, result, seeds=(np.array([[0, 0]]), np.array([[3, 3]]))) == 0.0


def test_from_sources() -> None:
    shape = (12, 20)
    position = np.stack(np.indices(shape), axis=-1).astype(np.float32)
    position[:, 10:] += 5.0  # two halves from different places
    weight = np.ones((shape[0] * shape[1], 1), np.float32)
    sources = SourceMap(position.reshape(-1, 1, 2), weight)
    assert copy_side_of_sources(sources, shape) == pytest.approx(np.sqrt(120.0))


def test_blended_and_turned_sources_are_no_copies() -> None:
    shape = (8, 8)
    position = np.stack(np.indices(shape), axis=-1).reshape(-1, 1, 2).astype(np.float32)
    half = np.full((64, 2), 0.5, np.float32)
    assert copy_side_of_sources(SourceMap(np.repeat(position, 2, axis=1), half), shape) == 0.0
    turn = np.full((64, 1), 0.1, np.float32)
    assert copy_side_of_sources(SourceMap(position, np.ones((64, 1), np.float32), turn=turn), shape) == 0.0
