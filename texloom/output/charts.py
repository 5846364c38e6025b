"""A mesh cut into charts that lie flat: connected faces that all look much the same way, projected along it.

Made for meshes too large for slower unwrapping: cuts follow creases, every chart is a projection without fold-over,
lengths shrink to no less than ``_LEAST_COSINE``.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from texloom.mesh.mesh import Mesh

_LEAST_COSINE = 0.5  # between a face's normal and its chart's axis
_CREASE = 10.0  # how much longer the way across a right-angled crease is than its length
_ROUNDS = 32
_MERGES = 4  # passes over neighbouring charts


@dataclass(frozen=True, eq=False)
class FaceGraph:
    """Faces joined across their edges, with what is asked of them again and again."""

    mesh: Mesh

    @cached_property
    def centres(self) -> Float64[np.ndarray, "face 3"]:
        """Mean of the corners."""
        return self.mesh.vertices[self.mesh.faces].mean(axis=1)

    @cached_property
    def pairs(self) -> Int[np.ndarray, "pair 2"]:
        """Faces on both sides of each inner edge."""
        twins = self.mesh.twins
        halfedge = np.flatnonzero(twins > np.arange(len(twins)))
        return np.stack([halfedge // 3, twins[halfedge] // 3], axis=1)

    @cached_property
    def costs(self) -> Float64[np.ndarray, "pair"]:
        """How far apart the two faces are, and how they turn; never 0."""
        left, right = self.pairs.T
        far = np.linalg.norm(self.centres[left] - self.centres[right], axis=1)
        turn = 1.0 - np.einsum("fi,fi->f", self.mesh.face_normals[left], self.mesh.face_normals[right])
        return np.maximum(far * (1.0 + _CREASE * turn), 1e-12 * max(self.mesh.diagonal, 1e-300))

    def graph(self, kept: Bool[np.ndarray, "pair"]) -> csr_array:
        """The chosen pairs as a weighted graph."""
        count = len(self.mesh.faces)
        return csr_array((self.costs[kept], tuple(self.pairs[kept].T)), shape=(count, count))


def grow_charts(faces: FaceGraph) -> Int32[np.ndarray, "face"]:
    """A chart number for each face, counted from 0.

    Starts from the mesh's parts and halves every chart that turns too far, by the shorter way (over faces, long over
    creases) from the two faces that look most apart; then joins neighbours that together do not turn too far. Ties go
    to the lower face.
    """
    mesh = faces.mesh
    chart = connected_components(faces.graph(np.ones(len(faces.pairs), bool)), directed=False)[1]
    for _ in range(_ROUNDS):
        bad = np.unique(chart[_deviation(mesh, chart) < _LEAST_COSINE])
        if not len(bad):
            break
        chart = halve(faces, chart, bad)
    chart = _isolated(mesh, chart)
    for _ in range(_MERGES):
        joined = _joined(faces, chart)
        if joined.max() == chart.max():
            break
        chart = joined
    return chart


def halve(
    faces: FaceGraph, chart: Int[np.ndarray, "face"], which: Int[np.ndarray, "chart"]
) -> Int32[np.ndarray, "face"]:
    """Each named chart of two faces or more cut in two, the rest as they are."""
    chosen = np.isin(chart, which)
    first, second = _far_faces(faces, chart, chosen)
    left, right = faces.pairs.T
    graph = faces.graph(chosen[left] & (chart[left] == chart[right]))
    seeds = np.concatenate([first, second])
    if not len(seeds):
        return _counted(chart)
    _, _, nearest = dijkstra(graph, directed=False, indices=seeds, min_only=True, return_predecessors=True)
    number = np.full(len(chart), -1)
    number[second] = chart.max() + 1 + np.arange(len(second))
    moved = (nearest >= 0) & (number[np.maximum(nearest, 0)] >= 0)
    return _counted(np.where(moved, number[np.maximum(nearest, 0)], chart))


def flattened(mesh: Mesh, chart: Int[np.ndarray, "face"]) -> Float64[np.ndarray, "face 3 2"]:
    """Corners in their chart's plane, in world units, faces counter-clockwise."""
    axis = chart_axes(mesh, chart)
    helper = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    across = np.cross(axis, helper)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    plane = np.stack([across, np.cross(axis, across)], axis=1)
    return np.einsum("fij,fcj->fci", plane[chart], mesh.vertices[mesh.faces])


