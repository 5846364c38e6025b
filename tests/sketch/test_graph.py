"""Cells of known graphs, crossings against a naive oracle, and what moving vertices does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom.sketch.bezier import pieces, points_at
from texloom.sketch.cells import _walks
from texloom.sketch.crossing import meetings
from texloom.sketch.graph import CellGraph, straight

KAPPA = 4 / 3 * (np.sqrt(2) - 1)  # control points of a quarter circle


def square_grid(rows: int, columns: int, side: float = 10.0) -> CellGraph:
    """So many square cells, nothing beyond them."""
    place = np.array([(r, c) for r in range(rows + 1) for c in range(columns + 1)], float)
    number = np.arange(len(place)).reshape(rows + 1, columns + 1)
    down = np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1)
    across = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1)
    return straight((rows * side + 1, columns * side + 1), place * side, np.concatenate([down, across]))


def torus(seed: int, side: int = 6, jitter: float = 3.0) -> CellGraph:
    """Jittered squares of ten texels on a torus."""
    r, c = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    place = np.stack([r, c], axis=2).reshape(-1, 2) * 10.0
    place += np.random.default_rng(seed).uniform(-jitter, jitter, place.shape)
    number = r * side + c
    down = np.stack([number.ravel(), np.roll(number, -1, 0).ravel()], axis=1)
    across = np.stack([number.ravel(), np.roll(number, -1, 1).ravel()], axis=1)
    return straight((side * 10.0, side * 10.0), place, np.concatenate([down, across]), wrap=True)


def disc(radius: float) -> CellGraph:
    """A circle of four arcs."""
    vertices = radius * np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]])
    tangents = radius * KAPPA * np.array([[0.0, 1], [-1, 0], [0, -1], [1, 0]])
    heads = np.roll(vertices, -1, axis=0)
    curve = np.stack([tangents, heads - np.roll(tangents, -1, axis=0) - vertices, heads - vertices], axis=1)
    edges = np.array([[0, 1], [1, 2], [2, 3], [3, 0]], np.int32)
    return CellGraph((1.0, 1.0), vertices, edges, curve)


def test_squares_have_their_areas_and_middles():
    cells = square_grid(2, 3).cells()
    assert len(cells) == 6
    np.testing.assert_allclose(cells.area, 100)
    middles = sorted(map(tuple, np.round(cells.centroid, 9).tolist()))
    assert middles == [(r, c) for r in (5.0, 15.0) for c in (5.0, 15.0, 25.0)]


def test_walks_run_counter_clockwise_on_the_screen():
    graph = square_grid(1, 1)
    cells = graph.cells()
    places = graph.vertices[graph.edges.ravel()[cells.halfedge]]
    ahead = np.roll(places, -1, axis=0) - places
    down_then_right = np.flatnonzero(ahead[:, 0] > 0)[0]  # down the left side: the cell lies at the left of the walk
    assert places[down_then_right, 1] == 0 and ahead[(down_then_right + 1) % 4, 1] > 0


def test_curved_cells_have_curved_areas():
    graph = disc(7.0)
    cells = graph.cells()
    dense = graph.flattened(1e-6)
    a, b = dense.start, dense.end
    polygon = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()
    np.testing.assert_allclose(cells.area, [polygon], rtol=1e-5)
    np.testing.assert_allclose(cells.area, [np.pi * 49], rtol=1e-3)
    np.testing.assert_allclose(cells.centroid, [[0, 0]], atol=1e-9)


def test_edges_that_leave_side_by_side_are_told_by_their_bend():
    vertices = np.array([[0.0, 0], [0, 30]])
    ends = np.array([0.0, 30])
    curve = np.array([[[0, 10], [lift, 20], ends] for lift in (0.0, 12.0, -12.0)])
    graph = CellGraph((9.0, 9.0), vertices, np.zeros((3, 2), np.int32) + np.array([0, 1], np.int32), curve)
    cells = graph.cells()
    assert len(cells) == 2
    np.testing.assert_allclose(cells.area[0], cells.area[1])


def test_loose_ends_and_trees_are_no_cells():
    tree = straight((50.0, 50.0), np.array([[0.0, 0], [20, 3], [31, 17], [40, 1]]), np.array([[0, 1], [1, 2], [1, 3]]))
    assert len(tree.cells()) == 0
    assert len(straight((5.0, 5.0), np.zeros((0, 2)), np.zeros((0, 2), np.int64)).cells()) == 0


@given(st.permutations(range(24)))
def test_walks_are_the_cycles_in_order_of_their_lowest_members(following):
    start, member = _walks(np.array(following))
    cycles = []
    for first in range(24):
        if not any(first in cycle for cycle in cycles):
            cycles.append([first])
            while following[cycles[-1][-1]] != first:
                cycles[-1].append(following[cycles[-1][-1]])
    found = [member[a:b].tolist() for a, b in zip(start[:-1], start[1:], strict=True)]
    assert found == cycles and start[-1] == 24


def test_some_cells_are_those_alone():
    cells = torus(1).cells()
    which = np.array([20, 3, 4])
    some = cells.some(which)
    assert len(some) == 3
    for number, cell in enumerate(which):
        walk = cells.halfedge[cells.start[cell] : cells.start[cell + 1]]
        np.testing.assert_array_equal(some.halfedge[some.cell == number], walk)
    np.testing.assert_array_equal(some.centroid, cells.centroid[which])
    assert len(cells.some(which[:0])) == 0


def test_a_part_of_a_graph_has_the_chords_of_its_edges():
    graph, edges = torus(2), np.array([50, 7, 8])
    chords = graph.part(edges).flattened(0.1, margin=5.0)
    whole = graph.flattened(0.1, margin=5.0)
    for number, edge in enumerate(edges):
        np.testing.assert_array_equal(chords.start[chords.edge == number], whole.start[whole.edge == edge])


@pytest.mark.parametrize("seed", range(5))
def test_cells_cover_a_torus(seed):
    graph = torus(seed)
    cells = graph.cells()
    assert len(cells) == 36
    np.testing.assert_allclose(cells.area.sum(), 3600)
    assert len(graph.crossings()) == 0
    assert (np.bincount(cells.halfedge, minlength=144) == 1).all()  # every half-edge has one cell at its left


def test_rolling_a_torus_changes_no_cell():
    graph = torus(3)
    rolled = straight(graph.size, (graph.vertices + 17.3) % 60, graph.edges, wrap=True)
    np.testing.assert_allclose(np.sort(rolled.cells().area), np.sort(graph.cells().area))


@pytest.mark.parametrize("vertex", [0, 14, 35])
def test_a_vertex_pulled_across_its_neighbour_is_seen(vertex):
    graph = torus(0, jitter=0)
    cells = graph.cells()
    assert not graph.flipped(cells).any()
    far = graph.vertices.copy()
    far[vertex] += [3.0, 13.0]
    moved = graph.moved(far)
    assert len(moved.crossings())
    inside_out = graph.vertices.copy()
    inside_out[vertex] += [23.0, 23.0]
    assert graph.moved(inside_out).flipped(cells).any()


@pytest.mark.parametrize("by", [7.0, 17.3, 44.0])
def test_a_rolled_tangle_crosses_where_it_did(by):
    tangle = torus(2, jitter=9.0)
    pairs = tangle.crossings()
    rolled = straight(tangle.size, (tangle.vertices + by) % 60, tangle.edges, wrap=True)
    assert len(pairs) > 10
    np.testing.assert_array_equal(rolled.crossings(), pairs)


def test_moving_keeps_ends_at_vertices():
    graph = torus(1)
    places = graph.vertices + np.random.default_rng(0).normal(0, 1, graph.vertices.shape)
    moved = graph.moved(places)
    heads = moved.curves[:, 3] - moved.vertices[moved.edges[:, 1]]
    np.testing.assert_allclose(heads, np.round(heads / 60) * 60, atol=1e-9)


@given(st.integers(0, 10**6))
def test_meetings_are_those_of_all_pairs(seed):
    rng = np.random.default_rng(seed)
    start = rng.uniform(0, 40, (24, 2))
    end = start + rng.normal(0, rng.choice([2, 15]), (24, 2))
    met = meetings(start, end)
    found = set(zip(met.first.tolist(), met.second.tolist(), strict=True))
    naive = set()
    for i in range(24):
        for j in range(i + 1, 24):
            matrix = np.stack([end[i] - start[i], start[j] - end[j]], axis=1)
            s, t = np.linalg.solve(matrix, start[j] - start[i])
            if 0 <= s <= 1 and 0 <= t <= 1:
                naive.add((i, j))
    assert found == naive
    on_first = start[met.first] + met.on_first[:, None] * (end - start)[met.first]
    on_second = start[met.second] + met.on_second[:, None] * (end - start)[met.second]
    np.testing.assert_allclose(on_first, on_second, atol=1e-6)


def test_segments_on_one_line_meet_where_they_overlap():
    start, end = np.array([[0.0, 0], [0, 4], [0, 11], [1, 0]]), np.array([[0.0, 10], [0, 20], [0, 12], [1, 9]])
    met = meetings(start, end)
    pairs = list(zip(met.first.tolist(), met.second.tolist(), strict=True))
    assert pairs == [(0, 1), (1, 2)]
    np.testing.assert_allclose(met.on_first[0], 0.7)


def test_chords_keep_within_tolerance_and_copies_reach_the_border():
    graph = disc(20.0)
    chords = graph.flattened(0.1)
    middle = points_at(graph.curves[chords.edge], (chords.first + chords.last) / 2)
    assert np.hypot(*(middle - (chords.start + chords.end) / 2).T).max() < 0.1
    wrapped = torus(0).flattened(0.1, margin=2.0)
    low, high = np.minimum(wrapped.start, wrapped.end), np.maximum(wrapped.start, wrapped.end)
    assert ((high >= -2.5) & (low <= 61.5)).all()
    assert len(wrapped.start) > len(torus(0).edges)


def test_a_piece_of_a_curve_lies_on_it():
    curve = np.random.default_rng(0).normal(0, 9, (1, 4, 2))
    part = pieces(curve, np.array([0.2]), np.array([0.7]))
    for t in (0.0, 0.3, 1.0):
        np.testing.assert_allclose(points_at(part, np.array([t])), points_at(curve, np.array([0.2 + 0.5 * t])))


def test_a_resized_graph_covers_the_resized_drawing():
    graph = square_grid(2, 2).resized((42.0, 84.0))
    np.testing.assert_allclose(graph.vertices.max(axis=0), [20.5 * 2 - 0.5, 20.5 * 4 - 0.5])
    np.testing.assert_allclose(graph.cells().area, 800)
