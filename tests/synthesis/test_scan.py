"""Scan-line synthesis against a slow one in plain Python, and what it promises whatever it is given."""

import numpy as np
import pytest
from numpy import ndarray

from tests import naive
from tests.synthesis.samples import blobs
from texloom.arrays import in_fours
from texloom.domain.domain import Lattice
from texloom.domain.neighbourhoods import square, stencil
from texloom.exemplar.windows import Windows
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.scan import Scan

WAYS = pytest.mark.parametrize("axis", [0, 1], ids=["rows", "columns"])
BACK = pytest.mark.parametrize("backwards", [False, True], ids=["forwards", "backwards"])
WRAP = pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
COLOURS = blobs(20).astype(np.float32) / np.float32(255)
IMAGE = in_fours(COLOURS)
WINDOWS = Windows.of(COLOURS, 3, 8)


def canvas_of(known: ndarray, position: ndarray, image: ndarray = IMAGE) -> Canvas:
    """A canvas on which the ``known`` sites show the given texels."""
    canvas = Canvas.empty(known.size, 4)
    there = known.ravel()
    canvas.position[there] = position.reshape(-1, 2)[there]
    canvas.colour[there] = image[tuple(position.reshape(-1, 2)[there].T)]
    canvas.label[there] = 0
    return canvas


def speckled(shape: tuple[int, int], share: float, seed: int = 0) -> Canvas:
    rng = np.random.default_rng(seed)
    return canvas_of(rng.random(shape) < share, rng.integers(0, 20, (*shape, 2)))


def scan_slowly(
    canvas: Canvas, lattice: Lattice, chosen: ndarray, steps: ndarray, shortlist: int, axis: int, backwards: bool
) -> ndarray:
    """Visit the chosen pixels one by one; their costs."""
    reach, cost = WINDOWS.reach, np.zeros(chosen.size)
    vectors = np.stack(
        [
            np.tensordot(COLOURS[r - reach : r + reach + 1, c - reach : c + reach + 1] - WINDOWS.mean, WINDOWS.axes, 3)
            for r, c in WINDOWS.centre
        ]
    )

    def coloured(row: int, column: int) -> int:
        site = int(lattice.site_at(np.array([row]), np.array([column]))[0])
        return site if site >= 0 and canvas.label[site] >= 0 else -1

    sites = np.arange(chosen.size).reshape(lattice.rows, lattice.columns)
    order = (sites if axis == 0 else sites.T).ravel()[:: -1 if backwards else 1]
    for site in order[chosen[order]].tolist():
        row, column = divmod(site, lattice.columns)
        window, known = np.zeros((7, 7, 3)), np.zeros((7, 7))
        for r, c in square(reach).tolist():
            if (near := coloured(row + r, column + c)) >= 0:
                window[r + reach, c + reach], known[r + reach, c + reach] = canvas.colour[near, :3], 1
        query = naive.window_components(window, known, WINDOWS.axes, WINDOWS.mean, WINDOWS.variance, WINDOWS.noise)
        suggested = []
        for step in np.argwhere(np.ones((3, 3))) - 1:
            if (near := coloured(*(np.array([row, column]) + step))) >= 0:
                place = canvas.position[near].astype(int) - step
                inside = (place >= 0).all() and (place < 20).all()
                suggested.append(int(WINDOWS.candidate_at[tuple(place)]) if inside else -1)
        there = [(step, coloured(row + step[0], column + step[1])) for step in steps]
        around = [(step, canvas.colour[near, :3]) for step, near in there if near >= 0]
        best, cost[site] = naive.scan_pixel(COLOURS, WINDOWS.centre, vectors, query, around, suggested, shortlist)
        canvas.position[site] = WINDOWS.centre[best]
        canvas.colour[site] = IMAGE[tuple(WINDOWS.centre[best])]
        canvas.label[site] = 0
    return cost


@pytest.mark.parametrize("shortlist", [1, 3])
@WAYS
@BACK
@WRAP
def test_the_first_pass_and_the_next_take_the_texels_of_the_slow_one(
    shortlist: int, axis: int, backwards: bool, wrap: bool
) -> None:
    lattice = Lattice(8, 9, wrap)
    ours, slow = speckled((8, 9), 0.2), speckled((8, 9), 0.2)
    scan = Scan(ours, IMAGE, WINDOWS, lattice, shortlist)
    for chosen, steps in ((ours.label < 0, square(3)), (np.arange(72) % 3 > 0, stencil(3))):
        list(scan.run(chosen, steps, axis=axis, backwards=backwards))
        cost = scan_slowly(slow, lattice, chosen, steps, shortlist, axis, backwards)
        np.testing.assert_array_equal(ours.position, slow.position)
        np.testing.assert_allclose(scan.cost[chosen], cost[chosen], rtol=1e-3, atol=1e-6)


