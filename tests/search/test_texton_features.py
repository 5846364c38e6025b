"""What textons see: kernels by their formulas, and features equal to windows that are really built and turned."""

import numpy as np
import pytest

from tests import naive
from texloom.errors import ParameterError
from texloom.search.texton_banks import FilterBank, WindowBank
from texloom.search.texton_features import TextonFeatures

RNG = np.random.default_rng(3)
IMAGE = RNG.random((13, 17, 2), np.float32)
TURNS = [0.0, 0.3, np.pi / 2, np.pi, 4.0]


def turned_window(image: np.ndarray, row: int, column: int, width: int, turn: float) -> np.ndarray:
    """Values at p + exp(1j turn) d for all d of the window, row by row; the image mirrored at its border."""
    far = 3 * width
    padded = np.pad(image, ((far, far), (far, far), (0, 0)), mode="symmetric").astype(float)
    values = []
    for down in range(-(width // 2), width // 2 + 1):
        for across in range(-(width // 2), width // 2 + 1):
            at = (across + 1j * down) * np.exp(1j * turn)
            values.append(naive.bilinear(padded, row + far + at.imag, column + far + at.real))
    return np.array(values)


def described(bank: WindowBank | FilterBank, image: np.ndarray, turn: float, usable: np.ndarray | None = None):
    seen = TextonFeatures.of(image, bank, usable)
    return seen, seen.all(turn).reshape(*image.shape[:2], -1)


@pytest.mark.parametrize("turn", TURNS)
def test_a_turned_bank_sees_turned_windows(turn):
    seen, features = described(WindowBank(5), IMAGE, turn)
    offset = np.arange(-2, 3)
    weight = np.exp(-0.5 * (offset[:, None] ** 2 + offset**2) / (0.25 * 5) ** 2)
    factor = np.sqrt(weight / weight.sum()).reshape(-1, 1)
    for row, column in ((0, 0), (6, 8), (12, 16), (3, 16), (11, 1)):
        window = turned_window(IMAGE, row, column, 5, turn) * factor
        expected = (window.T.ravel() - seen.projection.mean) @ seen.projection.axes
        np.testing.assert_allclose(features[row, column], expected, atol=2e-6)


def test_quarter_turns_see_what_the_turned_image_shows():
    seen, features = described(WindowBank(7), IMAGE, np.pi / 2)
    clockwise = TextonFeatures(np.ascontiguousarray(np.rot90(IMAGE)), seen.bank, seen.projection)
    upright = clockwise.all(0.0).reshape(17, 13, -1)
    np.testing.assert_allclose(np.rot90(features), upright, atol=1e-6)


def test_window_distances_are_weighted_mean_squares():
    kernels = WindowBank(11).kernels(0.0)
    assert kernels.shape == (121, 11, 11)
    np.testing.assert_allclose((kernels**2).sum(), 1.0, rtol=1e-6)
    middle = np.array([kernels[k, k // 11, k % 11] for k in (60, 55)])
    assert middle[1] ** 2 / middle[0] ** 2 == pytest.approx(np.exp(-0.5 * (5 / 2.75) ** 2), rel=1e-5)


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_filters_are_correlated_with_the_image(turn):
    from scipy.ndimage import correlate

    bank = FilterBank()
    seen, features = described(bank, IMAGE, turn)
    responses = np.stack(
        [correlate(IMAGE[..., c].astype(float), k, mode="reflect") for c in (0, 1) for k in bank.kernels(turn)], axis=2
    )
    np.testing.assert_allclose(features, (responses - seen.projection.mean) @ seen.projection.axes, atol=2e-6)


def test_filters_are_the_48_of_leung_and_malik():
    kernels = FilterBank().kernels(0.0)
    assert kernels.shape == (48, 49, 49)
    np.testing.assert_allclose(np.abs(kernels).sum((1, 2)), 1.0, rtol=1e-4)
    np.testing.assert_allclose(kernels[:44].sum((1, 2)), 0.0, atol=1e-5)
    np.testing.assert_allclose(kernels[44:].sum((1, 2)), 1.0, rtol=1e-4)
    for scale in range(3):  # the first direction of each scale: an edge and a bar along the columns
        np.testing.assert_allclose(kernels[6 * scale, ::-1], -kernels[6 * scale], atol=1e-7)
        np.testing.assert_allclose(kernels[18 + 6 * scale, ::-1], kernels[18 + 6 * scale], atol=1e-7)
        down, across = (np.abs(kernels[18 + 6 * scale]).sum(axis) @ np.abs(np.arange(-24, 25)) for axis in (1, 0))
        assert across > 1.5 * down


def test_filters_a_sixth_of_a_half_turn_on_are_the_next_ones():
    still, turned = FilterBank().kernels(0.0), FilterBank().kernels(np.pi / 6)
    for first in range(0, 36, 6):
        np.testing.assert_allclose(turned[first : first + 5], still[first + 1 : first + 6], atol=1e-7)
    np.testing.assert_allclose(turned[36:], still[36:], atol=1e-7)


def test_masked_texels_are_never_seen():
    usable = np.ones(IMAGE.shape[:2], bool)
    usable[4:9, 5:] = False
    other = np.where(usable[..., None], IMAGE, RNG.random(IMAGE.shape, np.float32))
    for bank in (WindowBank(7), FilterBank()):
        np.testing.assert_array_equal(described(bank, IMAGE, 0.4, usable)[1], described(bank, other, 0.4, usable)[1])


@pytest.mark.parametrize("width", [1, 10, 33, -3])
def test_windows_are_odd_and_not_huge(width):
    with pytest.raises(ParameterError, match=f"window {width}: give an odd number"):
        WindowBank(width)
