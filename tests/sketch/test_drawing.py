"""Pictures of drawings give the cells that their strokes give, whatever the light."""

import numpy as np
import pytest
from PIL import Image, ImageDraw
from scipy.spatial import cKDTree

from tests.data import DATA, needs_data
from texloom.errors import FileError
from texloom.io.svg import read_svg
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.drawing import graph_of_drawing, is_drawing, read_drawing
from texloom.sketch.reading.read import read_sketch
from texloom.sketch.reading.strokes import graph_of

SKETCHES = sorted(path.stem for path in (DATA / "sketches").glob("*.svg"))


def page(gap: float = 0.0, width: int = 3) -> np.ndarray:
    """White paper with a grid of 25 whole cells, thirty texels a side; a gap in the middle of one side."""
    picture = Image.new("L", (200, 200), 255)
    pen = ImageDraw.Draw(picture)
    for at in range(25, 200, 30):
        pen.line([at, 0, at, 199], fill=20, width=width)
        pen.line([0, at, 199, at], fill=20, width=width)
    pen.rectangle([85 - 2, 100 - gap / 2, 85 + 2, 100 + gap / 2], fill=255 if gap else 20)
    return np.asarray(picture, np.float32) / 255


def mean_distance(graph: CellGraph, other: CellGraph) -> float:
    """Texels from the lines of one graph to those of another, where both have cells."""
    share = np.linspace(0, 1, 50)[:, None, None]
    chords = other.flattened(0.05)
    line = (chords.start + share * (chords.end - chords.start)).reshape(-1, 2)
    return float(np.median(cKDTree(line).query(graph.flattened(0.05).start)[0]))


def test_cells_are_those_drawn():
    graph, notes = graph_of_drawing(page())
    cells = graph.cells()
    assert len(cells) == 25 and not notes and not len(graph.crossings())
    np.testing.assert_allclose(cells.area, 900, rtol=0.05)
    assert (graph.degree == 4).sum() == 36


def test_a_gap_is_closed_and_told():
    graph, notes = graph_of_drawing(page(gap=8))
    assert len(graph.cells()) == 25
    assert [note.what.startswith("closed a gap") for note in notes] == [True]
    assert abs(notes[0].row - 100) < 3 and abs(notes[0].column - 85) < 3


def test_a_wide_gap_is_left_open():
    graph, notes = graph_of_drawing(page(gap=20))
    assert len(graph.cells()) == 24
    assert not any("closed" in note.what for note in notes)


@pytest.mark.parametrize("seed", range(3))
def test_light_and_grain_change_no_cell(seed):
    rng = np.random.default_rng(seed)
    down, across = np.mgrid[:200, :200] / 200
    lit = page() * (0.45 + 0.4 * down + 0.15 * across) + rng.normal(0, 0.03, (200, 200))
    graph, _ = graph_of_drawing(np.clip(lit, 0, 1).astype(np.float32))
    assert len(graph.cells()) == 25


def test_chalk_on_a_board_is_read_too():
    assert len(graph_of_drawing(1 - page())[0].cells()) == 25


def test_double_lines_are_one():
    picture = Image.fromarray(np.uint8(page() * 255))
    pen = ImageDraw.Draw(picture)
    for at in range(25, 200, 30):
        pen.line([at + 5, 0, at + 5, 199], fill=20, width=2)
    graph, _ = graph_of_drawing(np.asarray(picture, np.float32) / 255)
    assert len(graph.cells()) == 25


@pytest.mark.parametrize("picture", [np.full((60, 60), 0.7, np.float32), page()[:, :20]])
def test_what_shows_no_cells_is_refused(picture):
    with pytest.raises(FileError, match="no lines|closes no cell"):
        graph_of_drawing(picture)


def test_leaves_over_leaves_are_sent_elsewhere():
    picture = Image.new("L", (512, 512), 255)
    pen = ImageDraw.Draw(picture)
    for row, column in np.random.default_rng(3).uniform(-8, 8, (49, 2)) + 64 * np.mgrid[:7, :7].reshape(2, -1).T + 40:
        pen.ellipse([column - 50, row - 20, column + 50, row + 20], outline=0, width=3)
    with pytest.raises(FileError, match="overlap"):
        graph_of_drawing(np.asarray(picture, np.float32) / 255)


def test_transparent_paper_is_white(tmp_path):
    ink = np.zeros((200, 200, 4), np.uint8)
    ink[..., 3] = np.uint8(255 * (1 - page()))
    Image.fromarray(ink).save(tmp_path / "ink.png")
    np.testing.assert_allclose(read_drawing(tmp_path / "ink.png"), page(), atol=0.01)


def test_a_sketch_is_stretched_to_a_size(tmp_path):
    Image.fromarray(np.uint8(page(gap=8) * 255)).save(tmp_path / "ink.png")
    graph, notes = read_sketch(tmp_path / "ink.png", size=(400.0, 100.0))
    assert graph.size == (400.0, 100.0) and len(graph.cells()) == 25
    assert abs(notes[0].row - 200) < 6 and abs(notes[0].column - 42) < 3


@needs_data
@pytest.mark.parametrize("name", SKETCHES)
def test_picture_and_strokes_agree(name):
    picture, _ = read_sketch(DATA / "sketches" / f"{name}.png")
    strokes, _ = graph_of(read_svg(DATA / "sketches" / f"{name}.svg"))
    assert abs(len(picture.cells()) - len(strokes.cells())) <= 0.1 * len(strokes.cells())
    assert len(picture.crossings()) == 0
    assert mean_distance(picture, strokes) < (3.5 if "photo" in name else 1.0)


@needs_data
@pytest.mark.parametrize("name", ["pebbles-grey-242", "scales-green-cells-192", "text-newsprint-256"])
def test_photographs_are_no_drawings(name):
    assert not is_drawing(read_drawing(DATA / "exemplars" / f"{name}.png"))
    assert is_drawing(page())
