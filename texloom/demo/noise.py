"""Noise on the plane: any point, any seed, the same value wherever it is asked.

Points are two arrays ``(row, column)`` of one shape, in units of the noise's own period.
"""

import numpy as np
from jaxtyping import Float
from scipy.spatial import KDTree

from texloom import draws

Plane = Float[np.ndarray, "row column"]


def quarters(size: int) -> tuple[Plane, Plane]:
    """Row and column, in texels, of the four quarters of every texel of a ``size × size`` picture, as one picture."""
    at = (np.arange(2 * size) + 0.5) / 2 - 0.5
    row, column = np.meshgrid(at, at, indexing="ij")
    return row, column


def per_id(identity: np.ndarray, seed: int, *, low: float = 0.0, high: float = 1.0) -> np.ndarray:
    """A uniform number in [low, high) for every integer, equal where the integers are equal."""
    drawn = draws.uniform(seed, index=np.asarray(identity, np.int64).ravel()).astype(np.float64)
    return low + (high - low) * drawn.reshape(np.shape(identity))


def noise(row: Plane, column: Plane, seed: int) -> Plane:
    """Gradient noise (Perlin 2002), about in [-1, 1], zero on the integer lattice."""
    row0, column0 = np.floor(row), np.floor(column)
    y, x = row - row0, column - column0
    fade_y, fade_x = (t * t * t * (t * (6 * t - 15) + 10) for t in (y, x))

    def corner(i: int, j: int) -> Plane:
        cell = (row0.astype(np.int64) + i) * 65_599 + column0.astype(np.int64) + j
        angle = per_id(cell, seed, high=2 * np.pi)
        return np.sin(angle) * (y - i) + np.cos(angle) * (x - j)

    top = corner(0, 0) * (1 - fade_x) + corner(0, 1) * fade_x
    bottom = corner(1, 0) * (1 - fade_x) + corner(1, 1) * fade_x
    return 1.5 * (top * (1 - fade_y) + bottom * fade_y)


def fractal(row: Plane, column: Plane, seed: int, *, octaves: int = 4, gain: float = 0.5) -> Plane:
    """Sum of ``octaves`` of noise, each twice as fine and ``gain`` times as strong, scaled back to about [-1, 1]."""
    strengths = gain ** np.arange(octaves)
    layers = (
        strength * noise(row * 2.0**octave + 17.3 * octave, column * 2.0**octave - 9.1 * octave, seed + octave)
        for octave, strength in enumerate(strengths)
    )
    return sum(layers, np.zeros_like(row)) / np.sqrt((strengths**2).sum())


def cells(
    row: Plane, column: Plane, *, pitch: float, rounding: float, seed: int, relax: int = 0
) -> tuple[np.ndarray, Plane, np.ndarray]:
    """Voronoi cells of points about ``pitch`` apart: cell of each place, distance to its border, offset to its centre.

    The distance is a soft minimum over the sides, which rounds the corners by about ``rounding``. ``relax`` steps of
    Lloyd's iteration make the cells more even. The offset is (rows, columns) stacked last.
    """
    centres = _scatter(float(max(row.max(), column.max())) + 2 * pitch, pitch, seed, relax)
    place = np.stack((row, column), axis=-1)
    distance, near = (np.asarray(found) for found in KDTree(centres).query(place, k=8))
    apart = np.linalg.norm(centres[near[..., 1:]] - centres[near[..., :1]], axis=-1)
    border = (distance[..., 1:] ** 2 - distance[..., :1] ** 2) / (2 * apart)
    least = border.min(-1, keepdims=True)
    border = least[..., 0] - rounding * np.log(np.exp((least - border) / rounding).sum(-1))
    return near[..., 0], border, place - centres[near[..., 0]]


def _scatter(extent: float, pitch: float, seed: int, relax: int) -> Float[np.ndarray, "point 2"]:
    """Jittered points over a square that reaches two pitches beyond ``0 .. extent``, then made even."""
    side = int(np.ceil((extent + 2 * pitch) / pitch))
    row, column = np.divmod(np.arange(side**2, dtype=np.float64), side)
    lattice = np.stack((row, column + 0.5 * (row % 2)), axis=-1)
    index = np.arange(len(lattice))
    jitter = np.stack((per_id(index, seed), per_id(index, seed + 1)), axis=-1) - 0.5
    points = (lattice + 0.9 * jitter) * pitch - 2 * pitch
    at = np.arange(-2 * pitch, extent, 2.0)
    probes = np.stack(np.meshgrid(at, at, indexing="ij"), axis=-1).reshape(-1, 2)
    for _ in range(relax):
        owner = np.asarray(KDTree(points).query(probes)[1])
        count = np.bincount(owner, minlength=len(points))
        total = np.stack(tuple(np.bincount(owner, probes[:, axis], len(points)) for axis in (0, 1)), axis=-1)
        points = np.where(count[:, None] > 0, total / np.maximum(count, 1)[:, None], points)
    return points
