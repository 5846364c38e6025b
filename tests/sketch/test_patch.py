from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tests.sketch.drawn import euler, voronoi, wall
from texloom.errors import ParameterError
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.mesh.cutting import cut, reaching_border
from texloom.sketch.mesh.facets import faceted
from texloom.sketch.mesh.matching import match_crops
from texloom.sketch.mesh.patch import random_crops, seamless_patch
from texloom.sketch.mesh.seam import mirrored, seamless


def length(graph: CellGraph) -> float:
    return float(np.hypot(*graph.curve[:, 2].T).sum())


def test_a_sketch_that_tiles_is_taken_whole() -> None:
    sketch = wall(6, 3)
    patch = seamless_patch(sketch, 0)
    assert patch.cost == 0 and not patch.mirrored and patch.note is None
    assert patch.graph.wrap and patch.graph.size == sketch.size
    assert len(patch.graph.cells()) == 18 and euler(patch.graph) == 0
    np.testing.assert_allclose(patch.graph.cells().area, 12 * 30)
    assert length(patch.graph) == pytest.approx(length(sketch))


def test_lines_a_little_short_of_the_border_reach_it() -> None:
    sketch = wall(6, 3)
    at_border = (sketch.vertices[:, 1] == -0.5) & (sketch.degree == 1)
    short = sketch.moved(sketch.vertices + at_border[:, None] * np.array([0.0, 1.5]))
    assert reaching_border(short).vertices[at_border, 1].max() < -0.5
    assert seamless_patch(short, 0).cost == 0


def test_a_regular_sketch_is_cut_where_it_repeats() -> None:
    sketch = cut(wall(10, 6), np.array([3.0, 8, 104, 160])).graph  # neither side a whole number of bricks
    patch = seamless_patch(sketch, 0)
    assert patch.cost > 0
    rows, columns = patch.graph.size
    assert rows / 24 == pytest.approx(round(rows / 24), abs=0.1) and columns / 30 == pytest.approx(
        round(columns / 30), abs=0.1
    )
    assert len(patch.graph.cells()) == round(rows / 12) * round(columns / 30)
    area = patch.graph.cells().area
    np.testing.assert_allclose(area, area.mean(), rtol=0.15)


def test_vertices_beside_the_seam_meet_half_way_and_the_others_follow() -> None:
    # One line through the left side at row 30 and the right side at row 34; its ends 4 rows apart too
    vertices = np.array([[29.5, -20.0], [29.5, 20], [33.5, 80], [33.5, 120], [49.5, 50], [-10, 50], [110, 50]])
    edges = np.array([[0, 1], [1, 4], [4, 2], [2, 3], [5, 4], [4, 6]])
    branches = np.array([[20.0, -30], [20, 25], [20, 75], [20, 130], [40, -30], [40, 130]])
    vertices = np.concatenate([vertices, branches])
    edges = np.concatenate([edges, [[0, 7], [1, 8], [2, 9], [3, 10], [0, 11], [3, 12]]])
    sketch = straight((100, 100), vertices, edges)
    piece = cut(sketch, np.array([-0.5, -0.5, 99.5, 99.5]))
    torus = seamless(sketch, piece)
    assert torus is not None
    centre = torus.vertices[torus.degree == 4][0]
    left, right = (torus.vertices[np.abs(torus.vertices[:, 1] - column).argmin()] for column in (20, 80))
    # 1 and 2 have 3 and 0 for counterparts, 2 (1) rows and 20 - (120 - 100) = 0 columns away
    np.testing.assert_allclose(left, [31.5, 20], atol=1e-9)
    np.testing.assert_allclose(right, [31.5, 80], atol=1e-9)
    held = np.array([[29.5, -0.5], [29.5, 20], [33.5, 80], [33.5, 99.5], [-0.5, 50], [99.5, 50]])
    weight = 1 / np.hypot(*(held - vertices[4]).T)
    expected = vertices[4, 0] + (weight * [2, 2, -2, -2, 0, 0]).sum() / weight.sum()
    np.testing.assert_allclose(centre, [expected, 50], atol=1e-9)


def test_a_piece_and_its_mirror_images_are_seamless() -> None:
    sketch = voronoi(20, seed=1)
    piece = cut(sketch, np.array([11.0, 13, 171, 153]))
    assert not piece.matches
    whole = mirrored(piece)
    assert whole.size == (320, 280) and euler(whole) == 0
    assert not len(whole.crossings())
    assert whole.cells().area.sum() == pytest.approx(320 * 280)
    assert length(whole) == pytest.approx(4 * length(piece.graph))