def chart_axes(mesh: Mesh, chart: Int[np.ndarray, "face"]) -> Float64[np.ndarray, "chart 3"]:
    """Unit mean normal of each chart; any direction where the normals cancel."""
    count = int(chart.max()) + 1
    weighted = mesh.face_normals * mesh.face_areas[:, None]
    total = np.stack([np.bincount(chart, weighted[:, i], count) for i in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.divide(total, length, out=np.tile([0.0, 0.0, 1.0], (count, 1)), where=length > 1e-30)


def _deviation(mesh: Mesh, chart: Int[np.ndarray, "face"]) -> Float64[np.ndarray, "face"]:
    """Cosine between each face's normal and its chart's axis; 1 for faces without area."""
    cosine = np.einsum("fi,fi->f", mesh.face_normals, chart_axes(mesh, chart)[chart])
    return np.where(mesh.face_areas > 0, cosine, 1.0)


def _far_faces(
    graph: FaceGraph, chart: Int[np.ndarray, "face"], chosen: Bool[np.ndarray, "face"]
) -> tuple[Int[np.ndarray, "split"], Int[np.ndarray, "split"]]:
    """For each chosen chart, the face that looks furthest from its axis, and the face that looks furthest from that.

    Where all look alike, the two faces furthest apart along the chart's longest side.
    """
    mesh, faces = graph.mesh, np.flatnonzero(chosen)
    first = _least(chart[faces], _deviation(mesh, chart)[faces], faces)
    per_chart = np.full(int(chart.max()) + 1, -1)
    per_chart[chart[first]] = first
    reference = per_chart[chart[faces]]
    alike = np.einsum("fi,fi->f", mesh.face_normals[faces], mesh.face_normals[reference])
    away = np.linalg.norm(graph.centres[faces] - graph.centres[reference], axis=1)
    second = _least(chart[faces], alike - 1e-3 * away / max(mesh.diagonal, 1e-300), faces)
    distinct = first != second
    return first[distinct], second[distinct]


def _least(group: np.ndarray, value: np.ndarray, item: np.ndarray) -> np.ndarray:
    """The item of least value in each group, in order of group; ties take the lowest item."""
    order = np.lexsort((item, value, group))
    starts = np.flatnonzero(np.diff(group[order], prepend=-1))
    return item[order[starts]]


def _joined(graph: FaceGraph, chart: Int32[np.ndarray, "face"]) -> Int32[np.ndarray, "face"]:
    """Charts after one pass over neighbours, longest common border first, joining those that may be one chart."""
    mesh = graph.mesh
    order = np.argsort(chart, kind="stable")
    starts = np.searchsorted(chart[order], np.arange(chart.max() + 2))
    members = [order[a:b] for a, b in zip(starts[:-1], starts[1:], strict=True)]
    weighted = mesh.face_normals * mesh.face_areas[:, None]
    total = [weighted[faces].sum(axis=0) for faces in members]
    home = np.arange(len(members))
    for one, other in _neighbours(graph, chart):
        a, b = home[one], home[other]
        if a == b:
            continue
        axis = total[a] + total[b]
        both = np.concatenate([members[a], members[b]])
        cosine = mesh.face_normals[both] @ axis
        if (cosine[mesh.face_areas[both] > 0] >= _LEAST_COSINE * np.linalg.norm(axis)).all():
            home[home == b] = a
            members[a], total[a] = both, axis
    return _counted(home[chart])


def _neighbours(graph: FaceGraph, chart: Int32[np.ndarray, "face"]) -> Int[np.ndarray, "pair 2"]:
    """Pairs of charts that touch, those with the longest common border (in edges) first."""
    sides = np.sort(chart[graph.pairs], axis=1)
    sides = sides[sides[:, 0] != sides[:, 1]]
    pairs, lengths = np.unique(sides, axis=0, return_counts=True)
    return pairs[np.argsort(-lengths, kind="stable")]


def _isolated(mesh: Mesh, chart: Int[np.ndarray, "face"]) -> Int32[np.ndarray, "face"]:
    """Faces that still look away from their chart become charts of their own."""
    away = np.flatnonzero(_deviation(mesh, chart) < _LEAST_COSINE / 2)
    chart = _counted(chart)
    chart[away] = chart.max() + 1 + np.arange(len(away), dtype=np.int32)
    return _counted(chart)


def _counted(chart: Int[np.ndarray, "face"]) -> Int32[np.ndarray, "face"]:
    """The same charts, numbered without gaps."""
    return np.unique(chart, return_inverse=True)[1].astype(np.int32)
