"""Sketches of cells drawn by code, and pictures of cells."""

import numpy as np
from jaxtyping import Float64

from examples.pictures import Picture
from texloom.io.svg import Strokes
from texloom.sketch.filling.maps import feature_maps
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.strokes import graph_of

PAPER = (200.0, 200.0)  # texels

_THIRDS = np.linspace(0, 1, 4)[:, None]


def arcs(width: float = 40.0, height: float = 32.0) -> CellGraph:
    """Rows of arcs, the ends of each on the tops of the next."""
    arc = np.array([[0, 0], [-height, 0], [-height, width], [0, width]])
    places = [[0.75 * height * row, width * (column + row % 2 / 2)] for row in range(11) for column in range(-1, 6)]
    return _sketch(np.array([arc + place for place in places]))


def stars(side: float = 36.0) -> CellGraph:
    """Lines in three directions: hexagons with triangles between them."""
    lines = []
    for angle in np.pi / 3 * np.arange(3):
        along, across = np.array([np.sin(angle), np.cos(angle)]), np.array([np.cos(angle), -np.sin(angle)])
        middles = np.array(PAPER) / 2 + across * side * 3**0.5 * (np.arange(-5, 6)[:, None] + 0.5)
        lines.append(middles[:, None] + along * PAPER[0] * (3 * _THIRDS - 1.5))
    return _sketch(np.concatenate(lines))


def honeycomb(side: float = 16.0) -> CellGraph:
    """Hexagons."""
    turns = np.pi / 3 * (np.arange(7) + 0.5)
    corners = side * np.stack([np.sin(turns), np.cos(turns)], axis=1)
    hexagon = corners[:-1, None] + _THIRDS * np.diff(corners, axis=0)[:, None]
    places = np.array(
        [[1.5 * row, 3**0.5 * (column + row % 2 / 2)] for row in range(-1, 12) for column in range(-1, 10)]
    )
    return _sketch((hexagon + side * places[:, None, None]).reshape(-1, 4, 2))


def drawn(graph: CellGraph) -> Picture:
    """The lines of a graph, on paper."""
    ink = np.clip(1.5 - feature_maps(graph, graph.cells()).away, 0, 1)
    return np.repeat((255 - 200 * ink)[..., None], 3, axis=2).astype(np.uint8)


def _sketch(curves: Float64[np.ndarray, "curve 4 2"]) -> CellGraph:
    """Each curve drawn on its own."""
    return graph_of(Strokes(PAPER, curves, np.arange(len(curves) + 1)))[0]
