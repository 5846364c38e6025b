"""Whole samples laid and grown together: what holds for every picture made so."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import ball, blobs, exemplar, flagged, holes
from texloom.arrays import in_fours
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import from_array
from texloom.exemplar.features import match_image
from texloom.exemplar.join import join
from texloom.kernels.launch import thread_count, use
from texloom.output.gather import gather_sites
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.growth import Grown, Growth
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.refine_patches import RefinePatches
from texloom.synthesis.synthesize import synthesize

FIELD = np.broadcast_to([0.0, 1.0], (24, 24, 2))


@dataclass
class Watched:
    """Fills bare sites as another method does, and keeps what it was given."""

    bare: list[ndarray] = field(default_factory=list)
    label: list[ndarray] = field(default_factory=list)

    def grow(self, growth: Growth) -> Grown:
        assert growth.sites is not None
        self.bare.append(growth.sites.copy())
        self.label.append(growth.canvas.label.copy())
        return PatchSampling(patch=8).grow(growth)


@pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
def test_pieces_are_copies_and_only_their_meeting_is_filled(wrap: bool) -> None:
    watched = Watched()
    grid = Grid(90, 70, wrap)
    sources = synthesize(exemplar(40), grid, RefinePatches(fill=watched), seed=3).sources
    bare, label = watched.bare[0].reshape(90, 70), watched.label[0].reshape(90, 70)
    np.testing.assert_array_equal(bare, label < 0)
    assert 0 < bare.mean() < 0.5
    steps = np.diff(sources.position.reshape(90, 70, 2), axis=0)
    inside = (label[1:] >= 0) & (label[1:] == label[:-1])
    assert (steps[inside] == [1, 0]).all() or wrap  # around a torus a piece may touch itself
    assert (steps[inside] == [1, 0]).all(-1).mean() > 0.99
    # Pieces never touch but across what was filled.
    for axis in (0, 1):
        one, two = label, np.roll(label, -1, axis)
        if not wrap:
            one, two = (np.delete(side, -1, axis) for side in (one, two))
        assert ((one == two) | (one < 0) | (two < 0)).all()


def test_a_sample_that_tiles_reproduces_itself() -> None:
    """Of all places, those a period apart fit exactly: no band shows anything else."""
    tile = blobs(16)
    sample = from_array(np.tile(tile, (3, 3, 1)))
    result = synthesize(sample, Grid(96, 80, wrap=True), RefinePatches(), seed=1)
    shown = gather_sites(result.sources, sample.lead).reshape(96, 80, 3)
    np.testing.assert_array_equal(shown, np.roll(shown, 16, 0))
    np.testing.assert_array_equal(shown, np.roll(shown, 16, 1))


def test_what_may_not_change_stays_and_the_rest_is_coloured() -> None:
    sample, grid = exemplar(32), Grid(60, 50)
    image = in_fours(match_image(sample))
    canvas = Canvas.empty(grid.count, image.shape[2])
    given = np.zeros((60, 50), bool)
    given[5:30, 8:33] = True
    canvas.position[given.ravel()] = np.argwhere(given) - (5, 8)
    canvas.colour[given.ravel()] = image[:25, :25].reshape(-1, image.shape[2])
    canvas.label[given.ravel()] = 0
    before = canvas.position.copy()
    sites = ~given.ravel() & (np.arange(grid.count) % 50 < 45)
    RefinePatches().grow(Growth(canvas, sample, image, grid, sites, seed=1))
    np.testing.assert_array_equal(canvas.label >= 0, given.ravel() | sites)
    np.testing.assert_array_equal(canvas.position[~sites], before[~sites])


def test_masked_texels_are_never_shown() -> None:
    sample = flagged(holes(40))
    for wrap in (False, True):
        sources = synthesize(sample, Grid(70, 66, wrap), RefinePatches(), seed=2).sources
        np.testing.assert_array_equal(gather_sites(sources, sample.maps["flag"]), 0)


def test_several_samples_are_all_laid() -> None:
    joined = join([exemplar(32), exemplar(32, seed=4)])
    watched = Watched()
    sources = synthesize(joined.exemplar, Grid(120, 120), RefinePatches(fill=watched), seed=1).sources
    column = sources.position[watched.label[0] >= 0, 0, 1]
    assert all(((column >= p.column) & (column < p.column + p.columns)).mean() > 0.1 for p in joined.parts)


@pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
@pytest.mark.parametrize("shape", [(1, 1), (5, 7), (1, 30), (20, 9), (30, 30)], ids=str)
@pytest.mark.parametrize("sides", [(8, 8), (33, 33), (8, 40)], ids=str)
def test_small_samples_and_small_pictures(sides: tuple[int, int], shape: tuple[int, int], wrap: bool) -> None:
    sample = exemplar(40).crop(slice(0, sides[0]), slice(0, sides[1]))
    position = synthesize(sample, Grid(*shape, wrap), RefinePatches(), seed=2).sources.position[:, 0]
    assert ((position >= 0) & (position < sides) & (position == np.rint(position))).all()


def test_a_constant_sample_gives_its_colour() -> None:
    sample = from_array(np.zeros((24, 20, 3), np.uint8))
    result = synthesize(sample, Grid(50, 40, wrap=True), RefinePatches())
    assert not gather_sites(result.sources, sample.lead).any()


def test_same_seed_same_sources_on_any_number_of_threads() -> None:
    before, found = thread_count(), []
    try:
        for threads, seed in ((1, 5), (2, 5), (2, 6)):
            use(threads=threads)
            found.append(synthesize(exemplar(32), Grid(60, 60), RefinePatches(), seed=seed).sources.position)
    finally:
        use(threads=before)
    np.testing.assert_array_equal(found[0], found[1])
    assert (found[1] != found[2]).any()


@pytest.mark.parametrize("place", [ball(200), Grid(24, 24, field=FIELD)], ids=["surface", "field"])
def test_only_straight_images(place: Domain) -> None:
    with pytest.raises(ParameterError, match="use optimize there"):
        synthesize(exemplar(32), place, RefinePatches())


def test_a_depth_that_cannot_be_is_refused() -> None:
    with pytest.raises(ParameterError, match="depth 3"):
        RefinePatches(depth=3)
