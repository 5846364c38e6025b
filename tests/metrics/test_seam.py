"""Seams whose ratio is known by hand."""

import numpy as np
import pytest

from texloom.metrics.seam import row_steps, seam_ratio


def _ramp(rows: int, columns: int) -> np.ndarray:
    """Rises by one unit a column: the step across the border is ``columns − 1`` units."""
    return np.tile(np.arange(columns, dtype=np.float32), (rows, 1))[..., None]


def test_a_ramp_jumps_by_its_whole_height() -> None:
    assert seam_ratio(_ramp(9, 20)) == pytest.approx(19.0)
    assert seam_ratio(_ramp(9, 20).swapaxes(0, 1)) == pytest.approx(19.0)


def test_a_whole_period_has_no_seam() -> None:
    wave = np.sin(np.arange(64) * 2 * np.pi / 64)[None, :, None].repeat(16, 0).astype(np.float32)
    assert seam_ratio(wave) == pytest.approx(1.0, abs=1e-2)


def test_the_worse_axis_decides() -> None:
    image = _ramp(30, 30) + np.sin(np.arange(30) * 2 * np.pi / 30)[:, None, None].astype(np.float32)
    assert seam_ratio(image) == pytest.approx(29.0, rel=1e-3)


def test_flat_pictures_tile() -> None:
    assert seam_ratio(np.full((8, 8, 3), 0.3, np.float32)) == 0.0


def test_one_row_steps() -> None:
    image = np.array([0.0, 0.5, 0.25], np.float32)[:, None, None].repeat(4, 1)
    np.testing.assert_allclose(row_steps(image), [0.5, 0.25])


def test_only_the_last_percent_of_steps_may_be_larger() -> None:
    """One sharp inner edge among hundreds does not excuse a sharp border."""
    image = np.random.default_rng(0).random((400, 40, 1)).astype(np.float32) * 0.01
    image[200:] += 1.0
    assert seam_ratio(image) > 20.0
