"""Tangent vectors as complex numbers in a frame at each point, and the turns that carry them from point to point."""

import numpy as np
from jaxtyping import Complex128, Float, Float64, Int

_OPPOSITE = 1e-6  # one plus the cosine between normals, below which any turn is as good as any other


def frames(normal: Float[np.ndarray, "point 3"]) -> Float64[np.ndarray, "point 2 3"]:
    """Two unit tangents at every point: one at right angles to the axis the normal is farthest from, normal × it."""
    axis = np.zeros(normal.shape)
    axis[np.arange(len(normal)), np.argmin(np.abs(normal), axis=1)] = 1.0
    first = np.cross(axis, normal)
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-300)
    return np.stack([first, np.cross(normal, first)], axis=1)


def to_complex(
    vectors: Float[np.ndarray, "point 3"], axes: Float[np.ndarray, "point 2 3"]
) -> Complex128[np.ndarray, "point"]:
    """The tangent part of vectors in their frames."""
    along = np.einsum("px,pax->pa", vectors, axes)
    return along[:, 0] + 1j * along[:, 1]


def to_vectors(
    values: Complex128[np.ndarray, "point"], axes: Float[np.ndarray, "point 2 3"]
) -> Float64[np.ndarray, "point 3"]:
    """Tangent vectors from their frames."""
    return np.real(values)[:, None] * axes[:, 0] + np.imag(values)[:, None] * axes[:, 1]


def turns(
    axes: Float[np.ndarray, "source 2 3"],
    onto: Float[np.ndarray, "target 2 3"],
    source: Int[np.ndarray, "pair"],
    target: Int[np.ndarray, "pair"],
) -> Complex128[np.ndarray, "pair"]:
    """Unit numbers that carry vectors in the source's frame into the target's.

    The least rotation that takes one normal to the other: lengths and angles between vectors stay, nothing leaves the
    surface. Between points a spacing apart it is parallel transport but for what the surface curves there.
    """
    first, second = axes[source, 0], axes[source, 1]
    normal, there = np.cross(first, second), np.cross(onto[target, 0], onto[target, 1])
    cosine = np.einsum("px,px->p", normal, there)
    lean = np.einsum("px,px->p", first, there) / np.maximum(1 + cosine, _OPPOSITE)
    carried = first - lean[:, None] * (normal + there)
    turn = np.einsum("px,px->p", carried, onto[target, 0]) + 1j * np.einsum("px,px->p", carried, onto[target, 1])
    length = np.abs(turn)
    return np.where(length > 1e-12, turn / np.maximum(length, 1e-300), 1.0)
