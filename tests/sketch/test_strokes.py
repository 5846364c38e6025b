"""Drawn strokes close to cells: each fault of a hand-drawn sketch alone, all files of the data, and scribbles."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.data import DATA, needs_data
from texloom.errors import FileError
from texloom.io.svg import Strokes, read_svg
from texloom.sketch.bezier import lines
from texloom.sketch.reading.strokes import graph_of

SIZE = (200.0, 200.0)
CELLS = {
    "bricks-512": 48,
    "cells-separate-polygons-512": 41,
    "cracker-cracks-512": 94,
    "jackfruit-hex-cells-512": 88,
    "jackfruit-pencil-photo-384": 31,
    "open-cells-gaps-512": 33,
    "voronoi-cells-512": 88,
    "voronoi-tileable-256": 15,
}


def strokes(*polylines) -> Strokes:
    """Polylines as strokes on a page of 200 x 200 texels."""
    runs = [lines(np.array(p[:-1], float), np.array(p[1:], float)) for p in polylines]
    return Strokes(SIZE, np.concatenate(runs), np.cumsum([0, *map(len, runs)]))


def rules(*, to: float = 199.5, shift: float = 0.0) -> list:
    """Nine lines across and nine down, twenty texels apart: 64 cells between them."""
    at = [20.0 * k + 19.5 + shift for k in range(9)]
    return [[[p, -0.5], [p, to]] for p in at] + [[[-0.5, p], [to, p]] for p in at]


def circle(centre, radius: float) -> list:
    angle = np.linspace(0, 2 * np.pi, 25)
    ring = np.array(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ring[-1] = ring[0]
    return ring.tolist()


def test_lines_that_cross_part_their_cells():
    graph, notes = graph_of(strokes(*rules()))
    cells = graph.cells()
    assert len(cells) == 64 and not notes
    np.testing.assert_allclose(cells.area, 400, rtol=1e-6)
    assert len(graph.crossings()) == 0


def test_a_gap_is_closed_and_told():
    drawn = rules()
    drawn[4] = [[99.5, -0.5], [99.5, 106.0]]
    graph, notes = graph_of(strokes(*drawn, [[99.5, 112.0], [99.5, 199.5]]))
    assert len(graph.cells()) == 64
    assert [note.what for note in notes] == ["closed a gap of 6 texels"]
    assert abs(notes[0].row - 99.5) < 2 and abs(notes[0].column - 109) < 2


def test_a_wide_gap_stays_open_and_its_strokes_go():
    drawn = rules()
    del drawn[4]
    graph, notes = graph_of(strokes(*drawn, [[99.5, 19.5], [99.5, 48.0]]))
    assert len(graph.cells()) == 57  # seven pairs of cells joined, the first two pairs of eight parted by the stub
    assert any("dropped an open stroke" in note.what and abs(note.row - 99.5) < 1 for note in notes)


def test_ends_beyond_a_fork_are_trimmed():
    graph, notes = graph_of(strokes(*rules(), [[109.5, 16.0], [109.5, 42.5]]))
    assert len(graph.cells()) == 65
    assert sum("trimmed an overshoot" in note.what for note in notes) == 2
    assert (graph.degree[np.abs(graph.vertices[:, 0] - 109.5) < 1] >= 2).all()


def test_lines_drawn_twice_are_one():
    rng = np.random.default_rng(0)
    again = [(np.array(p) + rng.normal(0, 0.4, (2, 2))).tolist() for p in rules()]
    graph, _ = graph_of(strokes(*rules(), *again))
    areas = graph.cells().area
    assert len(areas) == 64 and areas.min() > 300
    assert len(graph.crossings()) == 0


def test_outlines_drawn_apart_share_the_middle_between_them():
    at = [10.0 + 36 * k for k in range(5)]
    squares = [[[r, c], [r + 33, c], [r + 33, c + 33], [r, c + 33], [r, c]] for r in at for c in at]
    graph, _ = graph_of(strokes(*squares))
    cells = graph.cells()
    assert len(cells) == 25
    inner = np.abs(cells.centroid - 98.5).max(axis=1) < 60
    np.testing.assert_allclose(cells.area[inner], 36**2, rtol=0.05)


def test_curves_come_back_as_few_curves():
    graph, _ = graph_of(strokes(*[circle((r, c), 14.0) for r in (40, 100, 160) for c in (40, 100, 160)]))
    assert len(graph.cells()) == 9
    assert len(graph.edges) < 9 * 20


def test_overlapping_elements_are_sent_elsewhere():
    leaves = [circle((30.0 * r + 10, 30.0 * c + 10), 22.0) for r in range(7) for c in range(7)]
    with pytest.raises(FileError, match="overlap.*refine or optimize"):
        graph_of(strokes(*leaves))


def test_strokes_that_close_nothing_are_refused():
    with pytest.raises(FileError, match="closes no cell"):
        graph_of(strokes([[10, 10], [90, 120]], [[150, 20], [160, 90]]))


@needs_data
@pytest.mark.parametrize("name", CELLS)
def test_every_sketch_gives_its_cells(name):
    graph, notes = graph_of(read_svg(DATA / "sketches" / f"{name}.svg"))
    assert len(graph.cells()) == CELLS[name]
    assert len(graph.crossings()) == 0
    ends = graph.vertices[graph.degree == 1]
    from_border = np.minimum(ends + 0.5, np.array(graph.size) - 0.5 - ends).min(axis=1)
    assert len(ends) == 0 or from_border.max() < 8
    assert all(np.isfinite([note.row, note.column]).all() for note in notes)
    assert len({str(note) for note in notes}) == len(notes)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(["lines", "walks", "rings", "lattice", "curves"]))
def test_scribbles_end_in_cells_or_one_clear_line(seed, kind):
    rng = np.random.default_rng(seed)
    drawn = []
    for _ in range(rng.integers(1, 15)):
        if kind == "lines":
            points = rng.uniform(-20, 220, (rng.integers(2, 5), 2))
        elif kind == "walks":
            points = np.cumsum([rng.uniform(0, 200, 2), *rng.normal(0, 12, (rng.integers(1, 20), 2))], axis=0)
        elif kind == "rings":
            points = np.array(circle(rng.uniform(0, 200, 2), rng.uniform(2, 50)))
        elif kind == "lattice":
            points = np.round(rng.uniform(0, 200, (rng.integers(2, 6), 2)) / 25) * 25
        else:
            points = rng.uniform(0, 200, (2, 2))
        curves = lines(points[:-1], points[1:])
        curves[:, 1:3] += rng.normal(0, 60, (len(curves), 2, 2)) * (kind == "curves")
        curves = curves[(curves[:, 0] != curves[:, 3]).any(axis=1)]
        if len(curves):
            drawn.append(curves)
    if not drawn:
        return
    try:
        graph, _ = graph_of(Strokes(SIZE, np.concatenate(drawn), np.cumsum([0, *map(len, drawn)])))
    except FileError as error:
        assert "closes no cell" in str(error) or "overlap" in str(error)
        return
    assert len(graph.cells()) and len(graph.crossings()) == 0
    assert np.isfinite(graph.vertices).all() and np.isfinite(graph.curve).all()
