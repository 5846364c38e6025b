"""Outlines have their cells' areas and points in common."""

import numpy as np
import pytest

from tests.sketch.drawn import voronoi, wall
from texloom.sketch.filling.outlines import outlines
from texloom.sketch.graph import CellGraph
from texloom.sketch.random import random_cells

GRAPHS = [voronoi(40, 3), random_cells((90.0, 120.0), cell=20, seed=2)]


@pytest.mark.parametrize("graph", GRAPHS)
def test_outlines_enclose_what_cells_measure(graph: CellGraph):
    cells = graph.cells()
    outline = outlines(graph, cells)
    a, b = outline.point, outline.point[outline.following]
    area = np.add.reduceat(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], outline.start[:-1]) / 2
    around = np.add.reduceat(np.hypot(*(b - a).T), outline.start[:-1])
    assert (np.abs(area - cells.area) < 0.1 * around).all()
    assert np.median(np.abs(area - cells.area) / cells.area) < 0.01


@pytest.mark.parametrize("graph", GRAPHS)
def test_neighbours_share_points_to_the_bit(graph: CellGraph):
    outline = outlines(graph, graph.cells())
    size = np.array(graph.size)
    key = [outline.point, outline.point[outline.following]]
    if graph.wrap:
        middle = np.floor((key[0] + key[1] + 1) / 2 / size) * size
        key = [end - middle for end in key]
    forth, back = np.concatenate(key, axis=1), np.concatenate(key[::-1], axis=1)
    shared = np.isin([each.tobytes() for each in forth], [each.tobytes() for each in back])
    sides = graph.cells().of_halfedge(len(graph.edges)).reshape(-1, 2)
    assert shared.sum() == 2 * (sides >= 0).all(axis=1).sum()  # straight edges: a chord each


def test_the_spread_of_a_rectangle_is_that_of_even_mass():
    graph = wall(4, 3)
    cells = graph.cells()
    whole = np.isclose(cells.area, 12 * 30)
    spread = outlines(graph, cells).spread(cells.centroid)[whole]
    np.testing.assert_allclose(spread, np.tile(np.diag([12**2, 30**2]) / 12, (whole.sum(), 1, 1)), atol=1e-4)


def test_a_place_lies_in_its_cell_alone():
    graph = GRAPHS[1]
    cells = graph.cells()
    outline = outlines(graph, cells)
    size = np.array(graph.size)
    found = [outline.around(place % size, period=graph.size) for place in cells.centroid]
    assert all(len(each) == 1 for each in found)
    assert np.mean([each[0] == i for i, each in enumerate(found)]) > 0.95  # all but what is bent like a crescent


def test_many_points_are_as_kernels_take_them():
    """More than fit NumPy's small temporaries: then it gives sums the order of what they were made of."""
    graph = random_cells((2000.0, 2000.0), cell=25, seed=1)
    point = outlines(graph, graph.cells()).point
    assert len(point) > 2**15 and point.flags.c_contiguous
