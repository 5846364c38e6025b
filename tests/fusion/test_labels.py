"""Maps become labels to the texel; what is drawn softly, noisily or by chance becomes clean regions."""

import numpy as np
import pytest
from numpy import ndarray
from PIL import Image
from scipy.ndimage import label

from tests.data import DATA, needs_data
from texloom.errors import ParameterError
from texloom.fusion import labels

RED, BLUE, GREEN, PURPLE = (1.0, 0, 0), (0, 0, 1.0), (0, 1.0, 0), (0.5, 0, 0.5)


def disc(size: int, radius: float) -> ndarray:
    row, column = np.mgrid[:size, :size] - (size - 1) / 2
    return np.hypot(row, column) < radius


def painted(labelled: ndarray, *colours: tuple[float, ...]) -> ndarray:
    return np.array(colours)[labelled]


def smoothed(size: int, radius: float) -> ndarray:
    """A red disc on blue, drawn eight times as large and averaged."""
    large = painted(np.where(disc(8 * size, 8 * radius), 0, 1), RED, BLUE)
    return large.reshape(size, 8, size, 8, 3).mean((1, 3))


def least_part(labelled: ndarray) -> int:
    """Texels of the smallest connected region."""
    parts = [label(labelled == value)[0] for value in np.unique(labelled)]
    return min(int(np.bincount(part.ravel())[1:].min()) for part in parts)


@pytest.mark.parametrize("colours", [(RED, BLUE), ((0, 0, 0), (1, 1, 1)), ((0.9, 0.2, 0.1), (0.1, 0.6, 0.2))])
def test_a_crisp_map_is_taken_to_the_texel(colours: tuple) -> None:
    wanted = np.where(disc(40, 12), 0, 1)
    wanted[2:5, 3:30] = 0  # a stroke of 3 texels
    found = labels.from_picture(painted(wanted, *colours), 2)
    np.testing.assert_array_equal(found.labels, wanted)
    np.testing.assert_allclose(found.palette, colours, atol=1e-9)


def test_colours_keep_their_order_wherever_they_lie() -> None:
    wanted = np.arange(36 * 36).reshape(36, 36) // 36 // 12
    for turn in range(3):
        found = labels.from_picture(painted((wanted + turn) % 3, RED, BLUE, GREEN), 3)
        np.testing.assert_array_equal(found.labels, (wanted + turn) % 3)


@pytest.mark.parametrize("palette", [None, (RED, PURPLE, BLUE)], ids=["found", "with purple"])
def test_a_smoothed_border_makes_no_third_region(palette: tuple | None) -> None:
    given = None if palette is None else np.array(palette)
    found = labels.from_picture(smoothed(48, 15), 2 if palette is None else 3, given)
    last = len(found.palette) - 1
    assert set(np.unique(found.labels)) == {0, last}
    assert np.mean((found.labels == 0) == disc(48, 15)) > 0.985
    assert least_part(found.labels) >= 9


def test_a_photographed_map_has_no_specks() -> None:
    wanted = np.where(disc(64, 20), 0, 1)
    noise = np.random.default_rng(0).normal(0, 0.25, (64, 64, 3))
    found = labels.from_picture(np.clip(painted(wanted, RED, BLUE) + noise, 0, 1), 2)
    assert np.mean(found.labels == wanted) > 0.99
    assert least_part(found.labels) >= 9


def test_slivers_fall_to_what_is_beside_them() -> None:
    strips = np.zeros((20, 20), np.int32)
    strips[:, 8:10] = 1
    strips[:, 14:17] = 2
    cleaned = labels.without_slivers(strips)
    np.testing.assert_array_equal(cleaned, np.where(strips == 1, 0, strips))
    np.testing.assert_array_equal(labels.without_slivers(cleaned), cleaned)
    stripes = np.arange(16)[None].repeat(5, 0).astype(np.int32) % 2
    np.testing.assert_array_equal(labels.without_slivers(stripes), stripes)  # nothing thick to fall to


def test_too_few_colours_are_refused() -> None:
    picture = painted(np.where(disc(20, 6), 0, 1), RED, BLUE)
    with pytest.raises(ParameterError, match="has 2 colours, but there are 3 samples"):
        labels.from_picture(picture, 3)
    with pytest.raises(ParameterError, match="has 2 colours, but there are 3 samples"):
        labels.from_picture(smoothed(40, 12), 3)  # mixed colours along a border are none of their own
    with pytest.raises(ParameterError, match="palette: 3, samples: 2"):
        labels.from_picture(picture, 2, np.eye(3))


def test_resizing_by_whole_factors_repeats_and_thins() -> None:
    small = np.random.default_rng(3).integers(0, 3, (5, 7)).astype(np.int32)
    large = labels.resized(small, 15, 21)
    np.testing.assert_array_equal(large, np.kron(small, np.ones((3, 3), np.int32)))
    np.testing.assert_array_equal(labels.resized(large, 5, 7), small)


def test_the_fading_of_the_paper() -> None:
    chance = labels.fading(200, 3)
    np.testing.assert_allclose(chance[[0, 80, 160], 0], [0, 1 - np.exp(-0.5), 1 - np.exp(-2)])
    np.testing.assert_array_equal(labels.fading(200, 3, sigma=80), chance)


@pytest.mark.parametrize("wrap", [False, True])
def test_discs_cover_all_by_their_chance(wrap: bool) -> None:
    for chance in (0.0, 1.0):
        np.testing.assert_array_equal(labels.discs(np.full((30, 50), chance), (4, 3), wrap=wrap), chance)
    half = labels.discs(np.full((120, 120), 0.5), (5, 5), wrap=wrap, seed=2)
    assert 0.4 < half.mean() < 0.6
    np.testing.assert_array_equal(labels.discs(np.full((120, 120), 0.5), (5, 5), wrap=wrap, seed=2), half)
    rows = labels.discs(labels.fading(200, 200), (6, 6), wrap=False).mean(1)
    np.testing.assert_allclose(rows, labels.fading(200, 1)[:, 0], atol=0.4)
    assert abs(rows.mean() - labels.fading(200, 1).mean()) < 0.1


def test_discs_have_the_radii_of_their_samples() -> None:
    """Where one kind is rare, its discs lie whole."""
    rare = labels.discs(np.full((300, 300), 0.02), (4, 9), seed=1)
    parts, _ = label(rare)
    largest = np.bincount(parts.ravel())[1:].max()
    assert largest >= 0.8 * np.pi * 9**2


@needs_data
@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("three-colour-blobs-512", 3),
        ("three-colour-sectors-512", 3),
        ("three-colour-palette-256", 3),
        ("two-colour-letters-antialiased-512", 2),
        ("two-colour-soft-256", 2),
    ],
)
def test_real_maps(name: str, count: int) -> None:
    picture = np.asarray(Image.open(DATA / "fusion" / f"{name}.png").convert("RGB")) / 255
    found = labels.from_picture(picture, count)
    assert least_part(found.labels) >= 9
    pure = np.abs(picture[:, :, None] - found.palette).max(3) < 0.01
    kept = found.labels[pure.any(2)] == pure.argmax(2)[pure.any(2)]
    assert kept.mean() > 0.999
