"""The mesh that points lie on, as their kernels read it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Float64, Int32

from texloom.mesh.mesh import Mesh

_CREASE = 0.8  # cosine between a face's normal and a vertex's, below which the vertex lies on a crease


@dataclass(frozen=True, eq=False)
class Ground:
    """A mesh about its middle, with the distance wanted between points, relative, at every vertex."""

    mesh: Mesh
    scale: Float64[np.ndarray, "vertex"]

    @cached_property
    def origin(self) -> Float64[np.ndarray, "3"]:
        """The mean of the vertices: a small mesh far away would lose its digits."""
        return self.mesh.vertices.mean(axis=0)

    @cached_property
    def vertices(self) -> Float64[np.ndarray, "vertex 3"]:
        """Positions from the origin."""
        return self.mesh.vertices - self.origin

    @cached_property
    def used(self) -> Bool[np.ndarray, "vertex"]:
        """Whether a face has the vertex."""
        used = np.zeros(len(self.vertices), bool)
        used[self.mesh.faces] = True
        return used

    @cached_property
    def rim(self) -> tuple[Int32[np.ndarray, "halfedge"], Int32[np.ndarray, "halfedge"]]:
        """For every halfedge of a boundary the one after it and the one before it along the boundary; else -1."""
        tails = self.mesh.faces.reshape(-1)
        heads = self.mesh.faces.take([1, 2, 0], axis=1).reshape(-1)
        outer = np.flatnonzero(self.mesh.twins < 0).astype(np.int32)
        from_vertex = np.full(len(self.mesh.vertices), -1, np.int32)
        from_vertex[tails[outer]] = outer
        following = np.full(len(tails), -1, np.int32)
        leading = np.full(len(tails), -1, np.int32)
        following[outer] = from_vertex[heads[outer]]
        leading[following[outer]] = outer
        return following, leading

    @cached_property
    def corner_normals(self) -> Float64[np.ndarray, "face 3 3"]:
        """The vertex's normal at every corner; the face's own beside a crease."""
        flat = np.repeat(self.mesh.face_normals[:, None], 3, axis=1)
        smooth = self.mesh.vertex_normals[self.mesh.faces]
        creased = np.einsum("fcx,fcx->fc", flat, smooth) < _CREASE
        return np.where(creased[:, :, None] & (self.mesh.face_areas > 0)[:, None, None], flat, smooth)

    def normals(
        self, face: Int32[np.ndarray, "point"], barycentric: Float[np.ndarray, "point 3"]
    ) -> Float64[np.ndarray, "point 3"]:
        """Unit normals at places."""
        sums = np.einsum("pc,pcx->px", barycentric, self.corner_normals[face])
        return sums / np.maximum(np.sqrt(np.einsum("px,px->p", sums, sums)), 1e-300)[:, None]

    @cached_property
    def arrays(self) -> dict[str, np.ndarray]:
        """For the kernels."""
        following, leading = self.rim
        edges = {"following": following, "leading": leading}
        bare = bare_ground(self.vertices, self.mesh.faces, self.mesh.twins)
        return bare | edges | {"scale": self.scale, "normal": self.corner_normals.reshape(-1, 3)}

    def spacing(self, count: int) -> float:
        """The distance between ``count`` points in a triangular lattice at scale 1, by the area there is."""
        wanted = self.mesh.face_areas / np.mean(self.scale[self.mesh.faces], axis=1) ** 2
        return float(np.sqrt(2 / np.sqrt(3) * wanted.sum() / count))

    def positions(
        self, face: Int32[np.ndarray, "point"], barycentric: Float[np.ndarray, "point 3"]
    ) -> Float64[np.ndarray, "point 3"]:
        """Places in world units."""
        corners = self.mesh.vertices[self.mesh.faces[face]]
        return np.einsum("pc,pcx->px", barycentric, corners)


def bare_ground(
    vertices: Float64[np.ndarray, "vertex 3"],
    faces: Int32[np.ndarray, "face 3"],
    twins: Int32[np.ndarray, "halfedge"],
) -> dict[str, np.ndarray]:
    """For kernels that only walk over a mesh and descend on it."""
    return {"vertex": vertices, "corner": faces.reshape(-1), "twin": twins}
