"""A mesh as a place to grow texture: sites one texel apart, along a direction field, at a local scale."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex64, Float, Float32, Float64, Int32

from texloom.domain.neighbourhoods import Neighbourhoods, Stencils
from texloom.domain.network import lay_patches, lay_stencils
from texloom.domain.patches import Patches
from texloom.domain.scatter import scatter, site_neighbours
from texloom.errors import FieldError, ParameterError
from texloom.field.direction import DirectionField, carry, corner_directions, vertex_directions
from texloom.field.trace import Flow, surface_flow
from texloom.kernels.launch import launch
from texloom.kernels.neighbourhoods import spread
from texloom.mesh.mesh import Mesh
from texloom.mesh.refine import Refined, refine

_LONGEST_EDGE = 1.9  # texels; halving edges until none is longer leaves about one site a texel


@dataclass(frozen=True, eq=False)
class Surface:
    """Sites on a mesh: the vertices of ``refined``, which lies on ``mesh``, the user's own.

    A texel is ``texel * scale`` world units long at each site. Where the mesh is finer than that, there are more sites
    than texels.
    """

    mesh: Mesh
    refined: Refined
    field: DirectionField  # on the refined mesh
    texel: float
    scale: Float32[np.ndarray, "site"]

    @classmethod
    def build(
        cls,
        mesh: Mesh,
        field: DirectionField,
        *,
        texel: float,
        scale: Float[np.ndarray, "vertex"] | None = None,
        spacing: float = _LONGEST_EDGE,
    ) -> "Surface":
        """Sites for a field solved on ``mesh``; ``scale`` enlarges the texture around each of its vertices.

        Edges are split until none is longer than ``spacing`` texels; at infinity the mesh's vertices are the sites.

        Raises: ParameterError, unless ``texel`` is a positive length; FieldError, unless every scale is positive.
        """
        if not (np.isfinite(texel) and texel > 0):
            raise ParameterError(f"a texel of {texel:g} world units: give a length above 0")
        scale = np.ones(len(mesh.vertices)) if scale is None else np.asarray(scale, np.float64)
        _check_scale(scale, len(mesh.vertices))
        refined = refine(mesh, spacing * texel * scale)
        corners = scale[mesh.faces[refined.vertex_parent_face]]
        site_scale = np.einsum("sc,sc->s", corners, refined.vertex_barycentric).astype(np.float32)
        return cls(mesh, refined, carry(field, mesh, refined), float(texel), site_scale)

    @property
    def count(self) -> int:
        """Number of sites."""
        return len(self.scale)

    @property
    def area(self) -> Float32[np.ndarray, "site"]:
        """Area each site stands for, in exemplar texels."""
        return (self.refined.mesh.vertex_areas / self.texel_length**2).astype(np.float32)

    @cached_property
    def texel_length(self) -> Float64[np.ndarray, "site"]:
        """World length of a texel at each site."""
        return self.texel * self.scale.astype(np.float64)

    @cached_property
    def direction(self) -> Float64[np.ndarray, "site 3"]:
        """Unit tangents, the +column axis of each site's frame; of a symmetric field's directions the most upright."""
        return vertex_directions(self.refined.mesh, self.field)

    @property
    def normal(self) -> Float64[np.ndarray, "site 3"]:
        """Unit normals; ``normal × direction`` is the −row axis of each site's frame."""
        return self.refined.mesh.vertex_normals

    @property
    def edges(self) -> Int32[np.ndarray, "edge 2"]:
        """Pairs of neighbouring sites."""
        return self.refined.mesh.edges

    @cached_property
    def neighbours(self) -> tuple[Int32[np.ndarray, "sites_plus_one"], Int32[np.ndarray, "entry"]]:
        """Sites one edge away from each site, in compressed rows."""
        return site_neighbours(self.flow)

    @cached_property
    def flow(self) -> Flow:
        """The field on the sites' triangles, to trace in."""
        return surface_flow(self.refined.mesh, self.field, self.texel_length)

    @cached_property
    def axis(self) -> Complex64[np.ndarray, "face 3"]:
        """Each site's direction in the faces around it."""
        return corner_directions(self.refined.mesh, self.direction).astype(np.complex64)

    @property
    def lattice(self) -> None:
        """None: a mesh has no rows."""
        return None

    def centres(self, pitch: float, seed: int) -> Int32[np.ndarray, "patch"]:
        """Sites about ``pitch`` texels apart, at least 0.84 of it, and none farther than that from one of them."""
        return scatter(self.flow, self.texel_length, pitch, seed=seed)

    def patches(self, centres: Int32[np.ndarray, "patch"], width: int) -> Patches:
        """Patches traced along the field and its orthogonal; they end at boundaries and singularities."""
        return lay_patches(self.flow, centres, width, axis=self.axis)

    def stencils(self, width: int) -> Stencils:
        """``width × width`` samples around every site, by steps of a texel along the field and its orthogonal."""
        return lay_stencils(self.flow, np.arange(self.count, dtype=np.int32), width, axis=self.axis)

    @cached_property
    def _frames(self) -> tuple[Float32[np.ndarray, "site 3"], ...]:
        """Places about their mean, directions, normals and texel lengths, as kernels take them."""
        place = self.refined.mesh.vertices - self.refined.mesh.vertices.mean(0)
        return tuple(a.astype(np.float32) for a in (place, self.direction, self.normal, self.texel_length))

    def neighbourhoods(self, sites: Int32[np.ndarray, "n"], reach: int) -> Neighbourhoods:
        """Sites nearby by walking along edges, laid into the tangent plane; the nearest where there are many."""
        most = (2 * reach + 1) ** 2
        shape = (len(sites), most)
        found, offset = np.empty(shape, np.int32), np.empty((*shape, 2), np.float32)
        turn = np.empty(shape, np.float32)
        launch(
            spread,
            len(sites),
            inputs=[
                *(sites, *self.neighbours, *self._frames, float(reach) + 0.5),
            ],
            outputs=[found, offset, turn],
        )
        if self.field.order == 1:
            return Neighbourhoods(found, offset)
        branch = 2 * np.pi / self.field.order
        return Neighbourhoods(found, offset, np.rint(turn / branch).astype(np.float32) * np.float32(branch))


def texel_for_repeats(mesh: Mesh, repeats: float, sample_width: int) -> float:
    """World length of a texel for ``repeats`` widths of the sample across the longest side of the mesh.

    Raises: ParameterError, unless ``repeats`` is positive.
    """
    if not (np.isfinite(repeats) and repeats > 0):
        raise ParameterError(f"{repeats:g} repeats across the mesh: give a number above 0")
    return mesh.longest_side / (repeats * sample_width)


def _check_scale(scale: Float64[np.ndarray, "vertex"], count: int) -> None:
    """Raises: FieldError, unless there is one positive scale a vertex."""
    if scale.shape != (count,):
        raise FieldError(f"{scale.size} scales for {count} vertices: give one for each vertex")
    bad = ~(np.isfinite(scale) & (scale > 0))
    if bad.any():
        raise FieldError(f"{np.count_nonzero(bad)} of {count} scales are not above 0: the texture would vanish there")
