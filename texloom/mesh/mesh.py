"""A triangle mesh: frozen arrays, and what follows from them alone."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32


@dataclass(frozen=True, eq=False)
class Mesh:
    """An oriented triangle mesh, manifold after mending; boundaries, several parts and any genus are normal.

    Halfedge ``3 f + c`` runs from corner ``c`` of face ``f`` to corner ``(c + 1) % 3``. Positions are world units.
    """

    vertices: Float64[np.ndarray, "vertex 3"]
    faces: Int32[np.ndarray, "face 3"]

    def __post_init__(self) -> None:
        # Kernels read the arrays as they lie in memory.
        object.__setattr__(self, "vertices", np.ascontiguousarray(self.vertices, np.float64))
        object.__setattr__(self, "faces", np.ascontiguousarray(self.faces, np.int32))

    @cached_property
    def twins(self) -> Int32[np.ndarray, "halfedge"]:
        """The halfedge on the other side of each halfedge, -1 at a boundary.

        An edge that is not two opposite halfedges (three faces, or two that run the same way) counts as boundary.
        """
        order, starts, counts = self._edge_runs
        pairs = starts[counts == 2]
        first, second = order[pairs], order[pairs + 1]
        tails = self.faces.reshape(-1)
        opposite = tails[first] != tails[second]
        twins = np.full(self.faces.size, -1, np.int32)
        twins[first[opposite]] = second[opposite]
        twins[second[opposite]] = first[opposite]
        return twins

    @cached_property
    def edges(self) -> Int32[np.ndarray, "edge 2"]:
        """Each undirected edge once, lower vertex first, in lexicographic order."""
        order, starts, _ = self._edge_runs
        face, corner = np.divmod(order[starts], 3)
        ends = np.stack([self.faces[face, corner], self.faces[face, (corner + 1) % 3]], axis=1)
        return np.sort(ends, axis=1)

    @cached_property
    def halfedge_edges(self) -> Int32[np.ndarray, "halfedge"]:
        """Row of ``edges`` under each halfedge."""
        order, _, counts = self._edge_runs
        numbers = np.empty(self.faces.size, np.int32)
        numbers[order] = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
        return numbers

    @cached_property
    def edge_lengths(self) -> Float64[np.ndarray, "edge"]:
        """Lengths of ``edges``, in world units."""
        return _norms(self.vertices[self.edges[:, 1]] - self.vertices[self.edges[:, 0]])

    @cached_property
    def face_normals(self) -> Float64[np.ndarray, "face 3"]:
        """Unit normals; faces run counter-clockwise seen from outside."""
        return _normalized(self._crosses)

    @cached_property
    def face_areas(self) -> Float64[np.ndarray, "face"]:
        """Areas in squared world units."""
        return 0.5 * _norms(self._crosses)

    @cached_property
    def corner_angles(self) -> Float64[np.ndarray, "face 3"]:
        """Interior angle at every corner, in radians."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        doubled_area = _norms(self._crosses)
        dots = [_dots(b - a, c - a), _dots(c - b, a - b), _dots(a - c, b - c)]
        return np.stack([np.arctan2(doubled_area, dot) for dot in dots], axis=1)

    @cached_property
    def vertex_areas(self) -> Float64[np.ndarray, "vertex"]:
        """A third of the area of the faces around each vertex."""
        return self._sum_at_vertices(np.repeat(self.face_areas / 3, 3))

    @cached_property
    def vertex_normals(self) -> Float64[np.ndarray, "vertex 3"]:
        """Unit normals, faces weighted by their angle at the vertex."""
        weighted = self.face_normals[:, None, :] * self.corner_angles[:, :, None]
        sums = [self._sum_at_vertices(np.ascontiguousarray(weighted[:, :, axis]).reshape(-1)) for axis in range(3)]
        return _normalized(np.stack(sums, axis=1))

    @cached_property
    def boundary_vertices(self) -> Bool[np.ndarray, "vertex"]:
        """Whether a vertex lies on a boundary."""
        open_halfedges = np.flatnonzero(self.twins < 0)
        face, corner = np.divmod(open_halfedges, 3)
        on_boundary = np.zeros(len(self.vertices), bool)
        on_boundary[self.faces[face, corner]] = True
        on_boundary[self.faces[face, (corner + 1) % 3]] = True
        return on_boundary

    @cached_property
    def vertex_parts(self) -> Int32[np.ndarray, "vertex"]:
        """Connected part each vertex belongs to, parts numbered by their lowest vertex."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        count = len(self.vertices)
        graph = coo_array((np.ones(len(self.edges), bool), tuple(self.edges.T)), shape=(count, count))
        return connected_components(graph, directed=False)[1].astype(np.int32)

    @cached_property
    def face_frames(self) -> Float64[np.ndarray, "face 2 3"]:
        """Orthonormal tangent axes of each face: the first along halfedge ``3 f``, the second normal × first."""
        first = _normalized(self.vertices[self.faces[:, 1]] - self.vertices[self.faces[:, 0]])
        return np.stack([first, np.cross(self.face_normals, first)], axis=1)

    @cached_property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    @cached_property
    def longest_side(self) -> float:
        """Longest side of the bounding box."""
        return float(np.ptp(self.vertices, axis=0).max())

    @cached_property
    def _edge_runs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return edge_runs(self.faces)

    @cached_property
    def _crosses(self) -> Float64[np.ndarray, "face 3"]:
        """Normals whose length is twice the area."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    def _sum_at_vertices(self, of_corners: Float64[np.ndarray, "corner"]) -> Float64[np.ndarray, "vertex"]:
        """Sum of corner values around each vertex, in the order of the corners."""
        return np.bincount(self.faces.reshape(-1), weights=of_corners, minlength=len(self.vertices))


def edge_runs(
    faces: Int32[np.ndarray, "face 3"],
) -> tuple[Int[np.ndarray, "halfedge"], Int[np.ndarray, "edge"], Int[np.ndarray, "edge"]]:
    """Halfedges sorted by their undirected edge; where each edge's run starts, and how many halfedges it has.

    Edges come in lexicographic order (lower vertex, higher vertex), the halfedges of an edge in increasing order.
    """
    tails = faces.astype(np.int64)
    heads = tails[:, [1, 2, 0]]
    vertex_count = int(faces.max(initial=0)) + 1
    keys = (np.minimum(tails, heads) * vertex_count + np.maximum(tails, heads)).reshape(-1)
    bits = keys.size.bit_length()
    if (vertex_count * vertex_count).bit_length() + bits < 63:  # sort keys with their halfedge packed in: twice as fast
        packed = np.sort((keys << bits) | np.arange(keys.size))
        order = packed & ((1 << bits) - 1)
        keys = packed >> bits
    else:
        order = np.argsort(keys, kind="stable")
        keys = keys[order]
    is_start = np.ones(len(keys), bool)
    is_start[1:] = keys[1:] != keys[:-1]
    starts = np.flatnonzero(is_start)
    return order, starts, np.diff(starts, append=len(keys))


def _dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)


def _norms(vectors: np.ndarray) -> np.ndarray:
    return np.sqrt(_dots(vectors, vectors))


def _normalized(vectors: np.ndarray) -> np.ndarray:
    """Unit vectors; zero stays zero."""
    return vectors / np.maximum(_norms(vectors), np.finfo(np.float64).tiny)[:, None]
