"""Pictures of elements drawn over one another are refused, those of cells beside each other are not."""

import numpy as np
import pytest
from PIL import Image, ImageDraw

from examples.sketches import arcs, drawn, honeycomb, stars
from tests.sketch.drawn import voronoi, wall
from texloom.errors import FileError
from texloom.sketch.reading.drawing import graph_of_drawing

SCALES = [1, 2]
CELLS = {
    "arcs": arcs,
    "stars": stars,
    "honeycomb": honeycomb,
    "wall": lambda: wall(16, 7),
    "voronoi": lambda: voronoi(60, 1),
}


def ovals(boxes: np.ndarray, size: int, *, filled: bool = False, width: int = 2) -> np.ndarray:
    """Outlines in black: centres and radii, row by column; one covers those before if ``filled``."""
    picture = Image.new("L", (size, size), 255)
    pen = ImageDraw.Draw(picture)
    for row, column, down, across in boxes:
        box = [column - across, row - down, column + across, row + down]
        pen.ellipse(box, outline=0, fill=255 if filled else None, width=width)
    return np.asarray(picture, np.float32) / 255


def circles(scale: int, width: int = 2) -> np.ndarray:
    centres = [[70, 70], [80, 110], [120, 90], [130, 140], [150, 60]]
    return ovals(scale * np.array([[*centre, 40, 40] for centre in centres]), 200 * scale, width=width)


def ellipses(scale: int, *, filled: bool = False) -> np.ndarray:
    rng = np.random.default_rng(0)
    return ovals(400 * scale * rng.uniform([0, 0, 0.04, 0.04], [1, 1, 0.11, 0.11], (40, 4)), 400 * scale, filled=filled)


def rules(bend: float, spacing: int) -> np.ndarray:
    """Two families of curves that cross at right angles, in a picture of 300 texels."""
    picture = Image.new("L", (300, 300), 255)
    pen = ImageDraw.Draw(picture)
    along = np.linspace(0, 300, 50)
    for at in range(spacing // 2, 300, spacing):
        across = at + bend * np.sin(along / 300 * 2 * np.pi)
        pen.line(np.stack([along, across], axis=1).ravel().tolist(), fill=0, width=2)
        pen.line(np.stack([across, along], axis=1).ravel().tolist(), fill=0, width=2)
    return np.asarray(picture, np.float32) / 255


def web() -> np.ndarray:
    """Rings that straight spokes cross, but for the innermost."""
    rings = ovals(np.array([[150, 150, r, r] for r in range(20, 145, 24)]), 300)
    picture = Image.fromarray(np.uint8(255 * rings))
    pen = ImageDraw.Draw(picture)
    for angle in np.arange(20) * np.pi / 10 + 0.1:
        out = np.array([np.cos(angle), np.sin(angle)])
        pen.line([*(150 + 20 * out), *(150 + 200 * out)], fill=0, width=2)
    return np.asarray(picture, np.float32) / 255


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("picture", [circles, ellipses])
def test_outlines_that_run_through_each_other_are_sent_elsewhere(picture, scale):
    with pytest.raises(FileError, match="overlap.*refine or optimize"):
        graph_of_drawing(picture(scale))


def test_outlines_that_bend_much_within_their_ink_are_followed():
    with pytest.raises(FileError, match="overlap"):
        graph_of_drawing(circles(1, width=4))


@pytest.mark.parametrize("scale", SCALES)
def test_outlines_that_end_where_another_covers_them_bound_cells(scale):
    graph, _ = graph_of_drawing(ellipses(scale, filled=True))
    assert len(graph.cells()) > 20


@pytest.mark.parametrize("name", CELLS)
@pytest.mark.parametrize("scale", SCALES)
def test_cells_beside_each_other_are_read(name, scale):
    graph = CELLS[name]()
    rows, columns = graph.size
    picture = drawn(graph.resized((scale * rows, scale * columns)))[..., 0]
    assert len(graph_of_drawing(picture.astype(np.float32) / 255)[0].cells()) > 12


@pytest.mark.parametrize("bend", [0.0, 12.0])
@pytest.mark.parametrize("spacing", [15, 30, 60])
def test_rules_that_cross_bound_cells(bend, spacing):
    assert len(graph_of_drawing(rules(bend, spacing))[0].cells()) > 0.9 * (300 // spacing - 1) ** 2


def test_straight_spokes_may_cross_rings():
    assert len(graph_of_drawing(web())[0].cells()) >= 100
