"""Parallel transport from angles: every vertex neighbourhood laid flat, and the turns between them.

Around a vertex the corner angles are scaled so that they sum to 2π (to nothing else at a boundary, where they stay as
they are). Directions at the vertex are polar angles in that flat disk, counted counter-clockwise from one of its
halfedges; along an edge they keep their angle to it (Knöppel et al. 2013, "Globally optimal direction fields", §6).
Angles never degenerate as normalised cotangent entries do, and the holonomies sum to 2π χ exactly.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex, Complex128, Float64

from texloom.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Transport:
    """Turns between the polar angles of vertices and the frames of faces; radians, counter-clockwise from outside."""

    mesh: Mesh

    @cached_property
    def scaling(self) -> Float64[np.ndarray, "vertex"]:
        """What corner angles are multiplied by in the vertex's flat disk: 2π over their sum, 1 at a boundary."""
        total = np.bincount(
            self.mesh.faces.ravel(), weights=self.mesh.corner_angles.ravel(), minlength=len(self.mesh.vertices)
        )
        flat = self.mesh.boundary_vertices | (total <= 0)
        return np.where(flat, 1.0, 2 * np.pi / np.where(flat, 1.0, total))

    @cached_property
    def scaled_corner_angle(self) -> Float64[np.ndarray, "face 3"]:
        """Corner angles in the vertex's flat disk."""
        return self.mesh.corner_angles * self.scaling[self.mesh.faces]

    @cached_property
    def halfedge_angle_in_vertex(self) -> Float64[np.ndarray, "face 3"]:
        """Polar angle, at its start, of each halfedge."""
        return _polar_angles(self.mesh, self.scaled_corner_angle.ravel()).reshape(-1, 3)

    @cached_property
    def vertex_to_face(self) -> Float64[np.ndarray, "face 3"]:
        """At each corner, the turn that makes a polar angle at the vertex an angle in the face's frame.

        The bisector of the corner goes to the bisector, so that the scaling's error is halved on either side.
        """
        _, b, c = self.mesh.corner_angles.T
        halfedge_in_face = np.stack([np.zeros(len(b)), np.pi - b, np.pi - b + (np.pi - c)], axis=1)
        # bisector: (halfedge in face + angle / 2) − (halfedge in vertex + scaled angle / 2)
        return (
            halfedge_in_face - self.halfedge_angle_in_vertex + (self.mesh.corner_angles - self.scaled_corner_angle) / 2
        )

    @cached_property
    def along_halfedge(self) -> Float64[np.ndarray, "face 3"]:
        """The turn to add to a polar angle at a halfedge's start to carry it to the halfedge's end."""
        # At its end, the halfedge reversed is the far side of the next corner.
        reversed_angle = self.halfedge_angle_in_vertex + self.scaled_corner_angle
        return reversed_angle.take([1, 2, 0], axis=1) + np.pi - self.halfedge_angle_in_vertex

    @cached_property
    def holonomy(self) -> Float64[np.ndarray, "face"]:
        """The turn of a direction carried once around each face, counter-clockwise: its share of the curvature.

        On a closed mesh these sum to 2π times the Euler characteristic.
        """
        return self.scaled_corner_angle.sum(axis=1) - np.pi

    def to_corners(self, power: Complex[np.ndarray, "vertex"], order: int) -> Complex128[np.ndarray, "face 3"]:
        """Powers of directions at the vertices, as they are in the faces' frames."""
        return power[self.mesh.faces] * self._corner_turns(order)

    def to_vertices(self, power: Complex[np.ndarray, "face 3"], order: int) -> Complex128[np.ndarray, "vertex"]:
        """Powers of directions at face corners, as one unit number a vertex: the direction of their sum (0 stays 0)."""
        turned = (power * np.conj(self._corner_turns(order))).ravel()
        index, count = self.mesh.faces.ravel(), len(self.mesh.vertices)
        total = 1j * np.bincount(index, weights=np.imag(turned), minlength=count)
        total += np.bincount(index, weights=np.real(turned), minlength=count)
        return unit(total)

    def _corner_turns(self, order: int) -> Complex128[np.ndarray, "face 3"]:
        """``vertex_to_face`` as unit numbers, of powers."""
        turns = self._known_turns
        if order not in turns:
            turns[order] = np.exp(1j * order * self.vertex_to_face)
        return turns[order]

    @cached_property
    def _known_turns(self) -> dict[int, np.ndarray]:
        return {}


def unit(values: Complex[np.ndarray, "*shape"]) -> Complex128[np.ndarray, "*shape"]:
    """Complex numbers at length 1; what is 0 stays 0."""
    length = np.abs(values)
    return np.divide(values, length, out=np.zeros(values.shape, np.complex128), where=length > 1e-300)


def _polar_angles(mesh: Mesh, width: Float64[np.ndarray, "halfedge"]) -> Float64[np.ndarray, "halfedge"]:
    """Polar angle of every halfedge at its start, 0 at ``first_halfedges``, when the corner after it is ``width``."""
    angle = np.zeros(len(width))
    for here, following in mesh.fan_steps:
        angle[following] = angle[here] + width[here]
    return angle
