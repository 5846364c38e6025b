"""Solid shapes as signed distances (negative inside), and their smooth union.

Distances are world units; ``p`` is any array of points. Sources: Quilez, "distance functions" (public formulas).
"""

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Float

Points = Float[np.ndarray, "*batch 3"]
Distance = Float[np.ndarray, "*batch"]
Shape = Callable[[Points], Distance]


def ball(centre: Sequence[float], radii: Sequence[float] | float, *, pitch: float = 0.0, roll: float = 0.0) -> Shape:
    """An ellipsoid, turned by ``roll`` radians about z, then ``pitch`` about x; exact to first order at its surface."""
    turn = _rotation(0, pitch) @ _rotation(2, roll)
    size = np.broadcast_to(np.asarray(radii, np.float64), 3)

    def distance(p: Points) -> Distance:
        local = (p - np.asarray(centre)) @ turn
        near = np.linalg.norm(local / size, axis=-1)
        steep = np.linalg.norm(local / size**2, axis=-1)
        reach = np.divide(near, steep, out=np.full_like(near, size.min()), where=steep > 0)
        return reach * (near - 1.0)

    return distance


def limb(start: Sequence[float], end: Sequence[float], radius_start: float, radius_end: float) -> Shape:
    """A capsule whose radius runs from one end to the other."""
    a, axis = np.asarray(start, np.float64), np.subtract(end, start).astype(np.float64)

    def distance(p: Points) -> Distance:
        along = np.clip((p - a) @ axis / (axis @ axis), 0.0, 1.0)
        radius = radius_start + (radius_end - radius_start) * along
        return np.linalg.norm(p - a - along[..., None] * axis, axis=-1) - radius

    return distance


def union(shapes: Sequence[Shape], *, blend: float) -> Shape:
    """All shapes as one, with fillets about ``blend`` wide (polynomial smooth minimum, one after the other)."""

    def distance(p: Points) -> Distance:
        whole = shapes[0](p)
        for shape in shapes[1:]:
            whole = _soft_minimum(whole, shape(p), blend)
        return whole

    return distance


def carve(shape: Shape, hollow: Shape, *, blend: float) -> Shape:
    """The first shape less the second."""
    return lambda p: -_soft_minimum(-shape(p), hollow(p), blend)


def mirrored(shape: Shape) -> Shape:
    """The shape and its image across x = 0."""
    return lambda p: shape(np.concatenate([np.abs(p[..., :1]), p[..., 1:]], -1))


def _soft_minimum(a: Distance, b: Distance, blend: float) -> Distance:
    share = np.clip(0.5 + 0.5 * (b - a) / blend, 0.0, 1.0)
    return b + (a - b) * share - blend * share * (1.0 - share)


def _rotation(axis: int, angle: float) -> Float[np.ndarray, "3 3"]:
    """Right-handed turn about a coordinate axis."""
    turn = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn[[i, i, j, j], [i, j, i, j]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
    return turn
