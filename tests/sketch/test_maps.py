"""Maps against slow ones, rolled tori, windows."""

from dataclasses import fields, replace

import numpy as np
import pytest

from tests.sketch.drawn import voronoi
from texloom.kernels.launch import thread_count, use
from texloom.sketch.filling.maps import FeatureMaps, _edges_within, changed, feature_maps, redraw
from texloom.sketch.filling.outlines import outlines
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.random import random_cells

GRAPHS = [voronoi(30, 1, (70.0, 90.0)), random_cells((60.0, 90.0), cell=18, seed=5)]


def star(points: int) -> CellGraph:
    """A star of thin rays in a square: behind a tip or a notch only one of its two edges tells the side."""
    turn = np.arange(2 * points) * np.pi / points + 0.1
    length = np.where(np.arange(2 * points) % 2, 9.0, 30.0)
    ring = 39.6 + length[:, None] * np.stack([np.sin(turn), np.cos(turn)], axis=1)
    square = np.array([[2.2, 2.2], [2.2, 77.2], [77.2, 77.2], [77.2, 2.2]])
    round_star, around = np.arange(2 * points), 2 * points + np.arange(4)
    edges = [np.stack([each, np.roll(each, -1)], axis=1) for each in (round_star, around)]
    return straight((80.0, 80.0), np.concatenate([ring, square]), np.concatenate(edges))


def maps_of(graph: CellGraph) -> FeatureMaps:
    return feature_maps(graph, graph.cells())


def texels(maps: FeatureMaps) -> np.ndarray:
    return np.stack(np.mgrid[: maps.shape[0], : maps.shape[1]], axis=-1).reshape(-1, 2).astype(float)


@pytest.mark.parametrize("graph", GRAPHS)
def test_the_nearest_edge_is_that_of_all_chords(graph: CellGraph):
    maps = maps_of(graph)
    chords = graph.flattened(0.02, margin=80.0)
    p, along = texels(maps)[:, None], chords.end - chords.start
    t = np.clip(((p - chords.start) * along).sum(axis=2) / np.maximum((along**2).sum(axis=1), 1e-20), 0, 1)
    gap = np.hypot(*np.moveaxis(chords.start + t[..., None] * along - p, 2, 0)).min(axis=1)
    np.testing.assert_allclose(maps.away.ravel(), gap, atol=0.26)
    assert np.abs(maps.away.ravel() - gap).mean() < 0.03
    np.testing.assert_allclose(maps.away, np.hypot(*np.moveaxis(maps.nearest, 2, 0)), atol=1e-5)


@pytest.mark.parametrize("graph", [*GRAPHS, star(5), star(9)])
def test_each_texel_is_in_the_cell_whose_outline_is_around_it(graph: CellGraph):
    cells, maps = graph.cells(), maps_of(graph)
    outline, clear = outlines(graph, cells), maps.away.ravel() > 0.3
    for place, cell in zip(texels(maps)[clear][::7], maps.cell.ravel()[clear][::7], strict=True):
        around = outline.around(place, period=graph.size if graph.wrap else None)
        assert cell == min(around, key=lambda each: cells.area[each], default=-1)


def test_of_nested_cells_the_inner_counts_and_the_outer_reaches_around_it():
    square = np.array([[0, 0], [0, 1], [1, 1], [1, 0]])
    ring = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    vertices = np.concatenate([square * 40 + 5.3, square * 10 + 20.3]).astype(float)
    graph = straight((50.0, 60.0), vertices, np.concatenate([ring, ring + 4]))
    maps = maps_of(graph)
    outer, inner = np.argsort(-graph.cells().area)
    assert maps.cell[25, 25] == inner
    assert maps.cell[10, 25] == maps.cell[18, 25] == maps.cell[25, 18] == outer
    assert maps.cell[2, 2] == maps.cell[25, 55] == -1
    np.testing.assert_array_equal(np.bincount(maps.cell[maps.cell >= 0])[[outer, inner]], [40 * 40 - 100, 100])


