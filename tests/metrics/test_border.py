"""How visible a hole's border is."""

import numpy as np
import pytest

from texloom.metrics.border import border_step


def hole() -> np.ndarray:
    inside = np.zeros((12, 12), bool)
    inside[3:9, 2:8] = True
    return inside


def test_a_ramp_has_no_border() -> None:
    ramp = np.repeat(np.arange(12)[:, None, None] + np.arange(12)[None, :, None], 3, 2)
    assert border_step(ramp, hole()) == pytest.approx(1)


def test_a_step_at_the_border_is_counted_against_steps_inside() -> None:
    ramp = np.arange(12)[:, None, None] + np.arange(12)[None, :, None]
    lifted = ramp + 1000 * hole()[..., None]
    assert border_step(lifted, hole()) == pytest.approx(1000)


def test_without_a_border_or_anything_inside_there_is_no_number() -> None:
    assert np.isnan(border_step(np.ones((12, 12, 1)), hole()))
    assert np.isnan(border_step(np.random.default_rng(0).random((12, 12, 1)), np.ones((12, 12), bool)))
