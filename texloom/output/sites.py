"""The sites of a surface as outputs need them: where they are, their frames, and the way home to the user's faces."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int

from texloom.domain.surface import Surface
from texloom.errors import MeshError


@dataclass(frozen=True, eq=False, kw_only=True)
class SurfaceSites:
    """A refined mesh whose vertices are the sites, with frames and the way home.

    ``direction`` is +column of the exemplar, ``normal × direction`` is −row. ``texel`` is the world length of an
    exemplar texel, enlarged by ``scale`` at each site (None: 1 everywhere). Face ``f`` lies on the user's face
    ``parent[f]``, its corners at barycentric coordinates ``corners[f]`` there.

    ``shading`` are the normals to show, where they are not those of the frames:
    a refined flat face has flat frames, but is shaded like the user's mesh.
    """

    vertices: Float[np.ndarray, "site 3"]
    faces: Int[np.ndarray, "face 3"]
    direction: Float[np.ndarray, "site 3"]
    normal: Float[np.ndarray, "site 3"]
    texel: float
    scale: Float[np.ndarray, "site"] | None = None
    parent: Int[np.ndarray, "face"] | None = None
    corners: Float[np.ndarray, "face 3 3"] | None = None
    shading: Float[np.ndarray, "site 3"] | None = None

    @classmethod
    def of(cls, surface: Surface) -> "SurfaceSites":
        """The sites of a surface domain."""
        refined = surface.refined
        around = surface.mesh.vertex_normals[surface.mesh.faces[refined.vertex_parent_face]]
        shading = np.einsum("sc,sci->si", refined.vertex_barycentric, around)
        length = np.linalg.norm(shading, axis=1, keepdims=True)
        return cls(
            vertices=refined.mesh.vertices,
            faces=refined.mesh.faces,
            direction=surface.direction,
            normal=surface.normal,
            texel=surface.texel,
            scale=surface.scale,
            parent=refined.parent,
            corners=refined.corner_barycentric,
            shading=np.where(length > 1e-6, shading / np.maximum(length, 1e-6), surface.normal),
        )

    def at_corners(self, values: Float[np.ndarray, "user_face 3 n"]) -> Float32[np.ndarray, "face 3 n"]:
        """Values given at the corners of the user's faces, at the corners of the refined faces."""
        if self.parent is None or self.corners is None:
            if len(values) != len(self.faces):
                raise MeshError(f"{len(values)} faces were given for a surface of {len(self.faces)}: pass parent faces")
            return np.ascontiguousarray(values, np.float32)
        return np.einsum("fcp,fpn->fcn", self.corners, values[self.parent], dtype=np.float32, casting="same_kind")

    @property
    def shown_normal(self) -> Float[np.ndarray, "site 3"]:
        """Unit normals for files and pictures."""
        return self.normal if self.shading is None else self.shading

    @property
    def upward(self) -> Float32[np.ndarray, "site 3"]:
        """The −row axis of each site's frame."""
        return np.cross(self.normal, self.direction).astype(np.float32)

    @property
    def texel_length(self) -> Float32[np.ndarray, "site"]:
        """World length of an exemplar texel at each site."""
        length = np.full(len(self.vertices), self.texel, np.float32)
        return length if self.scale is None else length * np.asarray(self.scale, np.float32)
