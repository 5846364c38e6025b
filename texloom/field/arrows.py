"""Arrows: what a user draws on a surface, and the vertices it falls on."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int64

from texloom.errors import FieldError
from texloom.field.direction import tangent_part
from texloom.mesh.mesh import Mesh

_STEEP = 0.01  # of an arrow's length: with less than that along the surface it has no direction there


@dataclass(frozen=True)
class Arrow:
    """A direction, a scale, or both, wanted at one place: a vertex, or the surface nearest to a point.

    ``direction`` is a vector in space (its length does not count), ``scale`` enlarges the texture.

    Raises: FieldError, if the place is not one of the two, or a number is not usable.
    """

    point: tuple[float, float, float] | None = None
    vertex: int | None = None
    direction: tuple[float, float, float] | None = None
    scale: float | None = None

    def __post_init__(self) -> None:
        if (self.point is None) == (self.vertex is None):
            raise FieldError('an arrow stands at a "point" or at a "vertex": give one of the two')
        if self.direction is None and self.scale is None:
            raise FieldError('an arrow asks for a "direction", a "scale" or both: this one for nothing')
        if self.point is not None and not np.isfinite(self.point).all():
            raise FieldError(f"an arrow's point {list(self.point)} is not finite: give finite x, y, z")
        if self.direction is not None and not (np.isfinite(self.direction).all() and np.any(self.direction)):
            raise FieldError(
                f"an arrow's direction {list(self.direction)} is no direction: give a finite, non-zero one"
            )
        if self.scale is not None and not (np.isfinite(self.scale) and self.scale > 0):
            raise FieldError(f"an arrow's scale is {self.scale:g}: give a finite number above 0")


@dataclass(frozen=True, eq=False)
class Placed:
    """Arrows on vertices, in the given order: those with a direction, and those with a scale."""

    direction_vertex: Int64[np.ndarray, "directed"]
    direction: Float64[np.ndarray, "directed 3"]  # unit tangents
    scale_vertex: Int64[np.ndarray, "scaled"]
    scale: Float64[np.ndarray, "scaled"]


def place(mesh: Mesh, arrows: Sequence[Arrow]) -> Placed:
    """Bring arrows to the mesh: points to the nearest corner of the nearest face, directions into the surface.

    Raises: FieldError, if a vertex does not exist or a direction is along the normal there.
    """
    vertices = _vertices(mesh, arrows)
    directed = np.array([arrow.direction is not None for arrow in arrows], bool)
    scaled = np.array([arrow.scale is not None for arrow in arrows], bool)
    directions = np.array([arrow.direction for arrow in arrows if arrow.direction is not None], float).reshape(-1, 3)
    scales = np.array([arrow.scale for arrow in arrows if arrow.scale is not None], float)
    tangents = _tangents(mesh, vertices[directed], directions, np.flatnonzero(directed))
    return Placed(vertices[directed], tangents, vertices[scaled], scales)


def _vertices(mesh: Mesh, arrows: Sequence[Arrow]) -> Int64[np.ndarray, "arrow"]:
    """The vertex each arrow falls on."""
    count = len(mesh.vertices)
    vertices = np.array([-1 if arrow.vertex is None else arrow.vertex for arrow in arrows], np.int64)
    at_point = np.array([arrow.point is not None for arrow in arrows], bool)
    wrong = np.flatnonzero(~at_point & ((vertices < 0) | (vertices >= count)))
    if len(wrong):
        raise FieldError(
            f"arrow {wrong[0]} stands at vertex {vertices[wrong[0]]}, but the mesh has {count}: use 0 to {count - 1}"
        )
    if at_point.any():
        from texloom.mesh.query import closest_points

        points = np.array([arrow.point for arrow in arrows if arrow.point is not None], float)
        face, barycentric = closest_points(mesh, points)
        vertices[at_point] = mesh.faces[face, np.argmax(barycentric, axis=1)]
    return vertices


def _tangents(
    mesh: Mesh, vertices: np.ndarray, directions: np.ndarray, number: np.ndarray
) -> Float64[np.ndarray, "arrow 3"]:
    """Unit tangents along the directions at their vertices; ``number`` is each arrow's own, to name it by."""
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    tangents = tangent_part(directions, mesh.vertex_normals[vertices])
    length = np.linalg.norm(tangents, axis=1)
    steep = np.flatnonzero(length < _STEEP)
    if len(steep):
        first = steep[0]
        x, y, z = (f"{value:.3g}" for value in directions[first])
        raise FieldError(
            f"arrow {number[first]} points along the normal of vertex {vertices[first]} ({x},{y},{z}): "
            "turn it along the surface"
        )
    return tangents / length[:, None]