def test_where_no_piece_matches_itself_the_patch_is_mirrored(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("texloom.sketch.mesh.patch.random_crops", lambda size, seed: np.zeros((0, 4)))
    vertices = np.array([[50.0, -1], [50, 60], [20, 100], [80, 100]])  # one line comes in, two go out
    sketch = straight((100, 100), vertices, np.array([[0, 1], [1, 2], [1, 3]]))
    patch = seamless_patch(sketch, 0)
    assert patch.mirrored and patch.graph.wrap and not len(patch.graph.crossings())


def test_lines_too_close_to_be_cut_are_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("texloom.sketch.mesh.patch._bent", lambda sketch, seed: iter(()))
    sketch = straight((60, 60), np.array([[2.0, 30], [55, 30], [2, 31], [55, 29]]), np.array([[0, 1], [2, 3]]))
    with pytest.raises(ParameterError, match="draw them further apart"):
        seamless_patch(sketch, 0)


def test_a_sketch_of_nothing_is_refused() -> None:
    with pytest.raises(ParameterError, match="no edges"):
        seamless_patch(straight((9, 9), np.zeros((0, 2)), np.zeros((0, 2), int)), 0)


def test_long_edges_are_noted() -> None:
    assert seamless_patch(voronoi(60, seed=2), 0).note is None
    note = seamless_patch(voronoi(5, seed=2), 0).note
    assert note is not None and "longer than a third of the sketch (67 texels)" in note


def test_the_best_crop_costs_no_more_than_those_that_could_be_bent() -> None:
    sketch = voronoi(30, seed=5)
    patch = seamless_patch(sketch, 0)
    costs = match_crops(reaching_border(sketch), random_crops(sketch.size, 0)).cost
    assert patch.cost <= np.median(costs[np.isfinite(costs)])


def pieces(graph: CellGraph) -> int:
    """Connected ones."""
    count = len(graph.vertices)
    joined = coo_array((np.ones(len(graph.edges)), graph.edges.T), (count, count))
    return connected_components(joined, directed=False)[0]


@settings(max_examples=20, deadline=None)
@example(count=12, seed=24)
@given(count=st.integers(4, 60), seed=st.integers(0, 10**6))
def test_any_sketch_with_cells_becomes_a_closed_torus(count: int, seed: int) -> None:
    sketch = voronoi(count, seed)
    try:
        patch = seamless_patch(sketch, seed)
    except ParameterError as error:
        assert len(sketch.cells()) < 2 and "no piece of the sketch goes on as closed cells" in str(error)
        return
    islands = pieces(patch.graph) - 1  # in cells of a mirrored sketch: they divide no ground
    assert not len(patch.graph.crossings()) and euler(patch.graph) == islands and (not islands or patch.mirrored)
    assert (patch.graph.degree > 0).all()
    np.testing.assert_array_equal(patch.web.loose, patch.web.strands.free)
    assert (np.linalg.det(patch.web.sides) > 0).all()
    assert np.linalg.det(patch.web.sides).sum() / 2 == pytest.approx(np.prod(patch.graph.size))


def test_curves_that_part_at_a_sharp_angle_become_chords_and_others_stay() -> None:
    # From (10, 10) a curve bends away from the line beside it; one further off is alone
    vertices = np.array([[10.0, 10], [10, 40], [30, 40], [50, 10], [50, 40]])
    graph = straight((64, 64), vertices, np.array([[0, 1], [0, 2], [3, 4]]))
    curve = graph.curve.copy()
    curve[1, 0], curve[2, 0] = [1, 8], [8, 8]
    bent = faceted(replace(graph, curve=curve))
    np.testing.assert_array_equal(bent.curve[:2], curve[[0, 2]])
    chords = bent.curves[2:]
    np.testing.assert_allclose(chords[:-1, 3], chords[1:, 0])
    np.testing.assert_allclose((chords[0, 0], chords[-1, 3]), vertices[[0, 2]])
    np.testing.assert_allclose(np.diff(chords, n=2, axis=1), 0, atol=1e-9)
    assert len(chords) > 3 and not len(bent.crossings())


def test_of_several_sketches_the_best_crop_is_taken() -> None:
    sketches = voronoi(60, seed=2), wall(6, 3), voronoi(40, seed=5)
    patch = seamless_patch(sketches, 0)
    alone = seamless_patch(sketches[1], 0)
    assert patch.sketch == 1 and patch.cost == 0 and patch.note is None
    np.testing.assert_array_equal(patch.graph.vertices, alone.graph.vertices)
    costs = [seamless_patch(sketch, 0).cost for sketch in sketches[::2]]
    others = seamless_patch(sketches[::2], 0)
    assert others.cost == min(costs) and others.sketch == np.argmin(costs)


def test_several_sketches_lie_apart_on_one_page() -> None:
    sketches = voronoi(60, seed=2), wall(6, 3), voronoi(40, seed=5, size=(90.0, 120.0))
    patch = seamless_patch(sketches, 0)
    top, left, bottom, right = patch.sheets.T
    np.testing.assert_allclose([bottom - top, right - left], np.transpose([sketch.size for sketch in sketches]))
    assert (left[1:] >= right[:-1]).all() and (np.diff(patch.joints[:, 0]) >= 0).all()
    for sheet, sketch in zip(patch.sheets, sketches, strict=True):
        on_it = patch.joints[((patch.joints >= sheet[:2]) & (patch.joints <= sheet[2:])).all(axis=1)] - sheet[:2]
        own = seamless_patch(sketch, 0).joints + 0.5
        np.testing.assert_allclose(on_it[np.lexsort(on_it.T)], own[np.lexsort(own.T)], atol=1e-9)
