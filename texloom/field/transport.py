"""Parallel transport from angles: every vertex neighbourhood laid flat, and the turns between them.

Around a vertex the corner angles are scaled so that they sum to 2π (to nothing else at a boundary, where they stay as
they are). Directions at the vertex are polar angles in that flat disk, counted counter-clockwise from one of its
halfedges; along an edge they keep their angle to it (Knöppel et al. 2013, "Globally optimal direction fields", §6).
Angles never degenerate as normalised cotangent entries do, and the holonomies sum to 2π χ exactly.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex, Complex128, Float64, Int32

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
        inside = np.cumsum(np.pi - np.roll(self.mesh.corner_angles, -1, axis=1), axis=1)
        halfedge_in_face = np.concatenate([np.zeros((len(inside), 1)), inside[:, :2]], axis=1)
        # bisector: (halfedge in face + angle / 2) − (halfedge in vertex + scaled angle / 2)
        return (
            halfedge_in_face - self.halfedge_angle_in_vertex + (self.mesh.corner_angles - self.scaled_corner_angle) / 2
        )

    @cached_property
    def along_halfedge(self) -> Float64[np.ndarray, "face 3"]:
        """The turn to add to a polar angle at a halfedge's start to carry it to the halfedge's end."""
        # At its end, the halfedge reversed is the far side of the next corner.
        reversed_angle = self.halfedge_angle_in_vertex + self.scaled_corner_angle
        return np.roll(reversed_angle, -1, axis=1) + np.pi - self.halfedge_angle_in_vertex

    @cached_property
    def holonomy(self) -> Float64[np.ndarray, "face"]:
        """The turn of a direction carried once around each face, counter-clockwise: its share of the curvature.

        On a closed mesh these sum to 2π times the Euler characteristic.
        """
        return self.scaled_corner_angle.sum(axis=1) - np.pi

    def to_corners(self, power: Complex[np.ndarray, "vertex"], order: int) -> Complex128[np.ndarray, "face 3"]:
        """Powers of directions at the vertices, as they are in the faces' frames."""
        return power[self.mesh.faces] * np.exp(1j * order * self.vertex_to_face)

    def to_vertices(self, power: Complex[np.ndarray, "face 3"], order: int) -> Complex128[np.ndarray, "vertex"]:
        """Powers of directions at face corners, as one unit number a vertex: the direction of their sum (0 stays 0)."""
        turned = (power * np.exp(-1j * order * self.vertex_to_face)).ravel()
        index, count = self.mesh.faces.ravel(), len(self.mesh.vertices)
        total = 1j * np.bincount(index, weights=np.imag(turned), minlength=count)
        total += np.bincount(index, weights=np.real(turned), minlength=count)
        return unit(total)


def unit(values: Complex[np.ndarray, "*shape"]) -> Complex128[np.ndarray, "*shape"]:
    """Complex numbers at length 1; what is 0 stays 0."""
    length = np.abs(values)
    return np.divide(values, length, out=np.zeros(values.shape, np.complex128), where=length > 1e-300)


def _polar_angles(mesh: Mesh, width: Float64[np.ndarray, "halfedge"]) -> Float64[np.ndarray, "halfedge"]:
    """Polar angle of every halfedge at its start, when the corner after it is ``width`` wide.

    All vertices are walked around at once, one corner a step: O(halfedges) work in as many steps as the highest
    valence. A vertex on a boundary starts at it, any other at its lowest halfedge.
    """
    start = _first_halfedges(mesh)
    angle = np.zeros(len(width))
    here = start[start >= 0]
    stop = here
    while len(here):
        face, corner = np.divmod(here, 3)
        following = mesh.twins[3 * face + (corner + 2) % 3]  # across the incoming side: counter-clockwise
        goes_on = (following >= 0) & (following != stop)
        angle[following[goes_on]] = angle[here[goes_on]] + width[here[goes_on]]
        here, stop = following[goes_on], stop[goes_on]
    return angle


def _first_halfedges(mesh: Mesh) -> Int32[np.ndarray, "vertex"]:
    """The halfedge that has polar angle 0 at each vertex, -1 for a vertex of no face."""
    tails = mesh.faces.ravel()
    first = np.full(len(mesh.vertices), -1, np.int32)
    first[tails[::-1]] = np.arange(len(tails), dtype=np.int32)[::-1]
    outer = np.flatnonzero(mesh.twins < 0).astype(np.int32)
    first[tails[outer]] = outer
    return first
