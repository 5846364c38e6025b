"""Samples: several lie apart and are kinds, colours tell kinds, what is masked is known."""

import numpy as np
import pytest

from tests.sketch.drawn import voronoi
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.sketch.filling.maps import feature_maps
from texloom.sketch.graph import CellGraph
from texloom.sketch.random import random_cells
from texloom.sketch.sample import SketchSample

GRAPH = voronoi(36, 4, (72.0, 64.0))


def picture(graph: CellGraph, *, hue: int = 0, seed: int = 0, mask: np.ndarray | None = None) -> Exemplar:
    """Dark lines along the edges of a graph, between cells of one hue, each lit a little otherwise, with grain."""
    maps = feature_maps(graph, graph.cells())
    draw = np.random.default_rng(seed)
    light = np.append(draw.uniform(0.6, 0.9, len(graph.cells())), 0.7)[maps.cell]
    light += draw.normal(0, 0.04, light.shape)
    light *= np.clip((maps.away + 0.5) / 3, 0.1, 1)
    share = np.full(3, 0.5)
    share[hue] = 1
    return from_array(np.rint(255 * np.clip(light[..., None] * share, 0, 1)).astype(np.uint8), mask=mask)


def two_colours(shape: tuple[int, int], *, down: bool = False) -> np.ndarray:
    """Black to the left and white to the right, or above and below."""
    half = np.indices(shape)[0 if down else 1] >= shape[0 if down else 1] / 2
    return np.repeat(half[..., None], 3, axis=2).astype(np.float32)


def share_to_the_right(cell: np.ndarray, count: int) -> np.ndarray:
    """Of the texels of each cell; NaN where it has none."""
    row, column = np.nonzero(cell >= 0)
    right = column >= cell.shape[1] / 2
    texels = np.bincount(cell[row, column], minlength=count)
    return np.bincount(cell[row, column], right, count) / np.where(texels, texels, np.nan)


def test_one_sample_is_of_one_kind_and_keeps_its_drawing():
    sample = SketchSample.of([picture(GRAPH)], [GRAPH])
    np.testing.assert_array_equal(sample.graph.vertices, GRAPH.vertices)
    np.testing.assert_array_equal(sample.cells.area, GRAPH.cells().area)
    assert not sample.kinds.of_cell.any() and len(sample.kinds.palette) == 1 and sample.unmasked.all()
    area, size = GRAPH.cells().area, sample.cell_size
    np.testing.assert_allclose(sample.shapes.relative, area / size**2)
    assert area[area < size**2 * 0.999].sum() < area.sum() / 2 <= area[area < size**2 * 1.001].sum()


def test_a_drawing_is_stretched_over_its_sample():
    sample = SketchSample.of([picture(GRAPH)], [GRAPH.resized((36.0, 128.0))])
    assert sample.graph.size == (72.0, 64.0) and sample.maps.shape == (72, 64)
    np.testing.assert_allclose(sample.graph.vertices, GRAPH.vertices, atol=1e-9)


def test_several_samples_lie_apart_and_each_is_a_kind():
    graphs = [GRAPH, voronoi(9, 5, (40.0, 90.0)), voronoi(12, 6, (56.0, 48.0))]
    sample = SketchSample.of([picture(graph, hue=n) for n, graph in enumerate(graphs)], graphs)
    parts, kinds = sample.exemplar.parts, sample.kinds
    assert len(parts) == 3 and sample.graph.size == tuple(map(float, sample.exemplar.shape))
    np.testing.assert_array_equal(np.bincount(kinds.of_cell), [len(graph.cells()) for graph in graphs])
    for number, (part, graph) in enumerate(zip(parts, graphs, strict=True)):
        cell = sample.maps.cell[part.slices]
        assert (kinds.of_cell[cell[cell >= 0]] == number).all()
        expected = feature_maps(graph, graph.cells()).cell
        np.testing.assert_array_equal(cell >= 0, expected >= 0)
        assert sample.cells.area[kinds.of_cell == number].sum() == pytest.approx(graph.cells().area.sum())
    inside = np.zeros(sample.exemplar.shape, bool)
    for part in parts:
        inside[part.slices] = True
    assert not inside.all() and not sample.exemplar.usable[~inside].any()


