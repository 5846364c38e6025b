"""Correction leaves what is coherent alone, mends what is not, and never raises the energy of what it visits."""

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import blobs
from texloom.arrays import in_fours
from texloom.domain.grid import Grid
from texloom.exemplar.similarity import most_alike
from texloom.progress import silent
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.correction import Correction, near_borders

SIZE, REACH = 24, 2
IMAGE = in_fours(blobs(SIZE).astype(np.float32) / np.float32(255))


def correction() -> Correction:
    usable = np.zeros((SIZE, SIZE), np.uint8)
    usable[REACH : SIZE - REACH - 1, REACH : SIZE - REACH - 1] = 1
    return Correction(IMAGE, usable, most_alike(IMAGE, 2), REACH)


def copy(position: ndarray) -> Canvas:
    """A canvas that shows the given places of the exemplar."""
    canvas = Canvas.empty(len(position), IMAGE.shape[2])
    canvas.position[:], canvas.label[:] = position, 0
    canvas.colour[:] = IMAGE[position[:, 0], position[:, 1]]
    return canvas


def identity() -> ndarray:
    return np.stack(np.divmod(np.arange(SIZE**2), SIZE), 1)


def test_an_exemplar_that_is_its_own_output_costs_nothing_and_stays() -> None:
    canvas, sites = copy(identity()), np.arange(SIZE**2, dtype=np.int32)
    energy = correction().run(canvas, Grid(SIZE, SIZE), sites, passes=2, seed=0, report=silent)
    assert energy == [0.0, 0.0]
    np.testing.assert_array_equal(canvas.position, identity())


def test_a_scratch_in_a_copy_is_mended() -> None:
    """Wrong texels amid coherence go back to what belongs there."""
    grid, place = Grid(SIZE, SIZE), identity()
    scratched = np.flatnonzero((place[:, 0] == 11) & (place[:, 1] > 5) & (place[:, 1] < 18)).astype(np.int32)
    wrong = place.copy()
    wrong[scratched] = np.random.default_rng(0).integers(3, 20, (len(scratched), 2))
    canvas = copy(wrong)
    energy = correction().run(canvas, grid, scratched, passes=3, seed=0, report=silent)
    np.testing.assert_array_equal(canvas.position, place)
    assert energy[-1] == 0


def test_sites_not_asked_for_stay() -> None:
    rng = np.random.default_rng(1)
    start = rng.integers(3, 20, (SIZE**2, 2))
    canvas, sites = copy(start), np.arange(0, SIZE**2, 3, dtype=np.int32)
    energy = correction().run(canvas, Grid(SIZE, SIZE, wrap=True), sites, passes=3, seed=0, report=silent)
    others = np.setdiff1d(np.arange(SIZE**2), sites)
    np.testing.assert_array_equal(canvas.position[others], start[others])
    assert energy[0] > energy[1] > energy[2]
    at = np.rint(canvas.position).astype(int)
    np.testing.assert_array_equal(canvas.colour, IMAGE[at[:, 0], at[:, 1]])


@pytest.mark.parametrize("count", [0, 1])
def test_few_sites_are_corrected_too(count: int) -> None:
    """Most of the subpasses have nothing to do."""
    canvas = copy(identity())
    sites = np.arange(count, dtype=np.int32)
    energy = correction().run(canvas, Grid(SIZE, SIZE), sites, passes=2, seed=0, report=silent)
    assert energy == [0.0, 0.0]


def test_no_passes_leave_all_as_it_is() -> None:
    canvas = copy(identity())
    assert (
        correction().run(canvas, Grid(SIZE, SIZE), np.arange(9, dtype=np.int32), passes=0, seed=0, report=silent) == []
    )
    np.testing.assert_array_equal(canvas.position, identity())


@pytest.mark.parametrize("reach", [0, 1, 3])
@pytest.mark.parametrize("wrap", [False, True])
def test_borders_and_what_is_near_them(reach: int, wrap: bool) -> None:
    """Two halves meet in the middle, and on a torus at the ends as well."""
    canvas = copy(identity())
    canvas.label[:] = np.arange(SIZE**2) % SIZE >= SIZE // 2
    near = near_borders(canvas, Grid(SIZE, SIZE, wrap), reach).reshape(SIZE, SIZE)
    column = np.arange(SIZE)
    steps = np.abs(column - SIZE / 2 + 0.5) - 0.5
    if wrap:
        steps = np.minimum(steps, SIZE / 2 - 1 - steps)
    np.testing.assert_array_equal(near, np.broadcast_to(steps <= reach, near.shape))
