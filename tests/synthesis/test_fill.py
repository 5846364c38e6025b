"""Filling: surroundings stay, holes show nothing of themselves, and what repeats is continued exactly."""

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import blobs, exemplar
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar, Map, from_array
from texloom.output.filled import filled_maps
from texloom.output.gather import gather_images, identity_sources
from texloom.output.image import stored
from texloom.synthesis.fill import fill
from texloom.synthesis.patches import PatchSampling


def square(shape: tuple[int, int] = (48, 48), side: int = 14, at: tuple[int, int] = (15, 20)) -> ndarray:
    hole = np.zeros(shape, bool)
    hole[at[0] : at[0] + side, at[1] : at[1] + side] = True
    return hole


def waves(size: int = 64, period: int = 16) -> ndarray:
    row, column = np.mgrid[:size, :size] * 2 * np.pi / period
    return np.stack([127 + 60 * np.sin(row) + 60 * np.cos(column), 127 + 100 * np.sin(row + column), row * 0], 2)


def specks() -> ndarray:
    hole = np.zeros((48, 48), bool)
    hole[::5, ::7] = hole[12, 3:30] = True
    return hole


HOLES = {
    "square": square(),
    "corner": square(at=(0, 34)),
    "border": square(side=48, at=(30, 0)),
    "specks": specks(),
    "all but a corner": ~square(side=30, at=(0, 0)),
}


@pytest.mark.parametrize("name", HOLES)
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_surroundings_stay_bit_by_bit(name: str, dtype: type) -> None:
    values = np.random.default_rng(0).random((48, 48, 3))
    values = values.astype(np.float32) if dtype is np.float32 else (values * np.iinfo(dtype).max).astype(dtype)
    picture, hole = from_array(values), HOLES[name]
    filled = fill(picture, hole)
    maps = filled_maps(filled)["basecolor"]
    np.testing.assert_array_equal(stored(maps, maps.bits)[~hole], values[~hole])
    gathered = gather_images(filled.result.sources, filled.exemplar, rows=48, columns=48)["basecolor"]
    np.testing.assert_array_equal(gathered.image, maps.image)
    position = filled.result.sources.position[:, 0].reshape(48, 48, 2)
    texel = np.rint(position[hole]).astype(int)
    assert not hole[texel[:, 0], texel[:, 1]].any()  # nothing of the hole itself is shown


def test_what_was_in_the_hole_does_not_matter() -> None:
    hole, values = square(), blobs(48)
    painted = values.copy()
    painted[hole] = (255, 0, 255)
    first, second = fill(from_array(values), hole, seed=4), fill(from_array(painted), hole, seed=4)
    np.testing.assert_array_equal(first.result.sources.position, second.result.sources.position)


@pytest.mark.parametrize("wrap", [False, True])
def test_what_repeats_is_continued(wrap: bool) -> None:
    values = waves().astype(np.uint8)
    hole = square((64, 64), 26, (17, 21)) if not wrap else np.roll(square((64, 64), 26, (17, 21)), (32, 30), (0, 1))
    maps = filled_maps(fill(from_array(values), hole, wrap=wrap))["basecolor"]
    assert np.abs(stored(maps, 8).astype(int) - values).max() <= 2


def test_a_tile_is_continued_over_its_borders() -> None:
    hole = np.zeros((64, 64), bool)
    hole[:, 46:] = True
    step = []
    for wrap in (False, True):
        shown = stored(filled_maps(fill(from_array(blobs(64)), hole, wrap=wrap))["basecolor"], 8).astype(int)
        step.append(np.abs(shown[:, 63] - shown[:, 0]).mean())
    assert step[1] < 0.8 * step[0]


def test_all_maps_of_a_stack_are_filled_alike() -> None:
    colour = exemplar(48)
    row, column = np.mgrid[:48, :48] / np.float32(47)
    place = {name: Map(axis[..., None].astype(np.float32), "data", 32) for name, axis in (("a", row), ("b", column))}
    picture = Exemplar(dict(colour.maps) | place)
    filled = fill(picture, square())
    maps = filled_maps(filled)
    shown = np.rint(np.concatenate([maps["a"].image, maps["b"].image], 2) * 47).astype(int)
    np.testing.assert_array_equal(maps["basecolor"].image, colour.maps["basecolor"].image[shown[..., 0], shown[..., 1]])


def test_a_large_picture_is_looked_at_around_its_hole_only() -> None:
    values = blobs(400)
    values[:, :100] = 255 - values[:, :100]
    hole = square((400, 400), 12, (60, 350))
    near = fill(from_array(values), hole).result.sources.position[:, 0].reshape(400, 400, 2)[hole]
    assert near[:, 1].min() >= 350 - 128 and near[:, 0].max() <= 72 + 128


def test_a_sample_fills_in_place_of_the_picture() -> None:
    grey = np.full((40, 40), 90, np.uint8)
    sample = from_array(blobs(48))
    hole = square((40, 40))
    filled = fill(from_array(grey), hole, sample=sample)
    maps = filled_maps(filled)["basecolor"]
    shown = stored(maps, 8)
    assert shown.shape == (40, 40, 3) and (shown[~hole] == 90).all()
    known = {tuple(texel) for texel in blobs(48).reshape(-1, 3)}
    assert all(tuple(texel) in known for texel in shown[hole])
    whole = filled_maps(fill(from_array(grey), np.ones((40, 40), bool), sample=sample))["basecolor"]
    assert all(tuple(texel) in known for texel in stored(whole, 8).reshape(-1, 3))


def test_other_methods_and_seeds() -> None:
    picture, hole = from_array(blobs(64)), square((64, 64), 30)
    plain = fill(picture, hole, method=PatchSampling())
    assert plain.result.energy == ()
    again, other = fill(picture, hole, seed=0), fill(picture, hole, seed=5)
    np.testing.assert_array_equal(again.result.sources.position, fill(picture, hole).result.sources.position)
    assert (again.result.sources.position != other.result.sources.position).any()


def test_nothing_to_fill_is_the_picture() -> None:
    filled = fill(exemplar(32), np.zeros((32, 32), bool))
    np.testing.assert_array_equal(filled.result.sources.position, identity_sources(32, 32).position)
    assert filled.result.stopped == "nothing to fill"


def test_what_cannot_be_filled_says_so() -> None:
    picture = exemplar(32)
    with pytest.raises(ExemplarError, match="all 1024 texels .* give a sample"):
        fill(picture, np.ones((32, 32), bool))
    with pytest.raises(ExemplarError, match="no block of 8x8 texels"):
        fill(picture, ~square((32, 32), 6))
    with pytest.raises(ParameterError, match="48x48 texels, but the picture is 32x32"):
        fill(picture, square())
    with pytest.raises(ParameterError, match="sample lacks normal"):
        fill(exemplar(32, channels=6), square((32, 32)), sample=picture)
