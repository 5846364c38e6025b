"""Belts follow borders on any domain, and belt samples show both textures along a closed line."""

import numpy as np
import pytest
from numpy import ndarray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from tests.synthesis.samples import ball, exemplar, flagged, holes
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.domain.steps import steps_from
from texloom.exemplar.exemplar import Exemplar
from texloom.fusion.belt_samples import belt_sample
from texloom.fusion.belts import lay_belts, pairs_of


def columns(grid: Grid, *borders: int) -> ndarray:
    """Labels that change at the given columns."""
    return np.searchsorted(borders, np.arange(grid.count) % grid.columns, side="right").astype(np.int32)


@pytest.mark.parametrize("domain", [Grid(12, 17), Grid(12, 17, wrap=True), ball(300)], ids=["plane", "torus", "ball"])
def test_steps_are_the_shortest_ways(domain: Domain) -> None:
    sites = np.random.default_rng(0).random(domain.count) < 0.02
    graph = coo_array((np.ones(len(domain.edges)), tuple(domain.edges.T)), shape=(domain.count, domain.count))
    ways = dijkstra(graph, directed=False, indices=np.flatnonzero(sites), unweighted=True, min_only=True)
    found = steps_from(domain, sites, 4)
    np.testing.assert_array_equal(found, np.minimum(ways, 5))


@pytest.mark.parametrize("wrap", [False, True])
def test_a_belt_is_as_wide_as_the_larger_scale(wrap: bool) -> None:
    grid = Grid(6, 60, wrap)
    belts = lay_belts(grid, columns(grid, 30), np.array([6.0, 10.0]))
    column = np.arange(60)
    first = (column < 35) | (wrap & (column >= 55))
    second = (column >= 25) | (wrap & (column < 5))
    allowed = np.broadcast_to(np.stack([first, second])[:, None], (2, 6, 60))
    np.testing.assert_array_equal(belts.allowed.reshape(2, 6, 60), allowed)
    np.testing.assert_array_equal(belts.nearest().reshape(6, 60)[0], np.where(first & second, 1 - (column >= 30), -1))


def test_each_border_has_its_own_width_and_pair() -> None:
    grid = Grid(5, 90)
    belts = lay_belts(grid, columns(grid, 30, 60), np.array([4.0, 6.0, 12.0]))
    other = belts.nearest().reshape(5, 90)[2]
    np.testing.assert_array_equal(np.flatnonzero(other >= 0), [*range(27, 33), *range(54, 66)])
    np.testing.assert_array_equal(pairs_of(belts.labels, belts.nearest()), [[0, 1], [1, 2]])


@pytest.mark.parametrize("domain", [Grid(40, 40), ball(900)], ids=["plane", "ball"])
def test_where_three_meet_every_site_has_two_of_them(domain: Domain) -> None:
    angle = np.arange(domain.count) % 40 - 19.5, np.arange(domain.count) // 40 - 19.5
    labels = (np.floor(np.arctan2(*angle) / (2 * np.pi / 3)) % 3).astype(np.int32)
    belts = lay_belts(domain, labels, np.array([6.0, 6.0, 6.0]))
    other = belts.nearest()
    inside = other >= 0
    assert inside.any() and (other != labels)[inside].all()
    np.testing.assert_array_equal(pairs_of(labels, other), [[0, 1], [0, 2], [1, 2]])
    steps = belts.steps[np.maximum(other, 0), np.arange(domain.count)][inside]
    assert steps.max() == 3 and steps.min() == 1


def test_narrow_regions_know_how_deep_they_are() -> None:
    grid = Grid(30, 90)
    labels = columns(grid, 20, 25, 50)
    labels[labels == 3] = 1  # a stroke of 5 texels, and a wide region
    belts = lay_belts(grid, np.where(labels == 2, 0, labels).astype(np.int32), np.array([20.0, 4.0]))
    depth = belts.depth.reshape(30, 90)[15]
    np.testing.assert_array_equal(depth[20:25], 3)
    np.testing.assert_array_equal(depth[[0, 60, 89]], 10)
    np.testing.assert_array_equal(belts.half, [[10, 10], [10, 2]])


def test_a_label_that_is_nowhere_has_no_belt() -> None:
    belts = lay_belts(Grid(10, 10), np.zeros(100, np.int32), np.array([5.0, 5.0]))
    assert (belts.nearest() == -1).all() and not belts.allowed[1].any()
    assert len(pairs_of(belts.labels, belts.nearest())) == 0


PAIRS = {
    "alike": (exemplar(32), exemplar(32, seed=5)),
    "of two sizes": (exemplar(32), exemplar(48, seed=5).crop(slice(0, 24), slice(0, 48))),
    "stacks": (exemplar(32, 6), exemplar(40, 6, seed=5)),
    "small": (exemplar(8), exemplar(9, seed=1)),
}


@pytest.mark.parametrize("name", PAIRS)
def test_a_belt_sample_is_the_first_inside_and_the_second_around(name: str) -> None:
    first, second = PAIRS[name]
    sample = belt_sample(first, second, seed=3)
    rows, columns = sample.second.shape
    assert not sample.second[rows // 2, columns // 2] and sample.second[0].all() and sample.second[:, -1].all()
    at = sample.texel
    for key, made in sample.exemplar.maps.items():
        for is_second, given in ((False, first), (True, second)):
            shown = sample.second == is_second
            np.testing.assert_array_equal(made.image[shown], given.maps[key].image[at[shown][:, 0], at[shown][:, 1]])


def test_borders_of_every_direction_are_in_a_belt_sample() -> None:
    second = belt_sample(*PAIRS["alike"]).second
    steps = [np.diff(second.astype(int), axis=axis) for axis in (0, 1)]
    assert all((step == 1).any() and (step == -1).any() for step in steps)


def test_places_in_a_belt_sample_are_places_in_the_samples() -> None:
    sample = belt_sample(*PAIRS["alike"], seed=1)
    is_second, place = sample.origin(np.array([[14.25, 13.5], [0, 3.75]], np.float32))
    np.testing.assert_array_equal(is_second, [False, True])
    np.testing.assert_allclose(place, [sample.texel[14, 14] + [0.25, -0.5], sample.texel[0, 4] + [0, -0.25]])


def test_masked_texels_stay_masked_in_a_belt_sample() -> None:
    mask = holes(32)
    sample = belt_sample(flagged(mask), flagged(np.ones((32, 32), bool)))
    assert sample.exemplar.mask is not None
    np.testing.assert_array_equal(sample.exemplar.maps["flag"].image[..., 0] == 0, sample.exemplar.mask)


def test_belt_samples_repeat_by_seed() -> None:
    def shown(exemplar: Exemplar) -> ndarray:
        return exemplar.lead.image

    one, same, another = (shown(belt_sample(*PAIRS["alike"], seed=seed).exemplar) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, another)
