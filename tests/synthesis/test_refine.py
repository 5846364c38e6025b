"""Refinement in both orders, on every kind of place, with and without something known."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import ball, exemplar, flagged, holes
from texloom.arrays import in_fours
from texloom.cli.options import ORDERS
from texloom.domain.domain import Domain, Lattice
from texloom.domain.grid import Grid
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.exemplar.features import match_image
from texloom.exemplar.scale import dominant_scale
from texloom.kernels.launch import thread_count, use
from texloom.output.gather import gather_sites
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.fill import fill
from texloom.synthesis.growth import Grown, Growth
from texloom.synthesis.refine import Refine, _plant
from texloom.synthesis.result import Result
from texloom.synthesis.scan import Scan
from texloom.synthesis.synthesize import synthesize

SCAN = Refine(order="scan-line", passes=3)
BOTH = pytest.mark.parametrize("method", [Refine(), SCAN], ids=ORDERS)
WRAP = pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
FIELD = np.stack(np.broadcast_arrays(np.sin(np.arange(24) / 9), np.cos(np.arange(24)[:, None] / 9)), -1)


def whole(result: Result, domain: Domain, shape: tuple[int, int]) -> None:
    position = result.sources.position
    assert position.shape == (domain.count, 1, 2)
    np.testing.assert_array_equal(position, np.rint(position))
    assert position.min() >= 0 and (position < shape).all()


@WRAP
@pytest.mark.parametrize("shape", [(30, 22), (5, 7), (1, 1), (1, 30)], ids=str)
@pytest.mark.parametrize("sides", [(32, 32), (8, 8), (8, 40), (33, 9)], ids=str)
def test_scan_lines_cover_any_size_from_any_exemplar(
    wrap: bool, shape: tuple[int, int], sides: tuple[int, int]
) -> None:
    sample = exemplar(48).crop(slice(0, sides[0]), slice(0, sides[1]))
    domain = Grid(*shape, wrap)
    whole(synthesize(sample, domain, SCAN, seed=2), domain, sides)


@pytest.mark.parametrize("channels", [1, 6], ids=["grey", "stack"])
def test_scan_lines_take_any_channels(channels: int) -> None:
    domain = Grid(20, 20)
    whole(synthesize(exemplar(24, channels), domain, SCAN), domain, (24, 24))


def test_scan_lines_keep_to_the_mask() -> None:
    mask = holes(40)
    sources = synthesize(flagged(mask), Grid(30, 26, wrap=True), SCAN).sources
    np.testing.assert_array_equal(gather_sites(sources, flagged(mask).maps["flag"]), 0)


def test_a_constant_exemplar_settles_at_once() -> None:
    sample = from_array(np.full((24, 20, 3), 77, np.uint8))
    result = synthesize(sample, Grid(20, 20), SCAN)
    assert result.stopped == "settled" and len(result.energy) == 2 and max(result.energy) < 1e-10


def test_scan_lines_from_nothing_make_a_torus_of_the_plane() -> None:
    """Where nothing is known, opposite borders always fit together, as in the paper."""
    plane, torus = (synthesize(exemplar(32), Grid(24, 20, w), SCAN, seed=1) for w in (False, True))
    np.testing.assert_array_equal(plane.sources.position, torus.sources.position)


@BOTH
def test_one_thread_gives_what_three_give_and_seeds_matter(method: Refine) -> None:
    before, results = thread_count(), []
    try:
        for threads, seed in ((1, 5), (3, 5), (3, 6)):
            use(threads=threads)
            results.append(synthesize(exemplar(32), Grid(26, 24, True), method, seed=seed))
    finally:
        use(threads=before)
    one, three, other = results
    np.testing.assert_array_equal(one.sources.position, three.sources.position)
    assert one.energy == three.energy and one.curves == three.curves
    assert (one.sources.position != other.sources.position).any(2).mean() > 0.2


@BOTH
def test_curves_have_a_value_a_pass_and_energy_one_more_where_the_first_is_a_pass(method: Refine) -> None:
    result = synthesize(exemplar(32), Grid(26, 24), method, seed=1)
    assert set(result.curves) == {"MSE", "changed pixels", "difference"}
    first = int(method.order == "scan-line")
    assert {len(values) for values in result.curves.values()} == {len(result.energy) - first}
    assert "analysis" in result.seconds and min(result.seconds.values()) >= 0


def test_passes_lower_the_energy() -> None:
    for method in (Refine(threshold=0), Refine(order="scan-line", threshold=0)):
        energy = synthesize(exemplar(40), Grid(40, 40, True), method, seed=1).energy
        assert len(energy) == 10 and energy[-1] < energy[1 if method.order == "scan-line" else 0]


@BOTH
def test_a_run_ends_when_settled_or_after_its_passes(method: Refine) -> None:
    def stopped(**other: float) -> str:
        grown = Refine(order=method.order, **other)  # pyright: ignore[reportArgumentType]
        return synthesize(exemplar(32), Grid(24, 24), grown, seed=1).stopped

    assert stopped(threshold=10.0) == "settled"
    assert stopped(threshold=0, passes=2) == stopped(passes=1, threshold=1e-9) == "passes"


def test_sizes_are_those_asked_for_or_twice_the_scale_and_the_scale() -> None:
    sample = exemplar(64)
    scale = dominant_scale(sample).scale
    assert Refine()._sizes(sample) == (round(2 * scale), round(scale))
    assert Refine(order="scan-line", window=9, pitch=5)._sizes(sample) == (9, 5)
    assert Refine(window=9)._sizes(sample) == (9, round(scale))
    assert all(size <= 4 for size in Refine()._sizes(exemplar(8)))


@pytest.mark.parametrize("place", ["ball", "field"])
def test_scan_lines_need_rows(place: str) -> None:
    domain = ball() if place == "ball" else Grid(24, 24, field=FIELD)
    with pytest.raises(ParameterError, match="use the parallel order") as caught:
        synthesize(exemplar(32), domain, SCAN)
    assert "\n" not in str(caught.value)


def test_a_window_wider_than_the_sample_is_refused_in_scan_lines() -> None:
    with pytest.raises(ExemplarError, match="no 41x41 window .*: give a smaller window"):
        synthesize(exemplar(32), Grid(20, 20), Refine(order="scan-line", window=41))


def grow(method: Refine, canvas: Canvas, sample: Exemplar, domain: Domain, sites: ndarray | None) -> Grown:
    image = in_fours(match_image(sample))
    return method.grow(Growth(canvas, sample, image, domain, sites, seed=1))


def shown(sample: Exemplar, known: ndarray) -> Canvas:
    """A canvas of the sample's size that shows it where it is ``known``."""
    image = in_fours(match_image(sample))
    canvas = Canvas.empty(known.size, image.shape[2])
    canvas.position[known.ravel()] = np.argwhere(known)
    canvas.colour[known.ravel()] = image[known]
    canvas.label[known.ravel()] = 0
    return canvas


