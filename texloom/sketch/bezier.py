"""Cubic Bézier curves as arrays: four points a curve, [row, column]."""

import numpy as np
from jaxtyping import Float, Int


def points_at(curves: Float[np.ndarray, "n 4 2"], t: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n 2"]:
    """One point of each curve."""
    t = t[:, None]
    s = 1 - t
    a, b, c, d = curves.transpose(1, 0, 2)
    return s**3 * a + 3 * s**2 * t * b + 3 * s * t**2 * c + t**3 * d


def lines(tail: Float[np.ndarray, "n 2"], head: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n 4 2"]:
    """Straight curves, their control points at thirds."""
    share = np.array([0, 1 / 3, 2 / 3, 1])[:, None]
    return tail[:, None] * (1 - share) + head[:, None] * share


def pieces(
    curves: Float[np.ndarray, "n 4 2"], first: Float[np.ndarray, "n"], last: Float[np.ndarray, "n"]
) -> Float[np.ndarray, "n 4 2"]:
    """The part of each curve between two parameters, a cubic again (blossoming)."""
    u, v = first[:, None], last[:, None]
    blends = [(u, u, u), (u, u, v), (u, v, v), (v, v, v)]
    return np.stack([_blossom(curves, *blend) for blend in blends], axis=1)


def _blossom(curves: np.ndarray, r: np.ndarray, s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """The symmetric multilinear form of each curve: de Casteljau with another parameter at each step."""
    points = curves.transpose(1, 0, 2)
    for at in (r, s, t):
        points = points[:-1] * (1 - at) + points[1:] * at
    return points[0]


def bend(curves: Float[np.ndarray, "n 4 2"]) -> Float[np.ndarray, "n"]:
    """The larger second difference of the control points: 0 where a curve is straight and evenly run."""
    second = curves[:, :-2] - 2 * curves[:, 1:-1] + curves[:, 2:]
    return np.hypot(second[..., 0], second[..., 1]).max(axis=1)


def steps(curves: Float[np.ndarray, "n 4 2"], tolerance: float) -> Int[np.ndarray, "n"]:
    """Chords, even in the parameter, that keep within ``tolerance`` of each curve (Wang 1984)."""
    return np.maximum(np.ceil(np.sqrt(0.75 * bend(curves) / tolerance)), 1).astype(np.int64)


def reverse(curves: Float[np.ndarray, "n 4 2"]) -> Float[np.ndarray, "n 4 2"]:
    """The curves run backwards."""
    return curves[:, ::-1]
