"""A triangle mesh: frozen arrays, and what follows from them alone."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int32


@dataclass(frozen=True, eq=False)
class Mesh:
    """An oriented triangle mesh, manifold after mending; boundaries, several parts and any genus are normal.

    Halfedge ``3 f + c`` runs from corner ``c`` of face ``f`` to corner ``(c + 1) % 3``. Positions are world units.
    """

    vertices: Float64[np.ndarray, "vertex 3"]
    faces: Int32[np.ndarray, "face 3"]

    @cached_property
    def twins(self) -> Int32[np.ndarray, "halfedge"]:
        """The halfedge on the other side of each halfedge, -1 at a boundary."""
        raise NotImplementedError

    @cached_property
    def face_normals(self) -> Float64[np.ndarray, "face 3"]:
        """Unit normals; faces run counter-clockwise seen from outside."""
        raise NotImplementedError

    @cached_property
    def face_areas(self) -> Float64[np.ndarray, "face"]:
        """Areas in squared world units."""
        raise NotImplementedError

    @cached_property
    def vertex_areas(self) -> Float64[np.ndarray, "vertex"]:
        """A third of the area of the faces around each vertex."""
        raise NotImplementedError

    @cached_property
    def vertex_normals(self) -> Float64[np.ndarray, "vertex 3"]:
        """Unit normals, faces weighted by their angle at the vertex."""
        raise NotImplementedError

    @cached_property
    def edges(self) -> Int32[np.ndarray, "edge 2"]:
        """Each undirected edge once, lower vertex first, in lexicographic order."""
        raise NotImplementedError

    @cached_property
    def boundary_vertices(self) -> Bool[np.ndarray, "vertex"]:
        """Whether a vertex lies on a boundary."""
        raise NotImplementedError

    @cached_property
    def face_frames(self) -> Float64[np.ndarray, "face 2 3"]:
        """Orthonormal tangent axes of each face: the first along halfedge ``3 f``, the second normal × first."""
        raise NotImplementedError

    @cached_property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal."""
        raise NotImplementedError

    @cached_property
    def longest_side(self) -> float:
        """Longest side of the bounding box."""
        raise NotImplementedError
