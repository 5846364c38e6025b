"""Growing on: what is known stays and is matched, only the sites given are written, on every kind of domain."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import ball, blobs, exemplar, flagged, holes
from texloom.arrays import in_fours
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.exemplar.features import match_image
from texloom.exemplar.join import join
from texloom.field.planar import NAMED
from texloom.progress import silent
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.correction import Correction
from texloom.synthesis.growth import Grown, Growth, run_on_bare
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling


def bent() -> Grid:
    field = NAMED["sine"](40, 40)
    return Grid(40, 40, field=field.direction, magnitude=field.scale)


DOMAINS: dict[str, Callable[[], Domain]] = {
    "plane": lambda: Grid(40, 48),
    "torus": lambda: Grid(40, 40, wrap=True),
    "field": bent,
    "surface": ball,
}


def half(domain: Domain, seed: int = 0) -> ndarray:
    """About half the sites, on one side of a ragged border."""
    near = np.arange(domain.count) % 97 < 3
    for _ in range(3):
        first, second = domain.edges.T
        near[first[near[second]]] = True
        near[second[near[first]]] = True
    return near


def copied(canvas: Canvas) -> list[ndarray]:
    return [canvas.position.copy(), canvas.colour.copy(), canvas.turn.copy(), canvas.label.copy()]


def grow(
    canvas: Canvas, domain: Domain, sample: Exemplar, sites: ndarray | None = None, method: Optimize | None = None
) -> Grown:
    image = in_fours(match_image(sample))
    return (method or Optimize()).grow(Growth(canvas, sample, image, domain, sites, seed=1))


def blank(domain: Domain, sample: Exemplar) -> Canvas:
    return Canvas.empty(domain.count, in_fours(match_image(sample)).shape[2])


@pytest.mark.parametrize("name", DOMAINS)
def test_only_the_sites_given_are_written_and_all_of_them_are(name: str) -> None:
    domain, sample = DOMAINS[name](), exemplar(48)
    canvas, first = blank(domain, sample), half(domain)
    grow(canvas, domain, sample, first)
    np.testing.assert_array_equal(canvas.label >= 0, first)
    np.testing.assert_array_equal(canvas.position[~first], 0)

    before = copied(canvas)
    grow(canvas, domain, sample, ~first)
    assert (canvas.label >= 0).all()
    for was, now in zip(before, copied(canvas), strict=True):
        np.testing.assert_array_equal(now[first], was[first])
    colours = blobs(48)[tuple(np.clip(np.rint(canvas.position).astype(int), 0, 47).T)]
    assert np.abs(canvas.colour[:, :3] - colours / 255).mean() < 0.03  # shown as sources say, fractions aside


@pytest.mark.parametrize("name", DOMAINS)
def test_an_empty_canvas_with_all_sites_is_a_plain_run(name: str) -> None:
    domain, sample = DOMAINS[name](), exemplar(32)
    canvas = blank(domain, sample)
    grown = grow(canvas, domain, sample, np.ones(domain.count, bool))
    whole = run_on_bare(Optimize(), sample, domain, seed=1, report=silent)
    np.testing.assert_array_equal(canvas.position, whole.sources.position[:, 0])
    assert grown.energy == whole.energy and grown.patches == whole.patches


def test_nothing_bare_is_nothing_laid() -> None:
    domain, sample = Grid(24, 24), exemplar(32)
    canvas = blank(domain, sample)
    grow(canvas, domain, sample)
    assert PatchSampling().grow(Growth(canvas, sample, in_fours(match_image(sample)), domain, seed=1)).patches == 0


def test_what_is_masked_is_not_shown_around_what_is_known() -> None:
    sample = flagged(holes(48))
    domain = Grid(48, 48)
    canvas = blank(domain, sample)
    image = in_fours(match_image(sample))
    known = np.zeros((48, 48), bool)
    known[:20] = True
    canvas.position[known.ravel()] = np.argwhere(known)
    canvas.colour[known.ravel()] = image[known]
    canvas.label[known.ravel()] = 0
    grow(canvas, domain, sample, ~known.ravel())
    texel = np.rint(canvas.position[~known.ravel()]).astype(int)
    assert sample.usable[texel[:, 0], texel[:, 1]].all()


def test_growth_inside_a_part_of_joined_samples_shows_that_part_alone() -> None:
    joined = join([exemplar(96), exemplar(24, seed=3)])
    domain = Grid(40, 40)
    canvas = blank(domain, joined.exemplar)
    small = joined.within(1)
    assert small.least_side == 24 and PatchSampling().width_for(small) == 12
    grow(canvas, domain, small)
    part = joined.parts[1]
    row, column = canvas.position.T
    assert (row >= part.row).all() and (row <= part.row + part.rows - 1).all()
    assert (column >= part.column).all() and (column <= part.column + part.columns - 1).all()


def test_a_periodic_sample_continues_without_a_step() -> None:
    row, column = np.mgrid[:64, :64]
    sample = from_array((127 + 60 * np.sin(row * np.pi / 8) + 60 * np.cos(column * np.pi / 8)).astype(np.uint8))
    domain = Grid(64, 64)
    canvas, image = blank(domain, sample), in_fours(match_image(sample))
    known = np.ones((64, 64), bool)
    known[17:45, 11:50] = False
    canvas.position[known.ravel()] = np.argwhere(known)
    canvas.colour[known.ravel()] = image[known]
    canvas.label[known.ravel()] = 0
    grow(canvas, domain, sample.with_mask(known), ~known.ravel())
    np.testing.assert_allclose(canvas.colour.reshape(64, 64, -1), image, atol=1.5 / 255)


@pytest.mark.parametrize("name", DOMAINS)
def test_a_single_known_site_is_no_harm(name: str) -> None:
    domain, sample = DOMAINS[name](), exemplar(32)
    canvas, known = blank(domain, sample), np.arange(domain.count) == domain.count // 2
    canvas.position[known], canvas.colour[known], canvas.label[known] = 9, 0.5, 4
    grow(canvas, domain, sample, ~known)
    assert (canvas.label >= 0).all() and (canvas.colour[known] == 0.5).all() and (canvas.label[known] == 4).all()


def test_correction_asks_nothing_of_bare_sites() -> None:
    sample, domain = exemplar(32), Grid(32, 32)
    image, canvas = in_fours(match_image(sample)), blank(domain, sample)
    known = np.arange(domain.count) < 500
    canvas.position[:] = np.argwhere(np.ones((32, 32), bool))
    canvas.colour[known], canvas.label[known] = image.reshape(domain.count, -1)[known], 0
    correction = Correction(image, np.ones((32, 32), np.uint8), np.zeros((32, 32, 0, 2), np.int32), 2)
    sites = np.flatnonzero(known).astype(np.int32)
    assert correction.run(canvas, domain, sites, passes=1, seed=0, report=silent) == [0.0]
