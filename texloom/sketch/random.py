"""Even cells at random, for textures without structure of their own."""

import numpy as np

from texloom import draws
from texloom.errors import ParameterError
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.reading.lines import joined

_PLACE = 0x7263  # purpose of the draws of the first points
_ROUNDS = 12  # of moving points to the middle of their cells: even, not yet a honeycomb
_NEAR = 6  # typical cells: no cell of random points is as wide
_FEWEST = 4  # cells: fewer wrap around onto themselves


def random_cells(size: tuple[float, float], *, cell: float, seed: int) -> CellGraph:
    """Voronoi cells of relaxed random points on a torus (Lloyd 1982), about ``cell`` texels across.

    Raises: ParameterError, if fewer than two cells fit across the shorter side.
    """
    rows, columns = size
    if not 0 < cell <= min(size) / 2:
        raise ParameterError(
            f"cells {cell:g} texels across do not tile {columns:g}x{rows:g}: use {min(size) / 2:g} or less"
        )
    count = max(round(rows * columns / cell**2), _FEWEST)
    index = np.arange(count)
    places = np.stack([draws.uniform(seed, _PLACE, axis, index=index) for axis in (0, 1)], axis=1).astype(np.float64)
    points = places * size
    for _ in range(_ROUNDS):
        points = _middles(points, size)
    return _voronoi(points, size)


def _copies(points: np.ndarray, size: tuple[float, float]) -> np.ndarray:
    """The points, then their copies a period away that lie within a few cells of the torus's border."""
    margin = _NEAR * np.sqrt(size[0] * size[1] / len(points))
    shifts = [(r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)]
    copies = np.concatenate([points + np.array(shift) * size for shift in shifts])
    near = ((copies > -margin) & (copies < np.array(size) + margin)).all(axis=1)
    return np.concatenate([points, copies[near]])


def _middles(points: np.ndarray, size: tuple[float, float]) -> np.ndarray:
    """The centroid of each point's cell, back on the torus."""
    from scipy.spatial import Voronoi

    diagram = Voronoi(_copies(points, size))
    ridges = np.array(diagram.ridge_vertices)
    sides = np.array(diagram.ridge_points)
    owner = np.concatenate([sides[:, 0], sides[:, 1]])
    ridges = np.concatenate([ridges, ridges])
    kept = (owner < len(points)) & (ridges >= 0).all(axis=1)
    owner, ridges = owner[kept], ridges[kept]
    a, b = (diagram.vertices[ridges[:, end]] - points[owner] for end in (0, 1))
    area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])  # cells are convex around their points
    whole = np.bincount(owner, area, len(points))
    moment = [np.bincount(owner, area * (a + b)[:, axis] / 3, len(points)) / whole for axis in (0, 1)]
    return (points + np.stack(moment, axis=1)) % size


def _voronoi(points: np.ndarray, size: tuple[float, float]) -> CellGraph:
    """The toroidal Voronoi diagram: vertices inside the drawing, edges the shortest way."""
    from scipy.spatial import KDTree, Voronoi

    diagram = Voronoi(_copies(points, size))
    ridges = np.array(diagram.ridge_vertices)
    owned = (np.array(diagram.ridge_points) < len(points)).any(axis=1) & (ridges >= 0).all(axis=1)
    ends = diagram.vertices[ridges[owned]]
    place = (ends.reshape(-1, 2) + 0.5) % size - 0.5
    tree = KDTree((place + 0.5) % size, boxsize=size)
    near = tree.query_pairs(1e-6 * min(size), output_type="ndarray")
    group = joined(len(place), near)
    vertices = np.empty((group.max() + 1, 2))
    vertices[group[::-1]] = place[::-1]
    edges = np.sort(group.reshape(-1, 2), axis=1)
    edges = np.unique(edges[edges[:, 0] != edges[:, 1]], axis=0)
    return straight(size, vertices, edges, wrap=True)
