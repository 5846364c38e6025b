"""Rims, centres and measures of cells whose shape is known."""

import numpy as np
import pytest

from tests.sketch.drawn import voronoi, wall
from texloom.sketch.cells import again
from texloom.sketch.filling.shapes import cell_shapes, moved_shapes
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.random import random_cells


def polygon(points: list[tuple[float, float]]) -> CellGraph:
    """One cell in a drawing of 100 texels."""
    index = np.arange(len(points))
    return straight((100.0, 100.0), np.array(points, float), np.stack([index, np.roll(index, -1)], axis=1))


def test_the_rim_of_a_square_is_where_rays_leave_it():
    graph = polygon([(30, 20), (70, 20), (70, 60), (30, 60)])
    shapes = cell_shapes(graph, graph.cells())
    np.testing.assert_allclose(shapes.centre, [[50, 40]])
    bins = shapes.rim.shape[1]
    t = np.arange(bins) * 4 / bins
    row, column = 1 - np.abs((t + 1) % 4 - 2), np.abs(t - 2) - 1
    length = np.hypot(row, column)
    steep = np.maximum(np.abs(row), np.abs(column)) / length
    np.testing.assert_allclose(shapes.rim[0, :, 0], 20 / steep, rtol=1e-4)
    np.testing.assert_allclose(
        np.delete(shapes.rim[0, :, 1], np.flatnonzero(np.abs(row) == np.abs(column))),
        np.delete(steep, np.flatnonzero(np.abs(row) == np.abs(column))),
        rtol=1e-4,
    )
    np.testing.assert_allclose([shapes.inner[0], shapes.outer[0]], [20, 20 * np.sqrt(2)], rtol=1e-4)
    assert shapes.depth[0] == 0 and shapes.whole[0]


def test_length_and_direction_of_a_turned_rectangle():
    turn, half = 0.4, np.array([(-8, -24), (8, -24), (8, 24), (-8, 24)])
    row = half[:, 0] * np.cos(turn) + half[:, 1] * np.sin(turn)
    column = half[:, 1] * np.cos(turn) - half[:, 0] * np.sin(turn)
    graph = polygon(list(zip(row + 50, column + 50, strict=True)))
    shapes = cell_shapes(graph, graph.cells())
    np.testing.assert_allclose(shapes.elongation, np.log(3), rtol=1e-5)
    np.testing.assert_allclose(shapes.axis, turn, rtol=1e-5)


def test_a_crescent_is_seen_whole_from_nowhere_and_an_angle_from_its_corner():
    around = np.linspace(0.3, 2 * np.pi - 0.3, 40)
    outer = [(50 + 40 * np.cos(t), 50 + 40 * np.sin(t)) for t in around]
    inner = [(50 + 32 * np.cos(t), 50 + 32 * np.sin(t)) for t in around[::-1]]
    graph = polygon(outer + inner)
    shapes = cell_shapes(graph, graph.cells())
    assert 3 < shapes.depth[0] <= 4

    angle = polygon([(10, 10), (90, 10), (90, 30), (30, 30), (30, 90), (10, 90)])
    shapes = cell_shapes(angle, angle.cells())
    assert shapes.depth[0] == 0
    assert (shapes.centre < 30).all()


@pytest.mark.parametrize("left, whole", [(-0.5, False), (0.0, False), (2.0, True)])
def test_a_cell_at_the_border_is_cut(left: float, whole: bool):
    graph = polygon([(10, left), (40, left), (40, 50), (10, 50)])
    assert cell_shapes(graph, graph.cells()).whole[0] == whole


def test_no_cell_of_a_torus_is_cut():
    torus = random_cells((80.0, 80.0), cell=20, seed=1)
    assert cell_shapes(torus, torus.cells()).whole.all()


def test_a_brick_has_the_corners_of_the_six_around_it():
    graph = wall(8, 6)
    cells = graph.cells()
    inside = (np.abs(cells.centroid - (47.5, 89.5)) < (24, 45)).all(axis=1)
    assert inside.sum() > 5
    assert (cell_shapes(graph, cells).corners[inside] == 6).all()


@pytest.mark.parametrize("seed", [1, 2])
def test_rims_enclose_the_area_of_cells_that_are_convex(seed: int):
    graph = voronoi(30, seed)
    shapes = cell_shapes(graph, graph.cells())
    assert not shapes.depth.any()
    t = np.arange(shapes.rim.shape[1]) * 4 / shapes.rim.shape[1]
    angle = np.unwrap(np.arctan2(1 - np.abs((t + 1) % 4 - 2), np.abs(t - 2) - 1))
    step = np.diff(angle, append=angle[0] + 2 * np.pi)
    length = shapes.rim[:, :, 0]
    area = (length * np.roll(length, -1, axis=1) * np.sin(step)).sum(axis=1) / 2
    np.testing.assert_allclose(area, shapes.area, rtol=0.03)


def test_a_graph_without_cells_has_no_shapes():
    graph = straight((20.0, 20.0), np.array([[1.0, 1], [9, 9]]), np.array([[0, 1]]))
    assert len(cell_shapes(graph, graph.cells())) == 0


def test_shapes_of_cells_that_moved_are_those_made_anew():
    graph = random_cells((90.0, 110.0), cell=18, seed=4)
    cells = graph.cells()
    vertices = graph.vertices.copy()
    vertices[:3] += 1.5
    after = graph.moved(vertices)
    measured = again(after, cells)
    which = measured.beside(after.moved_from(graph))
    assert 3 <= len(which) < len(cells) / 2
    found, wanted = moved_shapes(cell_shapes(graph, cells), after, measured, which), cell_shapes(after, measured)
    for name, values in vars(wanted).items():
        np.testing.assert_allclose(getattr(found, name), values, rtol=1e-5, atol=1e-5, err_msg=name)
    np.testing.assert_array_equal(found.rim[which], wanted.rim[which])
    nothing = moved_shapes(found, after, measured, which[:0])
    np.testing.assert_array_equal(nothing.rim, found.rim)
