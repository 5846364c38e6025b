"""Directions spread from arrows over a hierarchy of points, coarse to fine (Turk, "Texture Synthesis on Surfaces").

Vectors are zero but at the arrows. They are taken down to the coarsest points, blurred there until all are reached,
and taken up again, a few blurs on each level; at the arrows they stay. It is the pull and push of sparse interpolation
(Gortler et al. 1996). ``field.smooth`` solves for the smoothest field instead, and is the default.
"""

import numpy as np
from jaxtyping import Float, Float64, Int

from texloom.errors import FieldError
from texloom.field.direction import DirectionField, check_order, from_vectors
from texloom.mesh.mesh import Mesh
from texloom.mesh.query import closest_points
from texloom.points import Hierarchy, Pyramid, hierarchy

_COARSEST, _FINEST = 500, 16_000  # points; beyond, directions change too little to be worth the time
_RATIO = 4
_COARSE_BLURS = 400  # until the farthest of the coarsest points are reached, and some more
_FINE_BLURS = 4


def directions(
    mesh: Mesh, order: int, *, vertices: Int[np.ndarray, "arrow"], directions: Float[np.ndarray, "arrow 3"]
) -> DirectionField:
    """The field through unit tangents at a few vertices. Parts of the mesh without an arrow have no direction.

    Vectors are spread, not lines or crosses: a symmetric field is that of the spread vectors. Takes as long as the
    points (``texloom.points``), a second or two.

    Raises: FieldError, if the symmetry is not 1, 2, 4 or 6 or there is no arrow; ParameterError, where the mesh has too
    many parts or holes for so few points.
    """
    check_order(order)
    if len(vertices) == 0:
        raise FieldError("there are no arrows to spread: give one or more")
    points = hierarchy(mesh, _counts(len(mesh.vertices)))
    spread = _spread(points, mesh.vertices[vertices], np.asarray(directions, np.float64))
    finest = points.levels[-1].mesh
    face, barycentric = closest_points(finest, mesh.vertices)
    at_vertices = np.einsum("vc,vcd->vd", barycentric, spread[finest.faces[face]])
    at_vertices[vertices] = directions
    return from_vectors(mesh, order, at_vertices)


def _spread(
    points: Hierarchy, places: Float64[np.ndarray, "arrow 3"], arrows: Float64[np.ndarray, "arrow 3"]
) -> Float64[np.ndarray, "point 3"]:
    """Unit vectors at the finest points."""
    pyramid, last = Pyramid(points), len(points.levels) - 1
    frozen = [_nearest(level.position, places) for level in points.levels]
    vectors = np.zeros((points.levels[last].count, 3))
    vectors[frozen[last]] = arrows
    for level in range(last, 0, -1):
        vectors = pyramid.down_vectors(level, vectors)
    for level in range(last + 1):
        if level:
            vectors = pyramid.up_vectors(level - 1, vectors)
        vectors[frozen[level]] = arrows
        for _ in range(_FINE_BLURS if level else _COARSE_BLURS):
            vectors = _unit(pyramid.blur_vectors(level, vectors))
            vectors[frozen[level]] = arrows
    return vectors


def _counts(vertices: int) -> tuple[int, ...]:
    """Points of each level, about as many as the mesh has vertices on the finest."""
    finest = min(max(vertices, _COARSEST), _FINEST)
    counts = [finest]
    while counts[0] >= _RATIO * _COARSEST:
        counts.insert(0, counts[0] // _RATIO)
    return tuple(counts)


def _nearest(
    positions: Float64[np.ndarray, "point 3"], places: Float64[np.ndarray, "arrow 3"]
) -> Int[np.ndarray, "arrow"]:
    """The point nearest to each arrow, the lowest of equals."""
    return np.array([((positions - place) ** 2).sum(axis=1).argmin() for place in places])


def _unit(vectors: Float64[np.ndarray, "point 3"]) -> Float64[np.ndarray, "point 3"]:
    """Unit vectors; what nothing has reached yet stays zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 1e-12)
