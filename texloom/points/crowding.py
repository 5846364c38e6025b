"""Points nearer to each other than their triangulation shows."""

import numpy as np
from jaxtyping import Int, Int32

from texloom.kernels.launch import launch
from texloom.kernels.points import settle
from texloom.points.tiling import Tiling, norms

_BESIDE = 0.5  # of the distance that points keep from each other, they keep from a boundary


def crowded(tiling: Tiling, distance: float) -> Int32[np.ndarray, "n"]:
    """Points that are too near to one before them or to the boundary, neighbours or not, and are not frozen.

    Near means on the surface: one is reached from the other by coming ever nearer, so not through a sheet. Distances
    are over the scale.
    """
    found = np.union1d(_near_another(tiling, distance), _near_boundary(tiling, _BESIDE * distance))
    return found[found >= tiling.frozen].astype(np.int32)


def upturned(tiling: Tiling) -> Int32[np.ndarray, "n"]:
    """Points of faces that oppose the ground at their corners, those that are not frozen."""
    a, b, c = tiling.faces.T
    at, normal = tiling.places.at, tiling.places.normal
    across = np.cross(at[b] - at[a], at[c] - at[a])
    over = np.einsum("fx,fx->f", across, normal[a] + normal[b] + normal[c]) < 0
    found = np.unique(tiling.faces[over])
    return found[found >= tiling.frozen].astype(np.int32)


def _near_another(tiling: Tiling, distance: float) -> Int[np.ndarray, "n"]:
    """The later points of all pairs that are too near."""
    from scipy.spatial import KDTree

    places, ground = tiling.places, tiling.ground
    pairs = KDTree(places.at).query_pairs(distance * places.scale.max(), output_type="ndarray")
    first, second = np.sort(pairs, axis=1).T
    scale = 0.5 * (places.scale[first] + places.scale[second])
    near = norms(places.at[first] - places.at[second]) < distance * scale
    first, second = first[near], second[near]
    face, barycentric = np.empty(len(first), np.int32), np.empty((len(first), 3))
    inputs = [ground.arrays, places.at[second], places.face[first]]
    launch(settle, len(first), inputs=inputs, outputs=[face, barycentric])
    reached = ground.positions(face, barycentric) - ground.origin
    return second[norms(reached - places.at[second]) < 1e-6 * distance]


def _near_boundary(tiling: Tiling, distance: float) -> Int[np.ndarray, "n"]:
    """Inner points too near to the boundary edge opposite them."""
    places, outer = tiling.places, np.flatnonzero(tiling.twins < 0)
    tails, heads = tiling.ends(outer)
    inner, _ = tiling.ends(outer - outer % 3 + (outer + 2) % 3)
    base = places.at[heads] - places.at[tails]
    height = norms(np.cross(base, places.at[inner] - places.at[tails])) / np.maximum(norms(base), 1e-300)
    return inner[(height < distance * places.scale[inner]) & (tiling.rim[inner] == 0)]
