"""Meshes beside the rabbit, one of a kind each."""

import numpy as np
from jaxtyping import Int32

from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import Distance, Points, Shape, ball, limb, mirrored, union
from texloom.mesh.mesh import Mesh


def knot(around: int = 320, across: int = 26) -> Mesh:
    """A trefoil knot: genus 1, triangles of a lattice."""
    t = _circle(around)
    middle = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -1.2 * np.sin(3 * t)], axis=1)
    ahead = np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    beside = np.cross(ahead, [0.0, 0.0, 1.0])
    beside /= np.linalg.norm(beside, axis=1, keepdims=True)
    angle = _circle(across)[:, None]
    tube = np.cos(angle) * beside[:, None] + np.sin(angle) * np.cross(ahead, beside)[:, None]
    return Mesh((middle[:, None] + 0.62 * tube).reshape(-1, 3), _lattice(around, across, closed=True)[:, ::-1])


def bowl(around: int = 132, across: int = 46) -> Mesh:
    """A fluted bowl without a bottom: two boundaries."""
    angle, rise = _circle(around), np.linspace(0.3, 1.75, across)[:, None]
    radius = np.sin(rise) * (1 + 0.02 * rise**2 * np.cos(7 * angle))
    high = np.broadcast_to(-np.cos(rise), radius.shape)
    points = np.stack([radius * np.cos(angle), high, radius * np.sin(angle)], axis=-1)
    return Mesh(points.reshape(-1, 3), _lattice(across, around, closed=False))


def duck(step: float = 0.05) -> Mesh:
    """A duck that swims: genus 0."""
    body = ball((0, 0.45, -0.1), (0.56, 0.42, 0.8))
    tail = limb((0, 0.6, -0.7), (0, 0.92, -1.0), 0.2, 0.07)
    wing = mirrored(ball((0.48, 0.52, -0.2), (0.12, 0.22, 0.45)))
    neck = limb((0, 0.6, 0.4), (0, 1.15, 0.5), 0.25, 0.2)
    head = ball((0, 1.35, 0.55), (0.31, 0.3, 0.34))
    beak = ball((0, 1.28, 0.92), (0.17, 0.075, 0.2))
    whole = union([body, wing, tail, neck, head, beak], blend=0.12)
    return polygonise(whole, low=np.array([-0.9, -0.2, -1.4]), high=np.array([0.9, 1.9, 1.4]), step=step)


def rings(step: float = 0.06) -> Mesh:
    """Three rings melted together: genus 3."""
    melted = union([_ring((np.sin(t), np.cos(t), 0.0)) for t in _circle(3)], blend=0.15)
    return polygonise(melted, low=np.array([-2.3, -1.9, -0.5]), high=np.array([2.3, 2.3, 0.5]), step=step)


def globe(splits: int = 48) -> Mesh:
    """A ball of even triangles."""
    step = 2.6 / splits
    return polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.2), high=np.full(3, 1.2), step=step)


def _ring(middle: tuple[float, float, float]) -> Shape:
    def distance(p: Points) -> Distance:
        away = p - np.asarray(middle)
        return np.hypot(np.hypot(away[..., 0], away[..., 1]) - 0.75, away[..., 2]) - 0.27

    return distance


def _circle(count: int) -> np.ndarray:
    return np.arange(count) / count * 2 * np.pi


def _lattice(rows: int, columns: int, *, closed: bool) -> Int32[np.ndarray, "face 3"]:
    """Two triangles a cell of a lattice whose columns close, and rows too if ``closed``."""
    row, column = (index.ravel() for index in np.indices((rows if closed else rows - 1, columns)))
    below, right = (row + 1) % rows * columns, (column + 1) % columns
    here = row * columns
    a, b, c, d = here + column, here + right, below + right, below + column
    return np.concatenate([np.stack([a, c, b], 1), np.stack([a, d, c], 1)]).astype(np.int32)
