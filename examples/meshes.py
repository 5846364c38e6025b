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


def ray(step: float = 0.035) -> Mesh:
    """A stingray: a thin disc with wings and a whip of a tail, genus 0."""
    disc = ball((0, 0, 0), (0.62, 0.17, 0.72))
    wing = mirrored(ball((0.62, 0.03, 0.05), (0.62, 0.1, 0.42), roll=0.12))
    back = ball((0, 0.07, 0.1), (0.3, 0.2, 0.6))
    tail = union(
        [limb((0, 0, -0.6), (0, 0.02, -1.1), 0.09, 0.05), limb((0, 0.02, -1.1), (0.2, 0.1, -1.8), 0.05, 0.035)],
        blend=0.05,
    )
    eye = mirrored(ball((0.17, 0.2, 0.42), 0.07))
    whole = union([disc, wing, back, tail, eye], blend=0.12)
    return polygonise(whole, low=np.array([-1.35, -0.4, -2.0]), high=np.array([1.35, 0.5, 1.0]), step=step)


def elephant(step: float = 0.05) -> Mesh:
    """An elephant with its trunk hanging: genus 0."""
    body = ball((0, 1.0, -0.3), (0.56, 0.58, 0.82))
    legs = [mirrored(limb((0.36, 0.75, z), (0.38, 0.1, z), 0.21, 0.2)) for z in (-0.72, 0.22)]
    head = ball((0, 1.38, 0.62), (0.4, 0.44, 0.42))
    places = [(0, 1.25, 0.95), (0, 0.95, 1.22), (0, 0.55, 1.3), (0, 0.25, 1.45)]
    radii = [0.24, 0.17, 0.13, 0.1]
    trunk = [
        limb(a, b, *pair) for a, b, pair in zip(places, places[1:], zip(radii, radii[1:], strict=False), strict=False)
    ]
    ear = mirrored(ball((0.56, 1.36, 0.42), (0.34, 0.42, 0.15), roll=-0.2))
    tail = limb((0, 1.15, -1.1), (0, 0.62, -1.32), 0.09, 0.07)
    whole = union([body, *legs, head, *trunk, ear, tail], blend=0.13)
    return polygonise(whole, low=np.array([-1.15, -0.25, -1.6]), high=np.array([1.15, 2.1, 1.8]), step=step)


def linked(around: int = 160, across: int = 52) -> Mesh:
    """Two rings through each other, which never touch: two parts, genus 1 each."""
    t, angle = _circle(around)[:, None], _circle(across)
    reach = 1 + 0.36 * np.cos(angle)
    lying = np.stack(np.broadcast_arrays(reach * np.cos(t), 0.36 * np.sin(angle), reach * np.sin(t)), axis=-1).reshape(
        -1, 3
    )
    standing = lying[:, [0, 2, 1]] * [1, 1, -1] + [1.0, 0, 0]
    faces = _lattice(around, across, closed=True)
    return Mesh(np.concatenate([lying, standing]), np.concatenate([faces, faces + len(lying)])[:, ::-1])


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
