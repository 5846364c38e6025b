"""A sample laid into itself is itself; lines go to lines; what is stretched is said."""

from dataclasses import fields

import numpy as np
import pytest

from tests.data import DATA, needs_data
from tests.sketch.drawn import voronoi
from texloom.exemplar.features import match_image
from texloom.io.stack import read_exemplar
from texloom.sketch.filling.kinds import Assignment, Deal, neighbours
from texloom.sketch.filling.maps import FeatureMaps, feature_maps
from texloom.sketch.filling.shapes import CellShapes, cell_shapes
from texloom.sketch.filling.warp import Initialization, Start, best_inside
from texloom.sketch.graph import CellGraph
from texloom.sketch.random import random_cells
from texloom.sketch.reading.detect import detect

SAMPLE = random_cells((110.0, 130.0), cell=26, seed=1)
TEXTURE = voronoi(40, 2, (170.0, 150.0))


def prepared(graph: CellGraph, blur: float | None = None) -> tuple[FeatureMaps, CellShapes]:
    cells = graph.cells()
    return feature_maps(graph, cells, blur=blur), cell_shapes(graph, cells)


def started(inside="radial", lines="carried", seed=3) -> tuple[Start, tuple, tuple, Assignment]:
    sample = prepared(SAMPLE)
    texture = prepared(TEXTURE, blur=sample[0].blur)
    dealt = Deal().run(sample[1], texture[1], neighbours(TEXTURE, TEXTURE.cells()), seed=seed)
    turn = np.random.default_rng(seed).uniform(-1.5, 1.5, len(dealt.source)).astype(np.float32)
    dealt = Assignment(dealt.source, turn)
    return Initialization(inside=inside, lines=lines).run(sample, texture, dealt, seed=seed), sample, texture, dealt


def itself(count: int) -> Assignment:
    return Assignment(np.arange(count, dtype=np.int32), np.zeros(count, np.float32))


@pytest.mark.parametrize("graph", [SAMPLE, TEXTURE])
@pytest.mark.parametrize("inside", ["radial", "scale"])
def test_a_sample_laid_into_itself_is_itself(graph: CellGraph, inside):
    sample = prepared(graph)
    start = Initialization(inside=inside).run(sample, sample, itself(len(sample[1])), seed=0)
    size = np.array(sample[0].shape)
    gap = start.position - np.stack(np.mgrid[: size[0], : size[1]], axis=-1)
    gap -= np.rint(gap / size) * size * graph.wrap
    gap = np.hypot(*np.moveaxis(gap, 2, 0))[sample[0].cell >= 0]
    assert gap.mean() < 0.05 and np.percentile(gap, 99) < 1
    inside_zone = (sample[0].away > 2 * (sample[0].reach + 0.5))[sample[0].cell >= 0]
    np.testing.assert_allclose(gap[inside_zone], 0, atol=0.01)


def test_lines_keep_their_width_and_go_to_lines():
    start, sample, texture, _ = started()
    row, column = (np.rint(start.position[..., axis]).astype(int) % sample[0].shape[axis] for axis in (0, 1))
    shown = sample[0].away[row, column]
    near = (texture[0].cell >= 0) & (texture[0].away < texture[0].reach)
    gap = np.abs(shown - texture[0].away)[near]
    assert gap.mean() < 0.5 and np.percentile(gap, 95) < 1.2


@pytest.mark.parametrize("inside", ["radial", "scale"])
def test_a_texel_shows_a_place_in_the_cell_its_own_is_given(inside):
    start, sample, texture, dealt = started(inside)
    deep = (texture[0].cell >= 0) & (texture[0].away > 1)
    row, column = (np.rint(start.position[..., axis]).astype(int) % sample[0].shape[axis] for axis in (0, 1))
    right = sample[0].cell[row, column] == dealt.source[texture[0].cell]
    assert right[deep].mean() > 0.98