@BOTH
@pytest.mark.parametrize("empty", [False, True], ids=["around a hole", "from nothing"])
def test_sites_not_given_are_never_written(method: Refine, empty: bool) -> None:
    sample, hole = exemplar(40), np.zeros((40, 40), bool)
    hole[13:25, 9:30] = True
    canvas = Canvas.empty(1600, 4) if empty else shown(sample, ~hole)
    before = [array.copy() for array in (canvas.position, canvas.colour, canvas.label, canvas.turn)]
    grow(method, canvas, sample, Grid(40, 40), hole.ravel())
    for was, now in zip(before, (canvas.position, canvas.colour, canvas.label, canvas.turn), strict=True):
        np.testing.assert_array_equal(now[~hole.ravel()], was[~hole.ravel()])
    assert (canvas.label[hole.ravel()] >= 0).all()


@BOTH
@WRAP
def test_a_hole_in_a_sample_that_repeats_is_closed_without_a_trace(method: Refine, wrap: bool) -> None:
    row, column = np.mgrid[:48, :48]
    sample = from_array((127 + 60 * np.sin(row * np.pi / 4) + 60 * np.cos(column * np.pi / 4)).astype(np.uint8))
    known = np.ones((48, 48), bool)
    known[30:42, 18:31] = False
    canvas = shown(sample, known)
    grow(method, canvas, sample.with_mask(known), Grid(48, 48, wrap), ~known.ravel())
    np.testing.assert_allclose(canvas.colour.reshape(48, 48, -1), in_fours(match_image(sample)), atol=1.5 / 255)


