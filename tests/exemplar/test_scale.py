"""Scale and period are known where the picture is drawn from them."""

import numpy as np
import pytest

from tests.data import DATA, needs_data
from texloom.exemplar.exemplar import from_array
from texloom.exemplar.regularity import NEAR_REGULAR, regularity
from texloom.exemplar.scale import dominant_scale, spectrum
from texloom.exemplar.suggest import structure
from texloom.io.stack import read_exemplar


def wave(rows: int, columns: int, *, period: float, degrees: float) -> np.ndarray:
    row, column = np.indices((rows, columns))
    along = np.cos(np.deg2rad(degrees)) * column + np.sin(np.deg2rad(degrees)) * row
    return (0.5 + 0.2 * np.cos(2 * np.pi * along / period))[..., None].astype(np.float32)


@pytest.mark.parametrize("degrees", [0, 90, 30])
@pytest.mark.parametrize("shape", [(96, 96), (80, 144)])
def test_a_wave_has_its_length_in_every_direction_and_shape(degrees: float, shape: tuple[int, int]) -> None:
    found = spectrum(wave(*shape, period=11.5, degrees=degrees))
    assert found.scale == pytest.approx(11.5, rel=0.03) and found.prominence > 10
    assert found.power.sum() == pytest.approx(1.0)


def test_light_that_falls_off_is_no_structure() -> None:
    image = wave(96, 96, period=9, degrees=20)
    image += np.linspace(0, 20, 96, dtype=np.float32)[:, None, None]
    assert spectrum(image).scale == pytest.approx(9, rel=0.03)


def test_what_is_masked_has_no_say() -> None:
    image = wave(96, 96, period=9, degrees=0)
    usable = np.ones((96, 96), bool)
    usable[60:] = False
    image[60:] = 30 * wave(36, 96, period=20, degrees=0)
    assert spectrum(image, usable).scale == pytest.approx(9, rel=0.03)
    assert spectrum(image).scale == pytest.approx(20, rel=0.1)


def test_twice_the_scale_fits_half_the_sample() -> None:
    """Also for pictures with no wave at all."""
    noise = np.random.default_rng(3).random((40, 64, 3), np.float32)
    for image in (noise, np.zeros_like(noise), wave(40, 64, period=30, degrees=0)):
        assert 5 <= spectrum(image).scale <= 10


def test_a_tiling_has_its_lattice() -> None:
    """A random cell, laid in rows that are shifted by half of it."""
    cell = np.random.default_rng(1).random((12, 20, 1), np.float32)
    rows = [np.roll(np.tile(cell, (1, 6, 1)), 10 * number, axis=1) for number in range(10)]
    found = regularity(np.concatenate(rows), 12.0)
    assert found.value > 0.9
    vectors = np.array(found.lattice)
    assert abs(np.linalg.det(vectors)) == pytest.approx(12 * 20)
    whole = np.linalg.solve(np.array([[12.0, 10.0], [0.0, 20.0]]).T, vectors.T)
    np.testing.assert_allclose(whole, np.round(whole), atol=1e-9)


def test_stripes_have_rows_only_and_noise_has_nothing() -> None:
    stripes = np.repeat(np.tile(np.random.default_rng(2).random((14, 1, 1), np.float32), (8, 1, 1)), 100, 1)
    found = regularity(stripes, 14.0)
    assert found.value > 0.9 and len(found.lattice) == 1
    assert found.lattice[0] == pytest.approx((14, 0), abs=1)  # every place along a stripe is as good
    noise = np.random.default_rng(3).random((96, 96, 3), np.float32)
    assert regularity(noise, spectrum(noise).scale).value < NEAR_REGULAR


def test_unusable_texels_do_not_hide_a_period() -> None:
    image = np.tile(np.random.default_rng(5).random((16, 16, 1), np.float32), (8, 8, 1))
    usable = np.random.default_rng(6).random((128, 128)) > 0.3
    found = regularity(np.where(usable[..., None], image, 9), 16.0, usable)
    assert found.value > 0.8 and abs(np.linalg.det(np.array(found.lattice))) == pytest.approx(256)


def test_a_patch_holds_a_cell() -> None:
    tiles = np.tile(np.random.default_rng(4).random((24, 24, 3), np.float32), (8, 8, 1))
    advice = structure(from_array(tiles)).suggestion
    assert 24 <= advice.patch <= 96 and advice.method == "patches"


@needs_data
@pytest.mark.parametrize(
    ("name", "least", "most", "vectors"),
    [
        ("bricks-red-128", 6, 8, 2),
        ("sand-ripples-256", 15, 20, 1),
        ("text-newsprint-256", 17, 20, 1),
        ("weave-wood-basket-192", 28, 36, 2),
        ("planks-stacked-192", 14, 17, 1),
        ("scales-green-cells-192", 13, 17, 2),
        ("gravel-grey-512", 18, 32, 0),
        ("pebbles-grey-242", 36, 52, 0),
        ("beans-192", 20, 32, 0),
        ("granite-white-128", 5, 30, 0),
    ],
)
def test_real_samples_are_as_the_eye_sees_them(name: str, least: float, most: float, vectors: int) -> None:
    exemplar = read_exemplar(DATA / "exemplars" / f"{name}.png")
    found = structure(exemplar)
    assert least <= found.spectrum.scale <= most
    assert found.spectrum.scale == dominant_scale(exemplar).scale
    periods = found.regularity
    assert (len(periods.lattice) if periods.value >= NEAR_REGULAR else 0) == vectors
