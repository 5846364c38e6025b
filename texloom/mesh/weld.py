"""Vertices that are one point: exact copies, and copies that rounding has pulled apart."""

import numpy as np
from jaxtyping import Float64, Int32

_TOLERANCE = 1e-9  # of the bounding box's diagonal
_LEAST_EDGE = 1e-3  # of the median edge: a far outlier must not let the tolerance swallow the rest


def weld(vertices: Float64[np.ndarray, "vertex 3"], faces: Int32[np.ndarray, "face 3"]) -> Int32[np.ndarray, "vertex"]:
    """For every vertex the lowest vertex at its place, itself where it is alone.

    Vertices that no face uses are left alone. Closeness is passed on: a chain of close vertices is one point.
    """
    exact = np.arange(len(vertices), dtype=np.int32)
    tolerance = _tolerance(vertices, faces)
    crowded = _crowded(vertices, exact, tolerance)
    if len(crowded) == 0:
        return exact
    exact[crowded] = crowded[_lowest_copy(vertices[crowded])]
    used = np.zeros(len(vertices), bool)
    used[exact[faces]] = True
    crowded = _crowded(vertices, crowded[used[crowded]], tolerance)
    if len(crowded) == 0:
        return exact
    close = _lowest_close(vertices, crowded, tolerance)
    return close[exact]


def _lowest_copy(vertices: np.ndarray) -> np.ndarray:
    """Lowest vertex with exactly the same coordinates."""
    order = np.lexsort(vertices.T[::-1])  # stable, so the lowest vertex leads its run
    ordered = vertices[order]
    leads = np.ones(len(vertices), bool)
    leads[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    lowest = np.empty(len(vertices), np.int32)
    lowest[order] = order[leads][np.cumsum(leads) - 1]
    return lowest


def _tolerance(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Distance below which two vertices are one, in world units."""
    tails, heads = (vertices.take(corner, axis=0) for corner in faces[:, :2].T)  # one side a face is sample enough
    extent = np.array([np.ptp(np.concatenate(ends)) for ends in zip(tails.T, heads.T, strict=True)])
    edges = heads - tails
    edges = np.sqrt(np.einsum("ij,ij->i", edges, edges))
    edges = edges[edges > 0]
    return min(_TOLERANCE * float(np.linalg.norm(extent)), _LEAST_EDGE * float(np.median(edges))) if len(edges) else 0.0


def _crowded(vertices: np.ndarray, points: np.ndarray, tolerance: float) -> np.ndarray:
    """The points that may have another within the tolerance: among them some coordinate is close by on every axis."""
    for values in vertices.T:
        here = values[points]
        order = np.argsort(here)
        close = np.diff(here[order]) <= tolerance
        on_axis = np.zeros(len(points), bool)
        on_axis[order[1:][close]] = True
        on_axis[order[:-1][close]] = True
        points = points[on_axis]
    return points


def _lowest_close(vertices: np.ndarray, crowded: np.ndarray, tolerance: float) -> np.ndarray:
    """Lowest vertex of each chain of close vertices; only ``crowded`` ones can have company."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    lowest = np.arange(len(vertices), dtype=np.int32)
    pairs = KDTree(vertices[crowded]).query_pairs(tolerance, output_type="ndarray")
    if len(pairs):
        graph = coo_array((np.ones(len(pairs), bool), tuple(pairs.T)), shape=(len(crowded), len(crowded)))
        labels = connected_components(graph, directed=False)[1]
        first = np.unique(labels, return_index=True)[1]  # ``crowded`` increases, so the first is the lowest
        lowest[crowded] = crowded[first[labels]]
    return lowest