@pytest.mark.parametrize("count", [2, 8, 9, 16])
def test_the_colours_of_samples_differ(count):
    graph = voronoi(6, 1, (16.0, 16.0))
    palette = SketchSample.of([picture(graph)] * count, [graph] * count).kinds.palette
    apart = np.abs(palette[:, None] - palette).max(axis=2) + np.eye(count)
    assert len(palette) == count and apart.min() >= 0.25


def test_colours_over_one_sample_tell_kinds():
    sample = SketchSample.of([picture(GRAPH)], [GRAPH], colours=two_colours((9, 8)))
    assert sorted(sample.kinds.palette[:, 0]) == [0, 1]
    right = sample.kinds.palette[sample.kinds.of_cell, 0]
    share = share_to_the_right(sample.maps.cell, len(sample.cells))
    sure = np.abs(share - 0.5) > 0.1
    assert sure.sum() > 10
    np.testing.assert_array_equal(right[sure], share[sure] > 0.5)


def test_a_cell_with_one_masked_texel_is_masked():
    mask = np.ones((72, 64), bool)
    mask[36, 30] = False
    sample = SketchSample.of([picture(GRAPH, mask=mask)], [GRAPH])
    assert sample.maps.cell[36, 30] >= 0
    np.testing.assert_array_equal(np.flatnonzero(~sample.unmasked), [sample.maps.cell[36, 30]])


def test_cells_of_a_small_and_a_large_sample_are_typical_of_their_own():
    """Ten of one size and many of another: both are shown as often as their share of the deal is."""
    coarse, fine = voronoi(16, 2, (90.0, 90.0)), voronoi(140, 3, (90.0, 90.0))
    sample = SketchSample.of([picture(coarse), picture(fine, hue=1)], [coarse, fine])
    alone = [SketchSample.of([picture(graph)], [graph]).cell_size for graph in (coarse, fine)]
    np.testing.assert_allclose(sample.cell_size, np.sqrt(np.prod(alone)))
    relative = sample.shapes.relative
    for number, size in enumerate(alone):
        its = sample.owner == number
        np.testing.assert_allclose(relative[its], sample.cells.area[its] / size**2)


def test_samples_without_cells_do_not_count():
    open_lines = CellGraph((72.0, 64.0), GRAPH.vertices[:2], np.array([[0, 1]], np.int32), np.ones((1, 3, 2)))
    alone = SketchSample.of([picture(GRAPH)], [GRAPH])
    beside = SketchSample.of([picture(GRAPH)] * 2, [open_lines, GRAPH])
    np.testing.assert_allclose(beside.cell_size, alone.cell_size)
    np.testing.assert_allclose(beside.shapes.relative, alone.shapes.relative)
    none = SketchSample.of([picture(GRAPH)], [open_lines])
    assert len(none.shapes) == 0
    with pytest.raises(ExemplarError, match="the sample has no cells"):
        _ = none.cell_size


def test_a_mask_that_leaves_no_cell_whole_is_refused():
    mask = np.indices((72, 64)).sum(axis=0) % 5 > 0
    with pytest.raises(ExemplarError, match="leave some of them whole"):
        SketchSample.of([picture(GRAPH, mask=mask)], [GRAPH])


def test_as_many_drawings_as_samples_and_colours_for_one():
    one = picture(GRAPH)
    with pytest.raises(ParameterError, match="1 cell meshes for 2 samples"):
        SketchSample.of([one, one], [GRAPH])
    with pytest.raises(ParameterError, match="map of kinds is for one sample"):
        SketchSample.of([one, one], [GRAPH, GRAPH], colours=two_colours((4, 4)))


def test_a_drawing_on_a_torus_joins_up_or_is_refused():
    graph = random_cells((64.0, 64.0), cell=14, seed=1)
    try:
        found = SketchSample.of([picture(graph)], [graph]).graph
    except ParameterError:
        return
    gap = found.vertices[found.edges[:, 0]] + found.curve[:, 2] - found.vertices[found.edges[:, 1]]
    gap -= np.rint(gap / found.size) * found.size * found.wrap
    np.testing.assert_allclose(gap, 0, atol=1e-9)
