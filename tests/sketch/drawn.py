"""Sketches drawn by code."""

import numpy as np
from scipy.spatial import Voronoi

from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.mesh.cutting import cut


def voronoi(count: int, seed: int, size: tuple[float, float] = (200.0, 200.0)) -> CellGraph:
    """The Voronoi cells of random points, cut off at the border of a drawing."""
    points = np.random.default_rng(seed).random((count, 2)) * size
    ring = np.array([[-9, -9], [-9, 0], [-9, 9], [0, -9], [0, 9], [9, -9], [9, 0], [9, 9]]) * max(size)
    cells = Voronoi(np.concatenate([points, ring]))
    used, edges = np.unique([ridge for ridge in cells.ridge_vertices if min(ridge) >= 0], return_inverse=True)
    whole = straight(size, cells.vertices[used] - 0.5, edges.reshape(-1, 2))
    return cut(whole, np.array([-0.5, -0.5, size[0] - 0.5, size[1] - 0.5])).graph


def wall(rows: int, columns: int, brick: tuple[float, float] = (12.0, 30.0)) -> CellGraph:
    """Straight courses of bricks, every other one shifted by half a brick; it ends at whole bricks, and so tiles."""
    size = (rows * brick[0], columns * brick[1])
    edges, at = [], {}

    def vertex(row: float, column: float) -> int:
        return at.setdefault((row, column), len(at))

    for row in range(rows):
        top, base = row * brick[0] + brick[0] / 2, (row + 1) * brick[0] + brick[0] / 2
        own = [(column + 0.25 + 0.5 * (row % 2)) * brick[1] for column in range(columns)]
        above = [(column + 0.25 + 0.5 * (1 - row % 2)) * brick[1] for column in range(columns)]
        course = [0.0, *sorted(own + above), size[1]]
        edges += [(vertex(top, a), vertex(top, b)) for a, b in zip(course, course[1:], strict=False)]
        for column in own:
            if base < size[0]:
                edges.append((vertex(top, column), vertex(base, column)))
            else:
                edges.append((vertex(top, column), vertex(size[0], column)))
                edges.append((vertex(0.0, column), vertex(brick[0] / 2, column)))
    return straight(size, np.array(list(at)) - 0.5, np.array(edges))


def euler(graph: CellGraph) -> int:
    """Vertices less edges plus cells: 0 for cells that close around a torus."""
    return len(graph.vertices) - len(graph.edges) + len(graph.cells())
