"""Between vectors in space at the vertices, the powers a solver works with, and the field of the faces."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex, Complex128, Float, Float64, Int

from texloom.field.direction import DirectionField, corner_directions, upright
from texloom.field.transport import Transport
from texloom.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class VertexFrames:
    """n-th powers of directions at vertices, as complex numbers in the polar angles of ``Transport``.

    The upright direction is where space and polar angles are tied together, so that vector -> power -> field ->
    ``vertex_directions`` is the identity.
    """

    mesh: Mesh
    order: int

    @cached_property
    def transport(self) -> Transport:
        """Polar angles and turns of the mesh."""
        return Transport(self.mesh)

    @cached_property
    def upright(self) -> Float64[np.ndarray, "vertex 3"]:
        """The upright tangents, in space."""
        return upright(self.mesh)

    @cached_property
    def upright_power(self) -> Complex128[np.ndarray, "vertex"]:
        """The powers of the upright tangents; 1 at a vertex of no face."""
        corners = corner_directions(self.mesh, self.upright) ** self.order
        power = self.transport.to_vertices(corners, self.order)
        return np.where(power == 0, 1.0, power)

    def powers(
        self, vertices: Int[np.ndarray, "k"], directions: Float[np.ndarray, "k 3"]
    ) -> Complex128[np.ndarray, "k"]:
        """The powers of tangent vectors at some vertices; their lengths do not count."""
        along = self.upright[vertices]
        across = np.cross(self.mesh.vertex_normals[vertices], along)
        angle = np.arctan2(np.sum(directions * across, axis=1), np.sum(directions * along, axis=1))
        return np.exp(1j * self.order * angle) * self.upright_power[vertices]

    def field(self, power: Complex[np.ndarray, "vertex"]) -> DirectionField:
        """The field with these directions; lengths do not count, 0 is a vertex without a direction."""
        length = np.abs(power)
        directions = np.divide(power, length, out=np.zeros(len(power), complex), where=length > 0)
        return DirectionField(self.order, self.transport.to_corners(directions, self.order).astype(np.complex64))
