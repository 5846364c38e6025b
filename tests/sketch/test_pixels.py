"""Texels near lines fit better than before, from where their kind lies, turned as their lines run."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, map_coordinates

from tests.sketch.test_design import SAMPLE, base, torus
from tests.sketch.test_sample import GRAPH, picture
from texloom.demo.samples import draw
from texloom.domain.grid import Grid
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import from_array
from texloom.kernels.launch import thread_count, use
from texloom.sketch.design import Design
from texloom.sketch.filling.kinds import Assignment
from texloom.sketch.filling.maps import FeatureMaps, feature_maps
from texloom.sketch.filling.pixels import PixelSynthesis, _every_other
from texloom.sketch.filling.shapes import cell_shapes
from texloom.sketch.filling.warp import Initialization, Start
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.sample import SketchSample
from texloom.synthesis.canvas import Canvas

ZONE = 3  # texels beyond the reach of the maps where texels still choose


def run(design: Design, pixels: PixelSynthesis) -> Canvas:
    return design.changed(pixels=pixels).canvas


def cost(design: Design, canvas: Canvas, reach: int = 2) -> np.ndarray:
    """Mean squared difference of what surrounds each texel from what surrounds its source, one offset after another."""
    shape, image = design.maps.shape, SAMPLE.image
    shown = canvas.colour.reshape(*shape, -1)
    total, number = np.zeros(shape), np.zeros(shape)
    cosine, sine = np.cos(canvas.turn), np.sin(canvas.turn)
    for down in range(-reach, reach + 1):
        for across in range(-reach, reach + 1):
            row = canvas.position[:, 0] + cosine * down + sine * across
            column = canvas.position[:, 1] + cosine * across - sine * down
            there = [map_coordinates(c, [row, column], order=1, mode="nearest") for c in np.moveaxis(image, 2, 0)]
            here = np.roll(shown, (-down, -across), (0, 1))
            known = np.roll(np.ones(shape), (-down, -across), (0, 1)) > 0
            if not design.maps.wrap:
                r, c = np.indices(shape)
                known = (0 <= r + down) & (r + down < shape[0]) & (0 <= c + across) & (c + across < shape[1])
            total += known * ((np.stack(there, axis=1).reshape(here.shape) - here) ** 2).sum(axis=2)
            number += known
    return total / number


def regions(maps: FeatureMaps, kinds: np.ndarray) -> np.ndarray:
    """0 near lines, 1 + kind elsewhere."""
    return np.where(maps.closeness > 0, 0, 1 + np.append(kinds, 0)[maps.cell])


@pytest.mark.parametrize("design", [base, torus])
@pytest.mark.parametrize("turned", [True, False])
def test_passes_fit_better_and_better(design, turned):
    start = run(design(), PixelSynthesis(passes=0))
    near = design().maps.away <= design().maps.reach + ZONE
    left = [cost(design(), start)[near].mean()]
    for passes in (1, 2, 4):
        left.append(cost(design(), run(design(), PixelSynthesis(passes=passes, turned=turned)))[near].mean())
    assert left[1] < 0.8 * left[0]
    assert left[2] < 0.95 * left[1] and left[3] <= left[2]


@pytest.mark.parametrize("design", [base, torus])
def test_only_texels_near_lines_or_drawn_out_change_and_each_to_its_kind(design):
    one = design()
    canvas = run(one, PixelSynthesis(passes=3, alike=2))
    rows, columns = one.maps.shape
    bent, _ = one.start.drawn_out((slice(0, rows), slice(0, columns)), wrap=one.maps.wrap)
    near = (one.maps.away.ravel() <= one.maps.reach + ZONE) | bent.ravel()
    assert bent.any() and not near.all()
    differs = (canvas.position != one.start.position.reshape(-1, 2)).any(axis=1)
    assert not differs[~near].any() and 0.1 < differs[near].mean() < 1
    np.testing.assert_array_equal(canvas.turn[~near], one.start.turn.ravel()[~near])
    row, column = np.rint(canvas.position[differs]).astype(int).T
    its = regions(SAMPLE.maps, SAMPLE.kinds.of_cell)[row, column]
    own = regions(one.maps, one.kinds).ravel()[differs]
    np.testing.assert_array_equal(its, own)
    assert set(own) == {0, 1, 2}


@pytest.mark.parametrize("design", [base, torus])
def test_without_passes_the_start_is_shown(design):
    one = design()
    canvas = run(one, PixelSynthesis(passes=0))
    np.testing.assert_array_equal(canvas.position, one.start.position.reshape(-1, 2))
    np.testing.assert_array_equal(canvas.turn, one.start.turn.ravel())
    for channel in range(SAMPLE.image.shape[2]):
        there = map_coordinates(SAMPLE.image[..., channel], canvas.position.T, order=1, mode="nearest")
        np.testing.assert_allclose(canvas.colour[:, channel], there, atol=1e-6)


def test_threads_change_no_source():
    threads = thread_count()
    found = []
    try:
        for count in (1, 2):
            use(threads=count)
            found.append(run(torus(), PixelSynthesis(passes=3, alike=2)))
    finally:
        use(threads=threads)
    for name in ("position", "turn", "colour"):
        np.testing.assert_array_equal(getattr(found[0], name), getattr(found[1], name))


@pytest.mark.parametrize("sample", [picture(GRAPH), draw("pebbles", size=64, seed=3)])
def test_a_sample_shown_as_it_is_stays(sample):
    drawn = SketchSample.of([sample], [GRAPH])
    place = np.moveaxis(np.mgrid[: sample.shape[0], : sample.shape[1]], 0, -1).astype(np.float32)
    flat = np.zeros(drawn.maps.shape, np.float32)
    start = Start(place, flat, flat + 1)
    pixels = PixelSynthesis(passes=2, alike=2)
    kinds = drawn.kinds.of_cell
    canvas = pixels.run(pixels.guide(drawn.exemplar, drawn.image, drawn.maps, kinds), drawn.maps, start, kinds)
    np.testing.assert_array_equal(canvas.position, place.reshape(-1, 2))
    assert not canvas.turn.any()


def test_a_rolled_torus_gives_a_rolled_texture():
    """By an even number of texels, so that the parts of a pass stay the same; places across the border count."""
    one, by = torus(), (28, 30)
    pixels = PixelSynthesis(passes=2)

    def rolled(arrays, names):
        return replace(arrays, **{name: np.roll(getattr(arrays, name), by, (0, 1)) for name in names})

    maps = rolled(one.maps, ("closeness", "toward", "nearest", "away", "cell"))
    start = rolled(one.start, ("position", "turn", "scale"))
    canvas = pixels.run(one.guide, maps, start, one.kinds)
    expected = run(one, pixels)
    for name in ("position", "turn", "colour"):
        value = getattr(expected, name).reshape(*maps.shape, -1)
        np.testing.assert_array_equal(getattr(canvas, name).reshape(value.shape), np.roll(value, by, (0, 1)))


def test_a_plane_does_not_see_across_its_border():
    """What lies beyond a border of a torus is no part of a plane: the same maps give another texture there, only."""
    one, pixels = torus(), PixelSynthesis(passes=1)
    flat = pixels.run(one.guide, replace(one.maps, wrap=False), one.start, one.kinds)
    differs = (flat.position != run(one, pixels).position).any(axis=1).reshape(one.maps.shape)
    assert differs.any() and not differs[8:-8, 8:-8].any()


@pytest.mark.parametrize("inside", ["radial", "scale"])
@pytest.mark.parametrize("lines", ["carried", "nearest"])
def test_masked_texels_are_never_shown(inside, lines):
    mask = np.ones((72, 64), bool)
    mask[20:50, 10:34] = False
    sample = SketchSample.of([picture(GRAPH, mask=mask)], [GRAPH])
    laid = Initialization(inside=inside, lines=lines)
    design = torus().changed(sample=sample, pattern=None, initialization=laid, pixels=PixelSynthesis(passes=2))
    row, column = np.rint(design.canvas.position).astype(int).T
    assert mask[row, column].all()


def stripes(*, along: int, closed: bool, side: int = 72, pitch: int = 12) -> CellGraph:
    """Lines along an axis from border to border, as cells or alone."""
    at = np.arange(0, side + 1, pitch) - 0.5
    ends = np.array([-0.5, side - 0.5])
    vertices = np.stack(np.meshgrid(at, ends, indexing="ij"), axis=-1).reshape(-1, 2)
    first = 2 * np.arange(len(at))
    edges = [np.stack([first, first + 1], axis=1)]
    if closed:
        edges += [np.stack([first[:-1] + end, first[1:] + end], axis=1) for end in (0, 1)]
    return straight((side, side), vertices if along else vertices[:, ::-1], np.concatenate(edges))


@pytest.mark.parametrize("turned", [True, False])
def test_lines_across_those_of_the_sample_show_them_turned(turned):
    ripple = np.abs(np.sin(np.pi * (np.arange(72) + 0.5) / 12))[:, None]
    grain = gaussian_filter(np.random.default_rng(0).normal(0, 1, (72, 72)), 0.7) * 0.03
    shown = np.rint(255 * np.clip(0.2 + 0.6 * ripple + grain, 0, 1)).astype(np.uint8)
    sample = SketchSample.of([from_array(shown)], [stripes(along=1, closed=True)])
    lines = stripes(along=1, closed=False)  # alone: at its border the sample shows none
    its = feature_maps(lines, lines.cells(), blur=sample.maps.blur)
    its = replace(its, toward=its.nearest)  # eq. 11 leans inwards at a border
    across = stripes(along=0, closed=True)
    cells = across.cells()
    maps, shapes = feature_maps(across, cells), cell_shapes(across, cells)
    as_it_lies = Assignment(np.full(len(cells), len(sample.cells) // 2, np.int32), np.zeros(len(cells), np.float32))
    start = Initialization(lines="nearest").run((its, sample.shapes), (maps, shapes), as_it_lies, seed=1)
    pixels = PixelSynthesis(passes=4, alike=2, turned=turned)
    guide = pixels.guide(sample.exemplar, sample.image, its, sample.kinds.of_cell)
    canvas = pixels.run(guide, maps, start, np.zeros(len(cells), np.int32))
    near = (maps.closeness > 0) & (np.abs(np.indices(maps.shape) - 35.5).max(axis=0) < 28)
    turn = canvas.turn.reshape(maps.shape)[near]
    right = np.abs(np.sin(turn)) > np.sin(np.deg2rad(75))
    assert right.mean() > 0.7 if turned else not turn.any()


@pytest.mark.parametrize("wrong", [{"window": 4}, {"window": 1}, {"passes": -1}, {"alike": -1}])
def test_what_makes_no_sense_is_refused(wrong):
    with pytest.raises(ParameterError):
        PixelSynthesis(**wrong)


def test_every_other_texel_is_compared_and_the_middle_is():
    around = Grid(9, 9, wrap=True).neighbourhoods(np.array([40], np.int32), 2)
    compared = around.offset[0][_every_other(around)]
    assert sorted(map(tuple, compared)) == [(r, c) for r in range(-2, 3) for c in range(-2, 3) if (r + c) % 2 == 0]
    whole = run(base(), PixelSynthesis(sparse=False))
    assert (run(base(), PixelSynthesis()).position != whole.position).any()
