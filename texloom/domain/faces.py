"""The faces of a mesh as patches to quilt: each one triangle or several, laid flat in texels along the field."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex64, Complex128, Float, Float32, Float64, Int32

from texloom.domain.cover import group_by_site
from texloom.domain.groups import Groups, group
from texloom.errors import ParameterError
from texloom.field.direction import DirectionField, carry
from texloom.field.scale import checked
from texloom.mesh.mesh import Mesh
from texloom.mesh.refine import Refined, refine


@dataclass(frozen=True, eq=False)
class Faces:
    """A mesh cut into patches. A complex number ``column + 1j * row`` is an offset in the exemplar, in texels.

    Every patch lies in a plane of its own, its +column axis along the field, as large as it is on the surface. Within
    a patch a vertex has one place. A field of symmetry n tells a direction only up to turns by 2π / n.
    """

    mesh: Mesh
    field: DirectionField
    texel: float  # world length of a texel,
    scale: Float[np.ndarray, "vertex"] | None  # enlarged around each vertex by this; None: by 1
    patch: Int32[np.ndarray, "face"]  # of each face, numbered by their lowest face
    layout: Complex64[np.ndarray, "face 3"]  # of the corners, in their patch's plane about its middle
    refined: Refined | None = None  # how the faces lie on the user's, where some of those were split

    @classmethod
    def build(
        cls,
        mesh: Mesh,
        field: DirectionField,
        *,
        texel: float,
        scale: Float[np.ndarray, "vertex"] | None = None,
        width: float | None = None,
        most: float | None = None,
        seed: int = 0,
    ) -> "Faces":
        """Every face a patch: a similarity map, turned by the field's mean over the face (T3 of the paper).

        ``texel`` is a texel's length in world units, enlarged by the mean ``scale`` of the face's vertices. With
        ``width``, smaller faces are grouped into patches about that wide (T8). With ``most``, faces are split until no
        side is longer. Both are in texels. O(face) time.

        Raises: ParameterError, unless ``texel``, ``width`` and ``most`` are lengths; FieldError, unless every scale is
        positive.
        """
        if most is not None and not most > 0:
            raise ParameterError(f"faces split to sides of {most:g} texels: give a length above 0")
        scale = None if scale is None else checked(mesh, scale)
        flat = lay_flat(mesh, field, texel=texel, scale=scale)
        refined = None
        if most is not None and np.abs(flat - np.roll(flat, 1, axis=1)).max(initial=0.0) > most:
            refined = refine(mesh, most * texel * (1.0 if scale is None else _least_around(mesh, scale)))
            if scale is not None:
                around = scale[mesh.faces[refined.vertex_parent_face]]
                scale = np.einsum("vc,vc->v", around, refined.vertex_barycentric)
            mesh, field = refined.mesh, carry(field, mesh, refined)
            flat = lay_flat(mesh, field, texel=texel, scale=scale)
        patch = np.arange(len(flat), dtype=np.int32)
        if width is not None:
            groups = group(mesh, flat, order=field.order, width=width, seed=seed)
            patch, flat = groups.patch, _about_middles(groups)
        return cls(mesh, field, texel, scale, patch, flat.astype(np.complex64), refined)

    @property
    def order(self) -> int:
        """Symmetry of the field."""
        return self.field.order

    @property
    def area(self) -> float:
        """Area of all faces as they are laid flat, in squared texels."""
        ahead, back = self.layout[:, 1] - self.layout[:, 0], self.layout[:, 2] - self.layout[:, 0]
        return 0.5 * float(np.abs(np.imag(np.conj(ahead) * back)).sum(dtype=np.float64))

    @cached_property
    def count(self) -> int:
        """Number of patches."""
        return int(self.patch.max(initial=-1)) + 1

    @cached_property
    def rim(self) -> tuple[Int32[np.ndarray, "patch_plus_one"], Int32[np.ndarray, "border"]]:
        """Halfedges of each patch that have another patch across, in compressed rows."""
        twins = self.mesh.twins
        halfedge = np.flatnonzero(twins >= 0).astype(np.int32)
        halfedge = halfedge[self.patch[halfedge // 3] != self.patch[twins[halfedge] // 3]]
        start, order = group_by_site(self.patch[halfedge // 3], self.count)
        return start, halfedge[order]

    @cached_property
    def across(self) -> Int32[np.ndarray, "border"]:
        """The patch beyond each halfedge of ``rim``."""
        return self.patch[self.mesh.twins[self.rim[1]] // 3]

    @cached_property
    def border_length(self) -> Float32[np.ndarray, "border"]:
        """Length of each halfedge of ``rim``, in texels."""
        face, corner = np.divmod(self.rim[1], 3)
        return np.abs(self.layout[face, (corner + 1) % 3] - self.layout[face, corner])

    @cached_property
    def bounds(self) -> tuple[Float32[np.ndarray, "patch order 2"], Float32[np.ndarray, "patch order 2"]]:
        """Least and greatest [column, row] of each patch, turned by each of the field's symmetries."""
        turned = self.layout[:, :, None] * np.exp(2j * np.pi * np.arange(self.order) / self.order)
        corners = np.stack([np.real(turned), np.imag(turned)], axis=-1).astype(np.float32)
        least, greatest = corners.min(1), corners.max(1)
        if self.count == len(self.patch):
            return least, greatest
        order = np.argsort(self.patch, kind="stable")
        first = np.searchsorted(self.patch[order], np.arange(self.count))
        return np.minimum.reduceat(least[order], first), np.maximum.reduceat(greatest[order], first)


def lay_flat(
    mesh: Mesh, field: DirectionField, *, texel: float, scale: Float[np.ndarray, "vertex"] | None = None
) -> Complex128[np.ndarray, "face 3"]:
    """Corners of every face in its own plane about its middle, in texels, +column along the field's mean there.

    Raises: ParameterError, unless ``texel`` is a length.
    """
    if not (np.isfinite(texel) and texel > 0):
        raise ParameterError(f"a texel of {texel:g} world units: give a length above 0")
    corner = mesh.vertices[mesh.faces]
    away = np.einsum("fci,fai->fca", corner - corner.mean(1, keepdims=True), mesh.face_frames)
    mean = field.power.mean(1, dtype=np.complex128)
    ahead = np.exp(1j * np.angle(mean) / field.order)
    length = np.full(len(mesh.faces), texel) if scale is None else texel * scale[mesh.faces].mean(1)
    return (away[..., 0] - 1j * away[..., 1]) * (ahead / length)[:, None]


def _least_around(mesh: Mesh, scale: Float64[np.ndarray, "vertex"]) -> Float64[np.ndarray, "vertex"]:
    """The least scale in the faces around each vertex: between such, no greater than any in the face."""
    least = scale.copy()
    np.minimum.at(least, mesh.faces, scale[mesh.faces].min(1, keepdims=True))
    return least


def _about_middles(groups: Groups) -> Complex128[np.ndarray, "face 3"]:
    """Layouts with their origin at the mean of the corners: inside the patch however it is turned."""
    whole = groups.layout.sum(1)
    size = 3 * np.bincount(groups.patch)
    middle = (np.bincount(groups.patch, whole.real) + 1j * np.bincount(groups.patch, whole.imag)) / size
    return groups.layout - middle[groups.patch, None]


def usual_width(shape: tuple[int, int]) -> float:
    """Texels across a patch where nothing is said: a quarter of the sample's shorter side, 64 at most.

    Some patches grow to three times their width, and then still have room.
    """
    return min(min(shape) / 4, 64.0)
