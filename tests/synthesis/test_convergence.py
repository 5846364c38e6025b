"""Eq. 1 of Shin & Shin as it is printed, our mean of it, and when a run stops."""

from collections.abc import Iterator

import numpy as np
import pytest

from texloom.synthesis.canvas import Canvas
from texloom.synthesis.convergence import Convergence, relative_change

RNG = np.random.default_rng(0)


def test_the_sum_is_the_equation() -> None:
    before, after = RNG.random((2, 50, 4), np.float32)
    expected = sum(np.linalg.norm(b - a) / np.linalg.norm(a) for a, b in zip(before, after, strict=True))
    assert relative_change(before, after, "sum") == pytest.approx(expected, rel=1e-5)
    assert relative_change(before, after, "mean") == pytest.approx(expected / 50, rel=1e-5)


def test_black_that_changes_is_infinite_and_black_that_stays_is_nothing() -> None:
    before, after = np.zeros((2, 10, 4), np.float32)
    assert relative_change(before, after, "sum") == relative_change(before, after, "mean") == 0
    after[3, 0] = 0.5
    assert relative_change(before, after, "sum") == np.inf
    assert relative_change(before, after, "mean") == pytest.approx(0.5 * 255 / 10)


def steps(canvas: Canvas, changes: list[float], asked: list[int]) -> Iterator[float]:
    """Passes that move one site and change its colour by so much."""
    for number, change in enumerate(changes):
        asked.append(number)
        canvas.colour[0, 0] += change
        canvas.position[0, 1] += change > 0
        yield 10.0 - number


def grey() -> Canvas:
    canvas = Canvas.empty(4, 4)
    canvas.colour[:, 0] = 1.0
    return canvas


def test_a_run_ends_after_the_first_pass_that_changes_too_little() -> None:
    canvas, asked = grey(), []
    curve = Convergence("mean", 0.04)
    assert curve.follow(canvas, steps(canvas, [0.5, 0.3, 0.0, 0.9], asked), 10) == ((10.0, 9.0, 8.0), "settled")
    assert asked == [0, 1, 2]
    assert curve.curves["changed pixels"] == (1.0, 1.0, 0.0)
    assert curve.curves["MSE"] == pytest.approx((0.25 / 4, 0.09 / 4, 0.0))
    assert curve.curves["difference"] == pytest.approx((0.5 / 4, 0.3 / 1.5 / 4, 0.0))


@pytest.mark.parametrize("most", [0, 1, 3])
def test_a_run_takes_no_more_passes_than_it_may(most: int) -> None:
    canvas, asked = grey(), []
    energy, stopped = Convergence("sum", 0.0).follow(canvas, steps(canvas, [0.0] * 5, asked), most)
    assert (len(energy), len(asked), stopped) == (most, most, "passes")


def test_no_passes_no_curves() -> None:
    assert Convergence("mean", 0.01).curves == {}


def test_only_the_sites_that_may_change_are_looked_at():
    """One of ten pixels is grown, and changes: the mean is its own change, not a tenth."""
    canvas = Canvas.empty(10, 4)
    canvas.colour[:] = 0.5
    sites = np.arange(10) == 3

    def passes():
        canvas.colour[3] = 0.75
        yield 0.0

    curve = Convergence("mean", 0.0, sites)
    curve.follow(canvas, passes(), 1)
    assert curve.differences == pytest.approx([0.5])
