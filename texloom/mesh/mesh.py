"""A triangle mesh: frozen arrays, and what follows from them alone."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32

_COUNTABLE = 4  # vertices a halfedge: with more, sorting beats counting


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
        first, second, opposite = self.edge_pairs
        first, second = first[opposite], second[opposite]
        twins = np.full(self.faces.size, -1, np.int32)
        twins[first], twins[second] = second, first
        return twins

    @cached_property
    def edge_runs(self) -> tuple[Int[np.ndarray, "halfedge"], Int[np.ndarray, "edge"], Int[np.ndarray, "edge"]]:
        """The halfedges of every edge (``edge_runs``)."""
        return edge_runs(self.faces)

    @cached_property
    def edge_pairs(self) -> tuple[Int[np.ndarray, "pair"], Int[np.ndarray, "pair"], Bool[np.ndarray, "pair"]]:
        """The two halfedges of every edge that has exactly two, and whether they run opposite ways along it."""
        order, starts, counts = self.edge_runs
        pairs = starts[counts == 2]
        first, second = order[pairs], order[pairs + 1]
        tails = self.faces.reshape(-1)
        return first, second, tails[first] != tails[second]

    @cached_property
    def agrees(self) -> bool:
        """Whether every edge is a boundary or two opposite halfedges; vertices may still have several fans."""
        return bool((self.edge_runs[2] <= 2).all() and self.edge_pairs[2].all())

    @cached_property
    def first_halfedges(self) -> Int32[np.ndarray, "vertex"]:
        """Where each vertex's fan starts: on the boundary, else at its lowest halfedge; -1 for a vertex of no face."""
        tails = self.faces.reshape(-1)
        first = np.full(len(self.vertices), -1, np.int32)
        first[tails[::-1]] = np.arange(len(tails), dtype=np.int32)[::-1]
        outer = np.flatnonzero(self.twins < 0).astype(np.int32)
        first[tails[outer]] = outer
        return first

    @cached_property
    def fan_steps(self) -> tuple[tuple[Int32[np.ndarray, "step"], Int32[np.ndarray, "step"]], ...]:
        """Halfedges, and the next ones counter-clockwise around their tails, outwards from ``first_halfedges``.

        All vertices are walked around at once, one corner a step: O(halfedges) work in as many steps as the highest
        valence.
        """
        across = self.twins.reshape(-1, 3)[:, [2, 0, 1]].reshape(-1)  # the incoming side
        here = self.first_halfedges
        here = here[here >= 0]
        stop, steps = here, []
        while len(here):
            following = across[here]
            goes_on = (following >= 0) & (following != stop)
            here, following, stop = here[goes_on], following[goes_on], stop[goes_on]
            steps.append((here, following))
            here = following
        return tuple(steps)

    @cached_property
    def edges(self) -> Int32[np.ndarray, "edge 2"]:
        """Each undirected edge once, lower vertex first, in lexicographic order."""
        order, starts, _ = self.edge_runs
        leads = order[starts]
        tails, heads = self.faces.reshape(-1)[leads], _heads(self.faces).reshape(-1)[leads]
        return np.stack([np.minimum(tails, heads), np.maximum(tails, heads)], axis=1)

    @cached_property
    def halfedge_edges(self) -> Int32[np.ndarray, "halfedge"]:
        """Row of ``edges`` under each halfedge."""
        order, _, counts = self.edge_runs
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
        ab, bc, ca = self.sides
        dots = np.stack([_dots(ab, ca), _dots(bc, ab), _dots(ca, bc)], axis=1)
        return np.arctan2(_norms(self._crosses)[:, None], 0.0 - dots)  # 0 stays +0 where a face has no area

    @cached_property
    def vertex_areas(self) -> Float64[np.ndarray, "vertex"]:
        """A third of the area of the faces around each vertex."""
        return self._sum_at_vertices(np.repeat(self.face_areas / 3, 3))

    @cached_property
    def vertex_normals(self) -> Float64[np.ndarray, "vertex 3"]:
        """Unit normals, faces weighted by their angle at the vertex."""
        along_axes = (self.face_normals[:, axis, None] * self.corner_angles for axis in range(3))
        sums = [self._sum_at_vertices(weighted.reshape(-1)) for weighted in along_axes]
        return _normalized(np.stack(sums, axis=1))

    @cached_property
    def boundary_vertices(self) -> Bool[np.ndarray, "vertex"]:
        """Whether a vertex lies on a boundary."""
        is_open = (self.twins < 0).reshape(-1, 3)
        on_boundary = np.zeros(len(self.vertices), bool)
        on_boundary[self.faces[is_open]] = True
        on_boundary[_heads(self.faces)[is_open]] = True
        return on_boundary

    @cached_property
    def vertex_parts(self) -> Int32[np.ndarray, "vertex"]:
        """Connected part each vertex belongs to, parts numbered by their lowest vertex."""
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import connected_components

        count = len(self.vertices)
        tails, heads = np.ascontiguousarray(self.edges.T)
        starts = np.searchsorted(tails, np.arange(count + 1, dtype=np.int32)).astype(np.int32)
        graph = csr_array((np.ones(len(heads)), heads, starts), shape=(count, count))
        return connected_components(graph, directed=False)[1].astype(np.int32)

    @cached_property
    def face_frames(self) -> Float64[np.ndarray, "face 2 3"]:
        """Orthonormal tangent axes of each face: the first along halfedge ``3 f``, the second normal × first."""
        a, b = (self.vertices.take(corner, axis=0) for corner in self.faces[:, :2].T)
        first = _normalized(b - a)
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
    def _crosses(self) -> Float64[np.ndarray, "face 3"]:
        """Normals whose length is twice the area."""
        ab, _, ca = self.sides
        return np.cross(ab, -ca)

    @property
    def sides(self) -> tuple[Float64[np.ndarray, "face 3"], ...]:
        """The vectors along the halfedges of each face: from corner 0, from corner 1, from corner 2."""
        a, b, c = (self.vertices.take(corner, axis=0) for corner in self.faces.T)  # four times as fast as [corner]
        return b - a, c - b, a - c

    def _sum_at_vertices(self, of_corners: Float64[np.ndarray, "corner"]) -> Float64[np.ndarray, "vertex"]:
        """Sum of corner values around each vertex, in the order of the corners."""
        return np.bincount(self.faces.reshape(-1), weights=of_corners, minlength=len(self.vertices))


