"""Pieces laid on surfaces by hand have the size they were given, by their sources and by what they show."""

import numpy as np
import pytest
from numpy import ndarray
from scipy.ndimage import map_coordinates

from tests.meshes import flat_square
from tests.rolled import rolled, turned, unrolled
from texloom.domain.surface import Surface
from texloom.field.direction import from_vectors
from texloom.metrics.surface_copying import apparent_sources, surface_copy_side
from texloom.sources import SourceMap

SIDE = 60  # texels


def _plane(*, symmetry: int = 1) -> Surface:
    """A square whose sites lie half a texel off those of a picture, columns along +x."""
    mesh = flat_square(SIDE, float(SIDE))
    along = np.tile([1.0, 0.0, 0.0], (len(mesh.vertices), 1))
    return Surface.build(mesh, from_vectors(mesh, symmetry, along), texel=1.0, spacing=np.inf)


def _places(surface: Surface) -> ndarray:
    """[row, column] of every site of the plane in a picture with a margin all around."""
    x, y = surface.refined.mesh.vertices[:, :2].T
    return np.stack([SIDE - y, x], axis=1) + 4.5


def _sources(position: ndarray, turn: ndarray | None = None, scale: ndarray | None = None) -> SourceMap:
    one = np.ones((len(position), 1), np.float32)
    parts = (None if part is None else part[:, None].astype(np.float32) for part in (turn, scale))
    return SourceMap(position[:, None].astype(np.float32), one, *parts)


def _sample(rows: int = 100, columns: int = 100) -> ndarray:
    """Smooth noise: no two windows alike, and readable between texels."""
    noise = np.random.default_rng(5).random((rows // 2, columns // 2, 3))
    place = np.indices((rows, columns)) / 2
    channels = [map_coordinates(channel, place, order=1, mode="nearest") for channel in np.moveaxis(noise, 2, 0)]
    return np.stack(channels, axis=2).astype(np.float32)


def _read(sample: ndarray, position: ndarray) -> ndarray:
    channels = [map_coordinates(channel, position.T, order=1, mode="nearest") for channel in np.moveaxis(sample, 2, 0)]
    return np.stack(channels, axis=1).astype(np.float32)


def _in_pieces(surface: Surface, count: int) -> tuple[ndarray, float]:
    """Places in the sample of upright strips that do not continue each other, and the side to be found."""
    place = _places(surface)
    strip = np.minimum((place[:, 1] - 4.5) * count // SIDE, count - 1).astype(int)
    area = np.bincount(strip, surface.area)
    shift = np.array([0, 17, 5, 23, 11, 29])[strip]
    return place + shift[:, None] * [1, 0], float(np.sqrt((area**2).sum() / area.sum()))


@pytest.mark.parametrize("count", [1, 2, 3, 5])
def test_strips_by_their_sources(count: int) -> None:
    surface = _plane()
    position, side = _in_pieces(surface, count)
    assert side == pytest.approx(SIDE / np.sqrt(count), rel=0.03)
    assert surface_copy_side(_sources(position), surface) == pytest.approx(side, rel=1e-5)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_strips_by_what_they_show(count: int) -> None:
    """But for the rim, where windows are cut short."""
    surface, sample = _plane(), _sample()
    position, _ = _in_pieces(surface, count)
    apparent = apparent_sources(sample, surface, _read(sample, position))
    whole = apparent.weight[:, 0] > 0
    assert 0.75 < whole.mean() < 0.85  # 54² of 60²
    apart = np.linalg.norm(apparent.position[:, 0] - position, axis=1)[whole]
    assert (apart < 1.0).mean() > 0.9
    assert surface_copy_side(apparent, surface) == pytest.approx((SIDE - 5) / np.sqrt(count), rel=0.05)


def test_noise_has_no_pieces() -> None:
    surface, random = _plane(), np.random.default_rng(3)
    position = random.uniform(5, 90, (surface.count, 2))
    assert surface_copy_side(_sources(position), surface) < 2.0
    shown = apparent_sources(_sample(), surface, random.random((surface.count, 3)).astype(np.float32))
    assert surface_copy_side(shown, surface) < 4.0


def test_a_drift_breaks_nothing_but_a_jump_does() -> None:
    surface = _plane()
    place = _places(surface)
    assert surface_copy_side(_sources(place * 1.3), surface) == pytest.approx(SIDE, rel=1e-4)
    assert surface_copy_side(_sources(place * 1.8), surface) < 2.0


def test_enlarged_sources_go_on_more_slowly() -> None:
    surface = _plane()
    place, four = _places(surface), np.full(surface.count, 4.0)
    assert surface_copy_side(_sources(place / 4, scale=four), surface) == pytest.approx(SIDE, rel=1e-4)
    assert surface_copy_side(_sources(place / 4), surface) < 2.0


def test_pieces_turned_against_each_other_are_two() -> None:
    """Where a source is so enlarged that all of it shows one texel, only its turn tells."""
    surface = _plane()
    left, large = _places(surface)[:, 1] < 4.5 + SIDE / 2, np.full(surface.count, 1e3)
    sources = _sources(np.zeros((surface.count, 2)), np.where(left, 0.0, 1.5), large)
    assert surface_copy_side(sources, surface) == pytest.approx(SIDE / np.sqrt(2), rel=0.03)


def test_sites_without_a_source_do_not_count() -> None:
    surface = _plane()
    sources = _sources(_places(surface))
    left = _places(surface)[:, 1] < 4.5 + SIDE / 2
    sources.weight[left] = 0.0
    assert surface_copy_side(sources, surface) == pytest.approx(SIDE / np.sqrt(2), rel=0.03)
    sources.weight[:] = 0.0
    assert surface_copy_side(sources, surface) == 0.0


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_frames_of_a_symmetric_field_break_nothing(order: int) -> None:
    """One picture around a cylinder is one piece, though frames change from one direction of the field to the next."""
    surface = rolled(order)
    position, turn = unrolled(surface), turned(surface)
    whole = float(np.sqrt(surface.area.sum()))
    assert surface_copy_side(_sources(position, turn), surface) == pytest.approx(whole, rel=1e-4)
    if np.ptp(turn) > 0.1:
        assert surface_copy_side(_sources(position), surface) < 0.9 * whole


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_what_is_shown_in_another_direction_is_found(order: int) -> None:
    surface, sample = rolled(order), _sample(30, 90)
    position = unrolled(surface) + [22.0, 45.0]
    apparent = apparent_sources(sample, surface, _read(sample, position))
    shown = apparent.weight[:, 0] > 0
    assert shown.mean() > 0.2  # the cylinder is ten texels high
    aligned = np.cos(apparent.turn[:, 0] - turned(surface)) > 0.9  # type: ignore[index]
    near = np.linalg.norm(apparent.position[:, 0] - position, axis=1) < 1.0
    assert (aligned & near)[shown].mean() > 0.9


def test_nothing_comes_from_where_the_sample_is_not_used() -> None:
    surface, sample = _plane(), _sample()
    usable = np.ones(sample.shape[:2], bool)
    usable[:, 40:] = False
    apparent = apparent_sources(sample, surface, _read(sample, _places(surface)), usable=usable)
    assert (apparent.position[apparent.weight[:, 0] > 0, 0, 1] < 40).all()
    nothing = apparent_sources(sample, surface, _read(sample, _places(surface)), usable=np.zeros_like(usable))
    assert nothing.count == surface.count
