"""Curves through drawn lines keep near them, are few, and never cross where the lines do not."""

import numpy as np
import pytest

from texloom.sketch.bezier import points_at
from texloom.sketch.reading.fitting import curved, fit
from texloom.sketch.reading.labels import borders
from texloom.sketch.reading.lines import Lines, noded, tidy


def test_one_cubic_gives_itself_back():
    curve = np.array([[[0.0, 0], [10, 30], [35, 30], [40, 0]]])
    even = np.linspace(0, 1, 60)
    points = points_at(np.repeat(curve, 60, axis=0), even)
    fitted, first, last, chain = fit(points, np.array([0, 60]), np.array([0.2]), np.ones(60, bool))
    assert len(fitted) == 1 and (first[0], last[0], chain[0]) == (0, 59, 0)
    t = np.linspace(0, 1, 200)
    dense = points_at(np.repeat(fitted, 200, axis=0), t)
    drawn = points_at(np.repeat(curve, 2000, axis=0), np.linspace(0, 1, 2000))
    off = np.hypot(*(dense[:, None] - drawn).transpose(2, 0, 1))
    assert off.min(axis=1).max() < 0.2


def test_corners_stay_corners():
    square = np.array([[0.0, 0], [30, 0], [30, 30], [0, 30]])
    graph = curved((40.0, 40.0), tidy(square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]])), tolerance=0.2)
    np.testing.assert_allclose(graph.cells().area, [900], rtol=0.01)
    assert 4 <= len(graph.edges) <= 10


def test_zero_tolerance_is_the_drawing_itself():
    points = np.array([[0.0, 0], [1, 0.3], [2, 0], [4, 5]])
    curves, *_ = fit(points, np.array([0, 4]), np.zeros(1), np.array([True, False, True, True]))
    np.testing.assert_allclose(curves[:, [0, 3]], [[[0, 0], [2, 0]], [[2, 0], [4, 5]]])


@pytest.mark.parametrize("seed", range(4))
def test_loose_curves_through_a_tangle_do_not_cross(seed):
    rng = np.random.default_rng(seed)
    walk = np.cumsum(rng.normal(0, 4, (300, 2)), axis=0)
    lines = noded(walk, np.stack([np.arange(299), np.arange(1, 300)], axis=1), weld=1e-3)
    graph = curved((100.0, 100.0), lines, tolerance=3.0)
    assert len(graph.crossings()) == 0
    assert len(graph.cells()) == len(lines.edges) - len(lines.vertices) + 1  # Euler: one connected walk


def test_noded_lines_meet_at_vertices_only():
    rng = np.random.default_rng(5)
    place = rng.uniform(0, 50, (60, 2))
    lines = noded(place, rng.integers(0, 60, (60, 2)), weld=1e-6)
    again = noded(lines.vertices, lines.edges, weld=1e-6)
    assert len(again.vertices) == len(lines.vertices) and len(again.edges) == len(lines.edges)


def test_chains_hold_every_edge_once():
    edges = np.array([[0, 1], [1, 2], [2, 3], [2, 4], [5, 6], [6, 7], [7, 5]])
    lines = Lines(np.random.default_rng(0).random((8, 2)), edges)
    chains = lines.chains
    assert sorted(map(tuple, np.sort(chains.ends, axis=1).tolist())) == [(0, 2), (2, 3), (2, 4), (5, 5)]
    length = np.hypot(*(lines.vertices[edges[:, 0]] - lines.vertices[edges[:, 1]]).T)
    np.testing.assert_allclose(lines.lengths.sum(), length.sum())


def test_borders_of_labels_enclose_their_areas():
    down, across = np.mgrid[:40, :60]
    labels = (down // 20) * 3 + across // 20
    labels[np.hypot(down - 20, across - 30) < 9] = 6
    lines = borders(labels, shortest=0.0)
    graph = curved((40.0, 60.0), lines, tolerance=0.7)
    np.testing.assert_allclose(graph.cells().area, [(labels == 6).sum()], rtol=0.03)


def test_forks_of_a_thick_crossing_are_drawn_together():
    down, across = np.mgrid[:40, :60]
    labels = (down // 20) * 2 + (across + 2 * (down // 20)) // 30
    assert (borders(labels, shortest=0.0).degree == 4).sum() == 0
    assert (borders(labels, shortest=3.0).degree == 4).sum() == 1
