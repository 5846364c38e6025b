"""Direction and scale fields on a planar grid (the paper's fig. 8): drawn by formula, by vectors or by an image.

Directions are [row, column] components of the exemplar's +column axis, row 0 at the top; angles are radians,
counter-clockwise as seen, from +column.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32

from texloom.errors import FieldError


@dataclass(frozen=True, eq=False)
class PlanarField:
    """A unit direction for every texel of a grid, and the scale of the texture there (None: 1 everywhere)."""

    direction: Float32[np.ndarray, "row column 2"]
    scale: Float32[np.ndarray, "row column"] | None = None


def uniform(rows: int, columns: int, angle: float = 0.0) -> PlanarField:
    """One direction everywhere."""
    return PlanarField(_unit(np.full((rows, columns), -np.sin(angle)), np.full((rows, columns), np.cos(angle))))


def radial(rows: int, columns: int, *, centre_scale: float = 1.0) -> PlanarField:
    """Away from the centre. ``centre_scale`` is the scale there, changing to 1 at the nearer border."""
    row, column = _from_centre(rows, columns)
    return PlanarField(_unit(row, column), _graded(row, column, centre_scale))


def ring(rows: int, columns: int, *, centre_scale: float = 1.0) -> PlanarField:
    """Counter-clockwise around the centre. ``centre_scale`` is the scale there, changing to 1 at the nearer border."""
    row, column = _from_centre(rows, columns)
    return PlanarField(_unit(-column, row), _graded(row, column, centre_scale))


def sine(rows: int, columns: int, *, waves: float = 1.5, height: float = 0.05) -> PlanarField:
    """Along sine curves from left to right: ``waves`` periods, each ``height`` × the width up and down."""
    phase = 2 * np.pi * waves * np.arange(columns) / columns
    slope = 2 * np.pi * waves * height * np.cos(phase)
    return PlanarField(_unit(np.broadcast_to(-slope, (rows, columns)), np.ones((rows, columns))))


NAMED: dict[str, Callable[[int, int], PlanarField]] = {"uniform": uniform, "radial": radial, "sine": sine, "ring": ring}
"""Fields by the names of the command line."""


def from_vectors(vectors: Float[np.ndarray, "y x 2"], rows: int, columns: int) -> PlanarField:
    """A field of given [row, column] vectors, stretched to the grid; their lengths are the scale, 1 in the mean.

    Vectors of length 0 take after their nearest neighbour.

    Raises: FieldError, if the array has another shape, a number that is not finite, or nothing but zeros.
    """
    vectors = np.asarray(vectors, np.float64)
    if vectors.ndim != 3 or vectors.shape[2] != 2 or 0 in vectors.shape:
        raise FieldError(f"planar vectors of shape {vectors.shape}: give (rows, columns, 2) as [row, column]")
    if not np.isfinite(vectors).all():
        count = np.count_nonzero(~np.isfinite(vectors).all(axis=2))
        raise FieldError(f"{count} of {vectors.shape[0] * vectors.shape[1]} planar vectors are not finite: mend them")
    length = np.linalg.norm(vectors, axis=2)
    if not length.any():
        raise FieldError("all planar vectors are 0: at least one must have a direction")
    vectors = _fill(vectors / length[length > 0].mean(), length == 0)
    length = np.linalg.norm(vectors, axis=2, keepdims=True)
    stretched = _stretch(np.concatenate([vectors / length, np.log(length)], axis=2), rows, columns)
    scale = None if np.ptp(length) < 1e-6 else np.exp(stretched[..., 2]).astype(np.float32)
    return PlanarField(_unit(stretched[..., 0], stretched[..., 1]), scale)


def from_image(image: Float[np.ndarray, "y x channel"], rows: int, columns: int) -> PlanarField:
    """A field painted as an image, values as stored in [0, 1].

    Grey is an angle: 0 is +column, 1 a whole turn counter-clockwise. In colour, red is to the right and green up,
    0.5 being nothing, as in a normal map; blue does not count.
    """
    if image.ndim != 3 or image.shape[2] not in (1, 2, 3, 4):
        raise FieldError(f"a direction image of shape {image.shape}: give grey, or red and green")
    grey = image.shape[2] < 3 or np.array_equal(image[..., 0], image[..., 1])
    if grey:
        angle = 2 * np.pi * np.asarray(image[..., 0], np.float64)
        return from_vectors(np.stack([-np.sin(angle), np.cos(angle)], axis=2), rows, columns)
    right, up = (2.0 * np.asarray(image[..., k], np.float64) - 1.0 for k in (0, 1))
    right, up = (np.where(np.abs(part) < 1 / 250, 0.0, part) for part in (right, up))  # 127 and 128 are both nothing
    return PlanarField(from_vectors(np.stack([-up, right], axis=2), rows, columns).direction)


def _from_centre(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """[row, column] offsets from the centre of the grid."""
    row, column = np.meshgrid(np.arange(rows) - (rows - 1) / 2, np.arange(columns) - (columns - 1) / 2, indexing="ij")
    return row, column


def _graded(row: np.ndarray, column: np.ndarray, centre_scale: float) -> Float32[np.ndarray, "row column"] | None:
    """From ``centre_scale`` to 1, by equal factors over equal distances; None where that is 1 everywhere."""
    if not (np.isfinite(centre_scale) and centre_scale > 0):
        raise FieldError(f"the scale at the centre is {centre_scale:g}: give a finite number above 0")
    if centre_scale == 1.0:
        return None
    distance = np.hypot(row, column) / max(min(row.max(), column.max()), 0.5)
    return (centre_scale ** (1.0 - np.minimum(distance, 1.0))).astype(np.float32)


def _unit(row: np.ndarray, column: np.ndarray) -> Float32[np.ndarray, "row column 2"]:
    """Unit vectors; +column where there is no direction."""
    length = np.hypot(row, column)
    safe = np.where(length > 1e-9, length, 1.0)
    row, column = np.where(length > 1e-9, row, 0.0) / safe, np.where(length > 1e-9, column, 1.0) / safe
    return np.stack([row, column], axis=2).astype(np.float32)


def _fill(vectors: np.ndarray, missing: np.ndarray) -> np.ndarray:
    """Missing vectors replaced by the nearest one there is."""
    if not missing.any():
        return vectors
    from scipy.ndimage import distance_transform_edt

    nearest = np.asarray(distance_transform_edt(missing, return_distances=False, return_indices=True))
    return vectors[nearest[0], nearest[1]]


def _stretch(values: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """Bilinear resampling of a (y, x, channel) array to the grid, texel centres to texel centres."""
    for axis, count in ((0, rows), (1, columns)):
        size = values.shape[axis]
        if size == count:
            continue
        at = np.clip((np.arange(count) + 0.5) * size / count - 0.5, 0, size - 1)
        low = np.minimum(at.astype(int), max(size - 2, 0))
        weight = np.expand_dims(at - low, tuple(k for k in range(3) if k != axis))
        high = np.minimum(low + 1, size - 1)
        values = np.take(values, low, axis) * (1 - weight) + np.take(values, high, axis) * weight
    return values
