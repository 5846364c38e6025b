"""An n-fold direction field: what it is, and the ways between it and vectors in space.

Directions live in faces, so the field needs no chart of the surface: corner ``c`` of face ``f`` holds the n-th power of
its direction as a complex number in the face's own 2-D frame (``Mesh.face_frames``). A power does not tell apart
the n directions of a symmetric field, turns smoothly where they are relabelled, and vanishes at a singularity.
Between a tangent vector at a vertex and the faces around it lies the smallest rotation that takes the vertex normal to
the face normal: angles stay as they are, so vectors -> field -> vectors is the identity.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from jaxtyping import Complex64, Complex128, Float, Float64, Int32

from texloom.errors import FieldError
from texloom.kernels.frames import lay_into_faces
from texloom.kernels.launch import launch
from texloom.mesh.mesh import Mesh

ORDERS = (1, 2, 4, 6)
"""Symmetries offered: arrows, lines, crosses, hexagonal stars."""

_SHORT = 1e-9  # of the vector's length: below that a tangent part is rounding noise


@dataclass(frozen=True, eq=False)
class DirectionField:
    """``order`` directions at every point of a surface, equally spaced: 1, 2 (lines), 4 (crosses) or 6.

    ``power`` is the direction at each face corner raised to ``order``, in the face's frame. It is a unit number on
    the mesh the field was made on (0 where it has no direction); inside a face it is interpolated barycentrically and
    fades towards singularities.
    """

    order: int
    power: Complex64[np.ndarray, "face 3"]


class Refined(Protocol):
    """A finer mesh of the same surface (``texloom.mesh.refine``): every child face lies inside its parent face."""

    @property
    def mesh(self) -> Mesh: ...
    @property
    def parent(self) -> Int32[np.ndarray, "face"]: ...
    @property
    def corner_barycentric(self) -> Float[np.ndarray, "face 3 3"]: ...


def check_order(order: int) -> None:
    """Raises: FieldError, unless the field's symmetry is one of ``ORDERS``."""
    if order not in ORDERS:
        raise FieldError(f"a direction field of symmetry {order} is not offered: choose 1, 2, 4 or 6")


def from_vectors(mesh: Mesh, order: int, vectors: Float[np.ndarray, "vertex 3"]) -> DirectionField:
    """The field through a vector at every vertex; only its part along the surface counts, its length does not.

    A vector that is zero or along the normal leaves its vertex without a direction: a singularity, if they are few.

    Raises: FieldError, if the number of vectors is not that of the vertices or a number is not finite.
    """
    check_order(order)
    if vectors.shape != mesh.vertices.shape:
        raise FieldError(
            f"{len(vectors)} directions for {len(mesh.vertices)} vertices: give one x, y, z for each vertex"
        )
    if not np.isfinite(vectors).all():
        count = np.count_nonzero(~np.isfinite(vectors).all(axis=1))
        raise FieldError(f"{count} of {len(vectors)} directions are not finite numbers: give finite x, y, z")
    corners = corner_directions(mesh, tangent_part(vectors, mesh.vertex_normals))
    return DirectionField(order, (corners**order).astype(np.complex64))


def from_constant(mesh: Mesh, order: int, direction: Float[np.ndarray, "3"]) -> DirectionField:
    """The field along one direction in space, projected onto the surface.

    Raises: FieldError, if the direction is zero, not finite, or along the normal everywhere.
    """
    if not np.isfinite(direction).all() or not np.any(direction):
        raise FieldError("the direction must be three finite numbers, not all 0")
    field = from_vectors(mesh, order, np.broadcast_to(direction, mesh.vertices.shape))
    if not field.power.any():
        x, y, z = (f"{value:g}" for value in direction)
        raise FieldError(f"direction {x},{y},{z} is at a right angle to the whole surface: choose one along it")
    return field


def vertex_directions(mesh: Mesh, field: DirectionField) -> Float64[np.ndarray, "vertex 3"]:
    """A unit tangent vector at every vertex: the field's mean over the corners there.

    Of the ``order`` directions it is the one nearest to upright (``upright``), so that neighbours mostly agree. Where
    the field vanishes it is the upright direction itself.
    """
    reference = upright(mesh)
    relative = np.conj(corner_directions(mesh, reference)) ** field.order * field.power
    mean = sum_at_vertices(mesh, relative)
    turn = np.angle(mean) / field.order
    across = np.cross(mesh.vertex_normals, reference)
    return np.cos(turn)[:, None] * reference + np.sin(turn)[:, None] * across


def carry(field: DirectionField, mesh: Mesh, refined: Refined) -> DirectionField:
    """The same field on a finer mesh of the same surface.

    Children lie in their parent's plane: the power is interpolated, magnitude and all, then turned by the angle
    between the parent's frame and the child's.
    """
    parent_axes = mesh.face_frames[refined.parent]
    child_axis = refined.mesh.face_frames[:, 0]
    along, across = np.einsum("fad,fd->af", parent_axes, child_axis)
    power = np.einsum("fcb,fb->fc", refined.corner_barycentric, field.power[refined.parent])
    turned = power * ((along - 1j * across) ** field.order)[:, None]
    return DirectionField(field.order, turned.astype(np.complex64))


def upright(mesh: Mesh) -> Float64[np.ndarray, "vertex 3"]:
    """Unit tangents along which a texture stands upright: its rows run level, its up points to +y.

    Where the surface is level there is no such direction, and the texture's rows run along +x instead.
    """
    normals = mesh.vertex_normals
    level = np.stack([normals[:, 2], np.zeros(len(normals)), -normals[:, 0]], axis=1)  # +y × normal
    flat = np.linalg.norm(level, axis=1) < 0.1
    level[flat] = tangent_part(np.array([[1.0, 0.0, 0.0]]), normals[flat])
    return level / np.linalg.norm(level, axis=1, keepdims=True)


def tangent_part(
    vectors: Float[np.ndarray, "#vertex 3"], normals: Float64[np.ndarray, "vertex 3"]
) -> Float64[np.ndarray, "vertex 3"]:
    """Vectors without their part along the normal; exactly zero where nothing but rounding is left."""
    along = np.einsum("vd,vd->v", np.broadcast_to(vectors, normals.shape), normals)
    tangent = vectors - along[:, None] * normals
    nothing = np.linalg.norm(tangent, axis=1) <= _SHORT * np.linalg.norm(vectors, axis=1)
    tangent[nothing] = 0.0
    return tangent


def corner_directions(mesh: Mesh, tangents: Float64[np.ndarray, "vertex 3"]) -> Complex128[np.ndarray, "face 3"]:
    """A tangent vector of each vertex as unit complex numbers in the frames of the faces around it (0 stays 0)."""
    directions = np.empty((len(mesh.faces), 3), np.complex128)
    inputs = [mesh.faces, mesh.face_frames, mesh.vertex_normals, np.ascontiguousarray(tangents, np.float64)]
    outputs = [directions.view(np.float64).reshape(-1, 3, 2)]
    launch(lay_into_faces, len(mesh.faces), inputs=inputs, outputs=outputs)
    return directions


def sum_at_vertices(mesh: Mesh, corners: Complex128[np.ndarray, "face 3"]) -> Complex128[np.ndarray, "vertex"]:
    """The sum over the face corners at each vertex."""
    index, count = mesh.faces.ravel(), len(mesh.vertices)
    real = np.bincount(index, weights=np.real(corners).ravel(), minlength=count)
    return real + 1j * np.bincount(index, weights=np.imag(corners).ravel(), minlength=count)
