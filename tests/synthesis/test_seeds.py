"""Seed points: corners of the sample's own tiles, each among those that fit best what is there."""

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import blobs, holes
from texloom.errors import ExemplarError
from texloom.synthesis.seeds import plant

IMAGE = blobs(40).astype(np.float32) / np.float32(255)
PITCH = 8


def ranking(tiles: ndarray, known: ndarray, source: ndarray) -> ndarray:
    """Tiles (n, 2, 2, 2) in the order in which their corners fit the known ones of a slot."""
    cost = np.zeros(len(tiles))
    for place in np.argwhere(known):
        theirs = IMAGE[tiles[:, *place, 0], tiles[:, *place, 1]]
        cost += ((theirs - IMAGE[tuple(source[tuple(place)])]) ** 2).sum(1)
    return np.argsort(cost, kind="stable")


@pytest.mark.parametrize("grid", [(4, 5), (1, 6), (6, 1), (2, 2)], ids=str)
def test_every_slot_shows_one_of_the_five_tiles_that_fit_best(grid: tuple[int, int]) -> None:
    source = plant(IMAGE, PITCH, grid, seed=3)
    first = np.argwhere(np.ones((16, 16))) * 2  # tiles begin at a quarter of the pitch
    corner = np.argwhere(np.ones((2, 2))).reshape(2, 2, 2) * PITCH
    tiles = first[:, None, None] + corner
    known = np.zeros(grid, bool)
    for row in range(max(grid[0] - 1, 1)):
        for column in range(max(grid[1] - 1, 1)):
            around = slice(row, row + 2), slice(column, column + 2)
            there = known[around].copy()
            best = ranking(tiles, there, source[around])[: 5 if there.any() else None]
            height, width = there.shape
            same = (tiles[best][:, :height, :width] == source[around]).all(3) | there
            assert same.all((1, 2)).any()
            known[around] = True
    assert known.all()


def test_the_draw_is_among_the_best_and_follows_the_seed() -> None:
    one, again, other = (plant(IMAGE, PITCH, (6, 6), seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, again)
    assert (one != other).any(2).mean() > 0.5


def test_a_sample_that_repeats_gives_seeds_that_repeat() -> None:
    """Where the pitch is the period, all corners of a tile are alike, and so are all seeds."""
    tile = np.random.default_rng(0).random((8, 8, 3), np.float32)
    image = np.tile(tile, (4, 4, 1))
    source = plant(image, 8, (5, 7), seed=0)
    colours = image[source[..., 0], source[..., 1]]
    np.testing.assert_array_equal(colours, np.broadcast_to(colours[0, 0], colours.shape))


def test_masked_texels_are_not_planted() -> None:
    mask = holes(40)
    source = plant(IMAGE, PITCH, (9, 9), seed=0, usable=mask)
    assert mask[source[..., 0], source[..., 1]].all()


def test_one_seed_and_no_room() -> None:
    assert plant(IMAGE, PITCH, (1, 1), seed=0).shape == (1, 1, 2)
    assert (plant(IMAGE, 39, (2, 2), seed=0) == [[[0, 0], [0, 39]], [[39, 0], [39, 39]]]).all()
    with pytest.raises(ExemplarError, match="no tile 40 texels wide"):
        plant(IMAGE, 40, (2, 2), seed=0)
    with pytest.raises(ExemplarError, match="no tile 8 texels wide"):
        plant(IMAGE, PITCH, (2, 2), seed=0, usable=np.arange(40)[:, None] + np.zeros(40) > 35)