def test_turn_and_scale_are_those_of_the_middle():
    start, sample, texture, dealt = started("scale")
    maps, own = texture
    place = np.stack(np.mgrid[: maps.shape[0], : maps.shape[1]], axis=-1)
    rho = np.hypot(*np.moveaxis(place - own.centre[maps.cell], 2, 0))
    middle = (maps.cell >= 0) & (own.depth == 0)[maps.cell] & (rho < 0.6 * own.inner[maps.cell])
    middle &= maps.away > 2 * (maps.reach + 0.5)
    size = np.array(sample[0].shape)
    for offset in ((0, 1), (1, 0)):
        both = middle & np.roll(middle, (-offset[0], -offset[1]), (0, 1))
        both &= maps.cell == np.roll(maps.cell, (-offset[0], -offset[1]), (0, 1))
        step = np.roll(start.position, (-offset[0], -offset[1]), (0, 1)) - start.position
        step -= np.rint(step / size) * size
        cosine, sine = np.cos(start.turn), np.sin(start.turn)
        expected = np.stack([offset[0] * cosine + offset[1] * sine, offset[1] * cosine - offset[0] * sine], axis=-1)
        assert both.sum() > 100 and np.abs(start.turn[both]).max() > 1
        np.testing.assert_allclose(step[both], (expected / start.scale[..., None])[both], atol=2e-3)


def test_the_papers_radial_warping_keeps_proportions_along_rays():
    start, sample, texture, dealt = started(lines="nearest")
    (_, its), (maps, own) = sample, texture
    inner = (maps.closeness == 0) & (maps.cell >= 0) & (own.depth == 0)[maps.cell]
    place = np.stack(np.nonzero(inner), axis=1)
    cell = maps.cell[inner]
    out = place - own.centre[cell]
    into = start.position[inner] - its.centre[dealt.source[cell]]
    into -= np.rint(into / sample[0].shape) * sample[0].shape
    turn = dealt.turn[cell]
    gap = np.arctan2(into[:, 0], into[:, 1]) - np.arctan2(out[:, 0], out[:, 1]) - turn
    far = np.hypot(*out.T) > 2
    assert np.abs((gap + np.pi) % (2 * np.pi) - np.pi)[far].max() < 1e-2

    def share(shapes: CellShapes, cell: np.ndarray, ray: np.ndarray) -> np.ndarray:
        along = ray / np.abs(ray).sum(axis=1)[:, None]
        t = np.where(along[:, 1] < 0, 2 - along[:, 0], along[:, 0]) % 4
        at = t * shapes.rim.shape[1] / 4
        low = shapes.rim[cell, np.floor(at).astype(int) % shapes.rim.shape[1], 0]
        return np.hypot(*ray.T) / low

    ratio = share(its, dealt.source[cell], into)[far] / share(own, cell, out)[far]
    np.testing.assert_allclose(ratio, 1, atol=0.15)
    assert np.abs(ratio - 1).mean() < 0.02


def test_the_papers_scaling_lays_the_circle_around_into_the_circle_within():
    start, sample, texture, dealt = started("scale", "nearest")
    (_, its), (maps, own) = sample, texture
    inner = (maps.closeness == 0) & (maps.cell >= 0) & (own.depth == 0)[maps.cell]
    cell = maps.cell[inner]
    out = np.hypot(*(np.stack(np.nonzero(inner), axis=1) - own.centre[cell]).T)
    into = start.position[inner] - its.centre[dealt.source[cell]]
    into = np.hypot(*(into - np.rint(into / sample[0].shape) * sample[0].shape).T)
    by = its.inner[dealt.source[cell]] / own.outer[cell]
    np.testing.assert_allclose(into, out * by, atol=0.01)


def test_the_papers_edges_show_the_nearest_closeness_and_of_equal_ones_any():
    start, sample, texture, _ = started(lines="nearest")
    near = texture[0].closeness > 0
    row, column = (np.rint(start.position[..., axis]).astype(int)[near] for axis in (0, 1))
    asked, shown = texture[0].closeness[near], sample[0].closeness[row, column]
    known = np.unique(sample[0].closeness[sample[0].closeness > 0])
    best = np.abs(known - asked[:, None]).min(axis=1)
    np.testing.assert_allclose(np.abs(shown - asked), best, atol=1e-7)
    place = row * sample[0].shape[1] + column
    assert len(np.unique(place)) > 1.5 * len(np.unique(shown))
    again = started(lines="nearest", seed=4)[0]
    assert (again.position != start.position)[near].any()