@pytest.mark.parametrize("graph", GRAPHS)
def test_closeness_and_orientation_follow_their_equations(graph: CellGraph):
    maps = maps_of(graph)
    rows, columns = maps.shape
    mask, reach = maps.away <= 0.5, maps.reach
    for row, column in ((0, 0), (31, 40), (rows - 1, 17), (12, columns - 1), (25, 60), (44, 8)):
        near = [(r, c) for r in range(row - reach, row + reach + 1) for c in range(column - reach, column + reach + 1)]
        inside = np.array([graph.wrap or (0 <= r < rows and 0 <= c < columns) for r, c in near])
        gap = np.array(near) - (row, column)
        across = np.array(near) % maps.shape
        back = np.array(near) % (2 * np.array(maps.shape))
        mirrored = np.minimum(back, 2 * np.array(maps.shape) - 1 - back)
        at = tuple((across if graph.wrap else mirrored).T)
        length = np.hypot(*gap.T)
        g = np.exp(-(length**2) / (2 * maps.blur**2)) * inside
        np.testing.assert_allclose(maps.closeness[row, column], (g * mask[at]).sum() / g.sum(), atol=1e-6)
        w = np.divide(maps.closeness[at], length, out=np.zeros_like(length), where=length > 0)
        expected = (w[:, None] * gap).sum(axis=0) / max(w.sum(), 1e-20)
        np.testing.assert_allclose(maps.toward[row, column], expected, atol=1e-4)


def test_a_rolled_torus_rolls_its_maps():
    graph = GRAPHS[1]
    maps, rolled = maps_of(graph), maps_of(replace(graph, vertices=graph.vertices + (17, -41)))
    np.testing.assert_allclose(rolled.away, np.roll(maps.away, (17, -41), (0, 1)), atol=1e-3)
    clear = rolled.away > 1e-3
    assert (rolled.cell == np.roll(maps.cell, (17, -41), (0, 1)))[clear].all()


@pytest.mark.parametrize("graph", [voronoi(60, 1), random_cells((140.0, 160.0), cell=18, seed=5)])
def test_a_window_around_a_moved_vertex_gives_the_whole_map(graph: CellGraph):
    cells, maps = graph.cells(), maps_of(graph)
    vertex = np.argmin(np.hypot(*(graph.vertices - (80, 70)).T))
    by = np.zeros_like(graph.vertices)
    by[vertex] = 1.5, -2.0
    after = graph.moved(graph.vertices + by)
    window = changed(maps, graph, after, cells)
    area = np.prod([span.stop - span.start for span in window])
    assert 0 < area < maps.away.size
    redraw(maps, after, cells, window=window)
    anew = feature_maps(after, cells, blur=maps.blur)
    for field in fields(FeatureMaps):
        np.testing.assert_allclose(getattr(maps, field.name), getattr(anew, field.name), atol=1e-6)


@pytest.mark.parametrize("graph", GRAPHS[:2])
def test_edges_within_a_rectangle_are_those_with_a_copy_there(graph: CellGraph):
    bounds = np.array([-22.0, 11.0]), np.array([9.0, 37.0])
    copies = [np.array([r, c]) * graph.size for r in range(-2, 3) for c in range(-2, 3) if graph.wrap or r == c == 0]
    low, high = graph.curves.min(axis=1), graph.curves.max(axis=1)
    there = [(((high + copy) >= bounds[0]) & ((low + copy) <= bounds[1])).all(axis=1) for copy in copies]
    expected = np.flatnonzero(np.any(there, axis=0))
    assert 0 < len(expected) < len(graph.edges)
    np.testing.assert_array_equal(_edges_within(graph, bounds), expected)


def test_nothing_moved_changes_nothing():
    graph = GRAPHS[0]
    window = changed(maps_of(graph), graph, graph, graph.cells())
    assert window == (slice(0, 0), slice(0, 0))


def test_without_edges_every_texel_is_far():
    graph = straight((20.0, 30.0), np.zeros((0, 2)), np.zeros((0, 2), np.int64))
    maps = maps_of(graph)
    assert (maps.away > 1e6).all() and (maps.cell == -1).all()
    assert not maps.closeness.any() and not maps.toward.any()


def test_threads_change_nothing():
    before = thread_count()
    maps = []
    for threads in (1, 4):
        use(threads=threads)
        maps.append(maps_of(GRAPHS[0]))
    use(threads=before)
    for field in fields(FeatureMaps):
        np.testing.assert_array_equal(getattr(maps[0], field.name), getattr(maps[1], field.name))
