"""The two steps by turns: each lowers what it is to lower."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.synthesis.samples import exemplar
from texloom.arrays import in_fours
from texloom.domain.grid import Grid
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.join import join
from texloom.search import Exhaustive
from texloom.search.analysis import analyse
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.least_squares import LeastSquares, Stage, _expect, _maximize, fill_unknown, lay, stages
from texloom.synthesis.synthesize import synthesize

LEAST = 1e-6  # squared mismatch under which weights stop growing


@settings(max_examples=3, deadline=None)
@given(seed=st.integers(0, 999))
def test_neither_step_raises_its_energy(seed: int) -> None:
    """The E-step lowers the weighted sum for fixed matches; by turns they lower sum |X - Z|^1.2."""
    grid, width = Grid(16, 16, wrap=True), 8
    patches = lay(grid, width, seed)
    analysis = analyse(exemplar(24))
    sample = np.stack(np.divmod(np.arange(width**2), width), 1).astype(np.int32)
    vectors, index = analysis.index(Exhaustive(), 0, width, sample)
    appearance = in_fours(analysis.appearance[0])
    rng = np.random.default_rng(seed)
    canvas = Canvas.empty(grid.count, appearance.shape[2])
    canvas.colour[:], canvas.label[:] = rng.random(canvas.colour.shape), 0
    every = np.arange(width**2, dtype=np.int32)

    def mismatch(anchors: np.ndarray) -> np.ndarray:
        """Squared difference of every patch to its match, over all of its samples."""
        shown = appearance[anchors[:, 0, None] + sample[:, 0], anchors[:, 1, None] + sample[:, 1]]
        return ((canvas.colour[patches.sites[..., 0]] - shown) ** 2).sum((1, 2), dtype=np.float64)

    robust = []
    found, weight, _ = _maximize(canvas, patches, every, index, analysis)
    for _ in range(5):
        anchors = np.ascontiguousarray(vectors.anchors[found])
        before = (weight * mismatch(anchors)).sum()
        _expect(canvas, patches, anchors, weight, appearance, 1)
        assert (weight * mismatch(anchors)).sum() <= before * (1 + 1e-5)
        found, weight, cost = _maximize(canvas, patches, every, index, analysis)
        after = mismatch(vectors.anchors[found])
        assert (after <= mismatch(anchors) * (1 + 1e-5)).all()
        assert cost == pytest.approx(after.mean(), rel=1e-4)
        np.testing.assert_allclose(weight, np.maximum(after, LEAST) ** -0.4, rtol=1e-3)
        robust.append((np.maximum(after, LEAST) ** 0.6).sum())
    assert (np.diff(robust) <= 1e-5 * robust[0]).all()


def test_an_exemplar_that_is_its_own_output_is_a_fixed_point() -> None:
    """Patches matched where they lie show themselves again, at no cost."""
    grid, width = Grid(20, 20), 8
    analysis = analyse(exemplar(20))
    inside = [r * 20 + c for r in range(4, 17, 4) for c in range(4, 17, 4)]
    patches = grid.patches(np.array(inside, np.int32), width)
    sample = np.stack(np.divmod(np.arange(width**2), width), 1).astype(np.int32)
    vectors, index = analysis.index(Exhaustive(), 0, width, sample)
    appearance = in_fours(analysis.appearance[0])
    canvas = Canvas.empty(grid.count, appearance.shape[2])
    canvas.colour[:], canvas.label[:] = appearance.reshape(grid.count, -1), 0
    found, weight, cost = _maximize(canvas, patches, np.arange(width**2, dtype=np.int32), index, analysis)
    assert cost == 0
    at = np.array(inside)
    np.testing.assert_array_equal(vectors.anchors[found], np.stack([at // 20 - 4, at % 20 - 4], 1))
    _expect(canvas, patches, np.ascontiguousarray(vectors.anchors[found]), weight, appearance, 1)
    np.testing.assert_allclose(canvas.colour, appearance.reshape(grid.count, -1), atol=1e-5)


def test_the_schedule_of_the_paper() -> None:
    assert [(s.step, s.width) for s in stages()] == [(4, 8), (2, 16), (2, 8), (1, 32), (1, 16), (1, 8)]
    assert [stage.extent for stage in stages(40)] == [40, 40, 20, 40, 20, 10]


def test_energy_is_kept_for_every_iteration_and_says_why_it_stopped() -> None:
    short = LeastSquares(schedule=(Stage(1, 8),), iterations=3)
    result = synthesize(exemplar(24), Grid(20, 20), short)
    assert result.stopped == "iterations" and len(result.energy) == 3
    long = synthesize(exemplar(24), Grid(20, 20), LeastSquares(schedule=(Stage(1, 8),), iterations=200))
    assert long.stopped == "converged" and len(long.energy) < 200
    assert long.energy[-1] < long.energy[0]


def test_unknown_samples_take_the_mean_of_the_others() -> None:
    values = np.array([[[2.0], [0.0], [4.0]], [[0.0], [0.0], [0.0]]], np.float32)
    known = np.array([[1, 0, 1], [0, 0, 0]], np.float32)
    np.testing.assert_array_equal(fill_unknown(values, known)[..., 0], [[2, 3, 4], [0, 0, 0]])


def test_a_sample_smaller_than_the_stages_is_refused_by_its_own_size() -> None:
    with pytest.raises(ExemplarError, match="24x24.*32"):
        synthesize(exemplar(24), Grid(20, 20), LeastSquares())


@pytest.mark.parametrize("largest", [0, 4, 10, 33])
def test_stages_divide(largest: int) -> None:
    with pytest.raises(ParameterError, match=f"{largest}"):
        stages(largest)


def test_room_is_what_may_be_used_of_the_smallest_sample() -> None:
    """A large picture around little that may be used is refused by what may be used."""
    method, grid = LeastSquares(schedule=stages(32)), Grid(40, 40)
    mask = np.zeros((64, 64), bool)
    mask[:, :20] = True
    with pytest.raises(ExemplarError, match="64x64 texels, 20 across where its mask allows, but a patch needs 32x32"):
        synthesize(exemplar(64).with_mask(mask), grid, method)
    joined = join([exemplar(64), exemplar(24, seed=1)])
    with pytest.raises(ExemplarError, match="the smallest of 2 samples is 24 texels across where it is used"):
        synthesize(joined.exemplar, grid, method)
