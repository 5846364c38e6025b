"""Components of windows against the windows themselves, cut out and multiplied."""

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import blobs, holes
from texloom.errors import ExemplarError
from texloom.exemplar.windows import Windows

IMAGE = blobs(24).astype(np.float32) / np.float32(255)


def explicit(values: ndarray, axes: ndarray, *, wrap: bool) -> ndarray:
    """Components of the window around every texel, 0 outside a plane."""
    reach = axes.shape[0] // 2
    pad = ((reach, reach), (reach, reach), (0, 0))
    padded = np.pad(values, pad, mode="wrap") if wrap else np.pad(values, pad)
    windows = np.lib.stride_tricks.sliding_window_view(padded, axes.shape[:2], axis=(0, 1))
    return np.einsum("rckij,ijkd->rcd", windows.astype(float), axes)


@pytest.mark.parametrize("reach", [1, 3, 8])
def test_vectors_are_the_windows_along_the_axes(reach: int) -> None:
    windows = Windows.of(IMAGE, reach, 8)
    assert len(windows.centre) == (24 - 2 * reach) ** 2
    for index in range(0, len(windows.centre), 7):
        row, column = windows.centre[index]
        assert windows.candidate_at[row, column] == index
        window = IMAGE[row - reach : row + reach + 1, column - reach : column + reach + 1]
        expected = np.tensordot(window - windows.mean, windows.axes, 3)
        np.testing.assert_allclose(windows.vectors[index], expected, atol=2e-4)
    assert (windows.candidate_at >= 0).sum() == len(windows.centre)


def test_axes_are_orthonormal_and_the_variance_is_theirs() -> None:
    windows = Windows.of(IMAGE, 3, 8)
    flat = windows.axes.reshape(-1, 8)
    np.testing.assert_allclose(flat.T @ flat, np.eye(8), atol=1e-4)
    np.testing.assert_allclose(windows.vectors.mean(0), 0, atol=1e-3)  # all windows were looked at
    np.testing.assert_allclose(windows.vectors.var(0), windows.variance, rtol=1e-3)
    whole = np.lib.stride_tricks.sliding_window_view(IMAGE, (7, 7), axis=(0, 1)).reshape(-1, flat.shape[0])
    total = whole.var(0, dtype=float).sum()
    assert windows.noise == pytest.approx((total - windows.variance.sum()) / flat.shape[0], rel=1e-2)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
@pytest.mark.parametrize("shape", [(17, 20), (9, 9), (4, 30), (2, 3), (1, 1)], ids=str)
def test_lines_add_up_to_the_whole_projection(axis: int, wrap: bool, shape: tuple[int, int]) -> None:
    """The last outputs are narrower than a window: on a torus a window sees their lines more than once."""
    windows = Windows.of(IMAGE, 4, 8)
    values = np.random.default_rng(0).random((*shape, 3), np.float32)
    total = np.zeros((*shape, 8), np.float32)
    for at in range(shape[axis]):
        windows.add_line(total, values[at] if axis == 0 else values[:, at], at, axis=axis, wrap=wrap)
    np.testing.assert_allclose(total, explicit(values, windows.axes, wrap=wrap), atol=1e-4)


def test_windows_keep_out_of_the_mask() -> None:
    mask = holes(24)
    windows = Windows.of(IMAGE, 2, 4, mask)
    whole = [(r, c) for r in range(2, 22) for c in range(2, 22) if mask[r - 2 : r + 3, c - 2 : c + 3].all()]
    np.testing.assert_array_equal(windows.centre, whole)
    np.testing.assert_array_equal(np.argwhere(windows.candidate_at >= 0), whole)


def test_the_number_of_axes_is_rounded_up_to_fours() -> None:
    windows = Windows.of(IMAGE, 2, 6)
    assert windows.axes.shape == (5, 5, 3, 8) and windows.variance.shape == (8,)
    assert not windows.axes[..., 6:].any() and not windows.vectors[:, 6:].any() and (windows.variance[:6] > 0).all()


def test_a_single_window_and_none() -> None:
    one = Windows.of(np.ascontiguousarray(IMAGE[:9, :9]), 4, 8)
    np.testing.assert_array_equal(one.centre, [(4, 4)])
    np.testing.assert_allclose(one.vectors, 0, atol=1e-4)
    with pytest.raises(ExemplarError, match="no 9x9 window"):
        Windows.of(np.ascontiguousarray(IMAGE[:9, :8]), 4, 8)
    with pytest.raises(ExemplarError, match="no 5x5 window"):
        Windows.of(IMAGE, 2, 8, np.indices((24, 24)).sum(0) % 4 > 0)