@pytest.mark.parametrize("lines", ["carried", "nearest"])
def test_a_window_is_made_anew_as_the_whole(lines):
    start, sample, texture, dealt = started(lines=lines)
    other = Start(*(np.copy(getattr(start, field.name)) for field in fields(Start)))
    window = (slice(20, 90), slice(35, 120))
    for field in fields(Start):
        getattr(other, field.name)[window] = 99
    Initialization(lines=lines).again(other, sample, texture, dealt, window=window, seed=3)
    for field in fields(Start):
        np.testing.assert_array_equal(getattr(other, field.name), getattr(start, field.name))


def test_texels_of_no_cell_show_the_sample_mirrored():
    start, sample, texture, _ = started()
    rows, columns = sample[0].shape
    none = texture[0].cell < 0
    assert none[:, columns:].any()
    place = np.stack(np.nonzero(none), axis=1) % (2 * np.array((rows, columns)))
    expected = np.minimum(place, 2 * np.array((rows, columns)) - 1 - place)
    np.testing.assert_array_equal(start.position[none], expected)


def test_positions_stay_in_the_sample():
    for lines in ("carried", "nearest"):
        start, sample, *_ = started(lines=lines)
        assert (start.position >= -0.5).all() and (start.position < np.array(sample[0].shape) - 0.5).all()
        assert start.sources.position.shape == (170 * 150, 1, 2)


@needs_data
@pytest.mark.parametrize(
    "name, inside", [("bricks-red-128", "radial"), ("scales-green-cells-192", "radial"), ("metal-bumps-192", "scale")]
)
def test_what_suits_a_sample_follows_from_the_detail_in_its_cells(name, inside):
    exemplar = read_exemplar(DATA / "exemplars" / f"{name}.png")
    graph = detect(exemplar)
    assert best_inside(match_image(exemplar), feature_maps(graph, graph.cells())) == inside


def laid(matrix: np.ndarray, rows: int = 30, columns: int = 40) -> Start:
    """The sample shown through one linear map all over."""
    place = np.stack(np.mgrid[:rows, :columns], axis=-1) @ np.array(matrix).T
    even = np.ones((rows, columns), np.float32)
    return Start(place.astype(np.float32), 0 * even, even)


@pytest.mark.parametrize(
    ("along", "across", "bent"),
    [(1, 1, False), (0.8, 0.8, False), (3, 3, False), (1.4, 1, False), (1.6, 1, True), (0.5, 0.5, True), (-1, 1, True)],
)
@pytest.mark.parametrize("turn", [0.0, 0.7, -2.5])
def test_what_is_stretched_or_enlarged_is_drawn_out(along: float, across: float, bent: bool, turn: float) -> None:
    """Texels of the sample from one texel to the next, along a direction and across it, then turned."""
    cosine, sine = np.cos(turn), np.sin(turn)
    rotation = np.array([[cosine, sine], [-sine, cosine]])
    lean = np.array([[np.cos(0.4), -np.sin(0.4)], [np.sin(0.4), np.cos(0.4)]])
    start = laid(rotation @ lean @ np.diag([along, across]) @ lean.T)
    window = slice(0, 30), slice(5, 25)
    found, turns = start.drawn_out(window, wrap=False)
    assert found.shape == (30, 20) and (found == bent).all()
    if bent and along > 0:
        np.testing.assert_allclose(np.cos(turns - turn), 1, atol=1e-4)
    part, _ = start.drawn_out((slice(10, 11), slice(7, 8)), wrap=False)
    assert part.shape == (1, 1) and part[0, 0] == bent


def test_a_torus_is_looked_at_across_its_border() -> None:
    start = laid(np.eye(2))
    window = slice(0, 30), slice(0, 40)
    assert not start.drawn_out(window, wrap=False)[0].any()
    torn = start.drawn_out(window, wrap=True)[0]
    assert torn[[0, -1], 1:-1].all() and torn[1:-1, [0, -1]].all() and not torn[1:-1, 1:-1].any()
    one = start.position[:1, :1]
    assert not Start(one, one[..., 0], one[..., 0]).drawn_out((slice(0, 1), slice(0, 0)), wrap=False)[0].any()
