"""The scores of a result against its sample."""

from dataclasses import astuple

import numpy as np
import pytest

from tests.data import DATA, needs_data
from texloom.errors import ParameterError
from texloom.metrics.score import fewer, grid_places, score


def _noise(seed: int, shape: tuple[int, ...] = (32, 32, 3)) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 256, shape).astype(np.uint8)


def test_a_sample_is_itself() -> None:
    scores = score(_noise(1), _noise(1))
    assert (scores.swd, scores.coherence, scores.completeness) == (0.0, 0.0, 0.0)
    assert scores.copy == pytest.approx(32.0)


def test_what_is_left_out_shows_in_completeness_only() -> None:
    sample = _noise(2, (40, 20, 3))
    scores = score(sample, sample[:20], queries=None)
    assert scores.coherence == 0.0
    assert scores.completeness > 10.0


def test_what_is_made_up_shows_in_coherence_only() -> None:
    sample = _noise(3, (40, 20, 3))
    scores = score(sample[:20], sample, queries=None)
    assert scores.completeness == 0.0
    assert scores.coherence > 10.0


def test_coherence_is_the_mean_rms_to_the_nearest_patch() -> None:
    sample, result = _noise(4, (14, 15, 1)), _noise(5, (16, 13, 1))

    def patches(image: np.ndarray) -> np.ndarray:
        rows, columns = image.shape[0] - 6, image.shape[1] - 6
        return np.array([image[r : r + 7, c : c + 7].ravel() for r in range(rows) for c in range(columns)], np.float64)

    rms = np.sqrt(np.square(patches(result)[:, None] - patches(sample)).mean(-1))
    scores = score(sample, result, queries=None)
    assert scores.coherence == pytest.approx(rms.min(1).mean(), rel=1e-4)
    assert scores.completeness == pytest.approx(rms.min(0).mean(), rel=1e-4)


def test_all_scores_but_copy_grow_with_noise() -> None:
    sample = (_noise(6, (32, 32, 1)) // 4 + 96).astype(np.uint8)
    random = np.random.default_rng(7)
    noise = random.standard_normal(sample.shape)
    rows = [score(sample, np.clip(sample + amount * noise, 0, 255).astype(np.uint8)) for amount in (0, 4, 16, 48)]
    for name in ("swd", "coherence", "completeness"):
        values = [getattr(row, name) for row in rows]
        assert values == sorted(values) and values[0] < values[-1]
    assert rows[0].copy == 32.0 and rows[-1].copy == 0.0


def test_bytes_shorts_and_floats_score_alike() -> None:
    sample, result = _noise(8, (20, 20, 3)), _noise(9, (20, 20, 3))
    as_bytes = astuple(score(sample, result))
    as_shorts = astuple(score(sample.astype(np.uint16) * 257, result.astype(np.uint16) * 257))
    as_floats = astuple(score(sample / np.float32(255.0), result / np.float32(255.0)))
    np.testing.assert_allclose(as_shorts, as_bytes, rtol=1e-5)
    np.testing.assert_allclose(as_floats, as_bytes, rtol=1e-5)


def test_grey_maps_need_no_channel_axis() -> None:
    grey = _noise(10, (20, 20))
    assert score(grey, grey[..., None]).coherence == 0.0


def test_the_same_twice() -> None:
    sample, result = _noise(11, (20, 20, 3)), _noise(12, (20, 20, 3))
    assert score(sample, result) == score(sample, result)


def test_places_are_spread_evenly() -> None:
    places = grid_places(np.zeros((46, 106, 3), np.float32), 160)
    assert len(np.unique(places, axis=0)) == len(places) == pytest.approx(160, rel=0.1)
    np.testing.assert_allclose(places.mean(0), [19.5, 49.5], atol=0.6)
    assert len(grid_places(np.zeros((10, 11, 3), np.float32), None)) == 4 * 5


def test_few_queries_estimate_all() -> None:
    sample, result = _noise(13, (36, 36, 1)), _noise(14, (50, 50, 1))
    all_of_them, some = score(sample, result, queries=None), score(sample, result, queries=400)
    assert some.coherence == pytest.approx(all_of_them.coherence, rel=0.02)
    assert some.completeness == pytest.approx(all_of_them.completeness, rel=0.02)


@pytest.mark.parametrize("shape", [(6, 30, 3), (30,), (2, 3, 4, 5)])
def test_what_is_no_picture_is_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ParameterError, match="7×7"):
        score(_noise(1), np.zeros(shape, np.uint8))


def test_other_channels_are_refused() -> None:
    with pytest.raises(ParameterError, match="3 channels and the result 1"):
        score(_noise(1), _noise(1, (20, 20, 1)))


@needs_data
def test_a_tiled_photograph_wins_all_but_copy_and_seam() -> None:
    from PIL import Image

    with Image.open(DATA / "exemplars" / "cells-green-161-64.png") as file:
        sample = np.asarray(file.convert("RGB"))
    scores = score(sample, np.tile(sample, (2, 2, 1)))
    # Patches across the tiles' borders are not in the sample, all others are.
    assert scores.completeness < 1e-3 and 0.0 < scores.coherence < 6.0
    assert scores.copy == pytest.approx(64.0, abs=3.0)
    assert scores.seam > 1.0


def test_what_may_not_be_used_of_a_sample_does_not_count() -> None:
    """Beside the sample lies something else; masked, the scores are those of the sample alone."""
    sample, result = _noise(6, (24, 28, 3)), _noise(7, (26, 20, 3))
    beside = np.concatenate([sample, _noise(8, (24, 12, 3)) // 2], axis=1)
    usable = np.arange(40)[None].repeat(24, 0) < 28
    alone, masked, whole = (
        score(sample, result, queries=None),
        score(beside, result, usable=usable, queries=None),
        score(beside, result, queries=None),
    )
    assert astuple(masked) == pytest.approx(astuple(alone), rel=1e-5)
    assert whole.swd > 1.3 * alone.swd
    few = score(beside, result, usable=usable, queries=60)
    assert few.completeness == pytest.approx(alone.completeness, rel=0.03)
    with pytest.raises(ParameterError, match="no 7x7 patch of the sample is usable"):
        score(beside, result, usable=usable & (np.arange(24)[:, None] < 6))


def test_of_large_pictures_a_part_is_enough() -> None:
    row, column = np.mgrid[:60, :72]
    sample = (128 + 50 * np.sin(row / 7) + 50 * np.sin(column / 5 + row / 30)).astype(np.uint8)[..., None]
    result = np.clip(sample[::-1] * 0.8 + 10 + _noise(9, sample.shape) // 16, 0, 255).astype(np.uint8)
    every, some = score(sample, result, queries=None), score(sample, result, most=900)
    assert (some.swd, some.coherence, some.completeness) == pytest.approx(
        (every.swd, every.coherence, every.completeness), rel=0.05
    )
    assert astuple(score(sample, result, most=10**6)) == astuple(score(sample, result))
    assert [fewer(2500, patches, 1000) for patches in (1000, 2000, 10**6)] == [2500, 1250, 800]
    assert fewer(None, 10**6, 1000) is None and fewer(500, 10**6, 1000) == 500