def edge_runs(
    faces: Int32[np.ndarray, "face 3"],
) -> tuple[Int[np.ndarray, "halfedge"], Int[np.ndarray, "edge"], Int[np.ndarray, "edge"]]:
    """Halfedges sorted by their undirected edge; where each edge's run starts, and how many halfedges it has.

    Edges come in lexicographic order (lower vertex, higher vertex), the halfedges of an edge in increasing order.
    """
    heads = _heads(faces)
    lower, higher = np.minimum(faces, heads).reshape(-1), np.maximum(faces, heads).reshape(-1)
    vertex_count = int(faces.max(initial=0)) + 1
    if vertex_count <= _COUNTABLE * faces.size:
        by_higher = _counted_order(higher, vertex_count)
        order = by_higher[_counted_order(lower[by_higher], vertex_count)]
    else:
        order = np.lexsort((higher, lower))
    lower, higher = lower[order], higher[order]
    is_start = np.ones(len(order), bool)
    is_start[1:] = (lower[1:] != lower[:-1]) | (higher[1:] != higher[:-1])
    starts = np.flatnonzero(is_start)
    return order, starts, np.diff(starts, append=len(order))


def _counted_order(keys: np.ndarray, count: int) -> np.ndarray:
    """Stable order of numbers below ``count``, in linear time: a sparse matrix of one entry a row, read by columns."""
    from scipy.sparse import csr_array

    rows = np.arange(len(keys) + 1, dtype=np.int32)
    return csr_array((np.ones(len(keys), bool), keys, rows), shape=(len(keys), count)).tocsc().indices


def _heads(faces: np.ndarray) -> np.ndarray:
    """The vertex each halfedge runs to."""
    return faces.take([1, 2, 0], axis=1)


def _dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)


def _norms(vectors: np.ndarray) -> np.ndarray:
    return np.sqrt(_dots(vectors, vectors))


def _normalized(vectors: np.ndarray) -> np.ndarray:
    """Unit vectors; zero stays zero."""
    return vectors / np.maximum(_norms(vectors), np.finfo(np.float64).tiny)[:, None]