@WRAP
@WAYS
def test_unknown_parts_are_completed_by_what_is_likely(wrap: bool, axis: int) -> None:
    """The components of every window of a line, known in part, against a solve of their own."""
    canvas, lattice = speckled((11, 10), 0.5), Lattice(11, 10, wrap)
    scan, at = Scan(canvas, IMAGE, WINDOWS, lattice, 1), 2
    for along in range((10, 11)[axis]):
        place = np.array([at, along] if axis == 0 else [along, at])
        inverse, mean = scan._completion(at, axis, np.array([along], np.int32))
        completed = inverse[0] @ (scan._projected[tuple(place)] - mean[0])
        site = lattice.site_at(*(place + np.argwhere(np.ones((7, 7))) - 3).T)
        known = ((site >= 0) & (canvas.label[site] >= 0)).reshape(7, 7)
        window = canvas.colour[site, :3].reshape(7, 7, 3)
        expected = naive.window_components(window, known, WINDOWS.axes, WINDOWS.mean, WINDOWS.variance, WINDOWS.noise)
        np.testing.assert_allclose(completed, expected, atol=1e-3)


@WRAP
@WAYS
@pytest.mark.parametrize("shape", [(12, 14), (5, 4), (1, 9), (2, 2)], ids=str)
def test_components_kept_are_those_of_the_canvas(wrap: bool, axis: int, shape: tuple[int, int]) -> None:
    canvas, lattice = speckled(shape, 0.3), Lattice(*shape, wrap)
    scan = Scan(canvas, IMAGE, WINDOWS, lattice, 2)
    for chosen in (canvas.label < 0, np.arange(canvas.label.size) % 2 > 0, np.ones(canvas.label.size, bool)):
        list(scan.run(chosen, stencil(3), axis=axis))
        list(scan.run(chosen, stencil(3), axis=1 - axis, backwards=True))
    fresh = Scan(canvas, IMAGE, WINDOWS, lattice, 2)
    np.testing.assert_allclose(scan._projected, fresh._projected, atol=2e-4)


@WAYS
@BACK
def test_sites_not_chosen_are_never_written(axis: int, backwards: bool) -> None:
    canvas = speckled((13, 11), 0.4)
    before = [array.copy() for array in (canvas.position, canvas.colour, canvas.label, canvas.turn)]
    chosen = np.random.default_rng(5).random(143) < 0.5
    done = list(
        Scan(canvas, IMAGE, WINDOWS, Lattice(13, 11, False), 2).run(chosen, stencil(3), axis=axis, backwards=backwards)
    )
    for was, now in zip(before, (canvas.position, canvas.colour, canvas.label, canvas.turn), strict=True):
        np.testing.assert_array_equal(now[~chosen], was[~chosen])
    assert (canvas.label[chosen] >= 0).all()
    assert done == sorted(done) and done[-1] == 1


@pytest.mark.parametrize(("given", "shortlist"), [("half", 1), ("half", 4), ("seeds", 4)])
def test_an_exemplar_that_tiles_goes_on_as_it_began(given: str, shortlist: int) -> None:
    """Colours are those of the tile at the same place; which of the equal texels shows them is open.

    Four seeds in a window are too few for the likeliest window to be the right one: their colours have to be compared.
    """
    tile = blobs(32)[:8, :8].astype(np.float32) / np.float32(255)
    image = np.tile(tile, (3, 3, 1))
    site = np.argwhere(np.ones((24, 16))).reshape(24, 16, 2)
    known = site[..., 0] < 12 if given == "half" else (site % 4 == 0).all(2)
    canvas = canvas_of(known, site % 8 + 8, in_fours(image))
    scan = Scan(canvas, in_fours(image), Windows.of(image, 4, 8), Lattice(24, 16, True), shortlist)
    for chosen, steps in ((canvas.label < 0, square(4)), (np.ones(384, bool), stencil(4))):
        list(scan.run(chosen, steps))
    np.testing.assert_array_equal(canvas.colour.reshape(24, 16, 4)[..., :3], np.tile(tile, (3, 2, 1)))
    assert scan.cost.max() < 1e-9


def test_an_empty_canvas_and_nothing_chosen() -> None:
    canvas = Canvas.empty(35, 4)
    scan = Scan(canvas, IMAGE, WINDOWS, Lattice(5, 7, True), 3)
    assert list(scan.run(np.zeros(35, bool), square(3))) == []
    assert (canvas.label < 0).all()
    list(scan.run(np.ones(35, bool), square(3)))
    assert (canvas.label == 0).all()


def test_of_equal_texels_the_first_is_taken_then_what_continues_it() -> None:
    image = np.full((20, 20, 3), 0.5, np.float32)
    canvas = Canvas.empty(30, 4)
    list(
        Scan(canvas, in_fours(image), Windows.of(image, 3, 8), Lattice(5, 6, True), 3).run(np.ones(30, bool), square(3))
    )
    np.testing.assert_array_equal(canvas.position[:6], [(3, 3 + column) for column in range(6)])