def test_blocks_are_as_wide_as_the_mask_has_room_for() -> None:
    """Of a sample with a hole in its middle, as a fill learns from."""
    sample, known = exemplar(40), np.ones((40, 40), bool)
    known[14:26, 10:24] = False
    canvas = shown(sample, known)
    grow(Refine(window=20), canvas, sample.with_mask(known), Grid(40, 40), ~known.ravel())
    assert (canvas.label >= 0).all()
    texel = canvas.position[~known.ravel()].astype(int)
    assert known[texel[:, 0], texel[:, 1]].all()


@pytest.mark.parametrize("empty", [False, True], ids=["around a hole", "from nothing"])
def test_passes_turn_through_four_directions_around_what_is_known(empty: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    directions: list[tuple[int, bool]] = []
    run = Scan.run

    def recorded(scan: Scan, chosen: ndarray, steps: ndarray, *, axis: int, backwards: bool) -> Iterator[float]:
        directions.append((axis, backwards))
        return run(scan, chosen, steps, axis=axis, backwards=backwards)

    monkeypatch.setattr(Scan, "run", recorded)
    sample, hole = exemplar(32), np.zeros((32, 32), bool)
    hole[8:20, 9:21] = True
    canvas = Canvas.empty(1024, 4) if empty else shown(sample, ~hole)
    grow(Refine(order="scan-line", passes=5, threshold=0), canvas, sample, Grid(32, 32), hole.ravel())
    four = [(0, False), (1, False), (0, True), (1, True), (0, False)]
    assert directions == ([(0, False)] * 5 if empty else four)


def test_seeds_are_planted_where_there_is_room_and_nothing_is_known_within_a_window() -> None:
    sample, known = exemplar(64), np.zeros((64, 64), bool)
    known[:, :9] = True
    sites = np.argwhere(np.ones((64, 64)))[:, 0] < 50
    canvas = shown(sample, known)
    growth = Growth(canvas, sample, in_fours(match_image(sample)), Grid(64, 64), sites & ~known.ravel(), seed=1)
    _plant(growth, Lattice(64, 64, False), 8, 12)
    planted = np.argwhere(((canvas.label >= 0) & ~known.ravel()).reshape(64, 64))
    expected = [(row, column) for row in range(0, 50, 8) for column in range(24, 64, 8)]
    np.testing.assert_array_equal(planted, expected)
    texel = canvas.position.reshape(64, 64, 2)[tuple(planted.T)].astype(int)
    np.testing.assert_array_equal(canvas.colour.reshape(64, 64, 4)[tuple(planted.T)], growth.image[tuple(texel.T)])


def test_growing_in_parallel_on_a_mesh_leaves_other_sites() -> None:
    domain, sample = ball(), exemplar(32)
    canvas, sites = Canvas.empty(domain.count, 4), np.arange(domain.count) % 2 > 0
    grow(Refine(), canvas, sample, domain, sites)
    np.testing.assert_array_equal(canvas.label >= 0, sites)
    assert not canvas.position[~sites].any()


def test_names_are_those_of_the_command_line() -> None:
    for order in ORDERS:
        assert Refine(order=order).order == order  # pyright: ignore[reportArgumentType]


def test_an_estimated_window_shrinks_to_what_is_beside_a_hole():
    """A frame 9 texels wide holds no window of twice the scale."""
    row, column = np.indices((48, 48))
    picture = from_array(np.float32(0.5 + 0.4 * np.sin(row * 0.7) * np.cos(column * 0.5))[..., None])
    hole = np.zeros((48, 48), bool)
    hole[9:39, 9:39] = True
    filled = fill(picture, hole, method=Refine(order="scan-line", passes=1))
    taken = filled.result.sources.position[hole.ravel(), 0].astype(int)
    assert not hole[taken[:, 0], taken[:, 1]].any()
