"""The direction and scale fields of local resampling: radial basis functions over geodesic distance (§3.1, C1).

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", interpolate vectors at a few
vertices by radial functions of the distance along the surface, then smooth locally. They name neither function nor
smoothing; ours is the distance itself with a constant (the linear polyharmonic spline), which needs no width, and one
implicit smoothing step. Departure: each arrow is first turned from its own tangent plane into that of the vertex, and
n-th powers are interpolated, so that symmetric fields can be.
"""

import numpy as np
from jaxtyping import Complex128, Float, Float64, Int

from texloom.errors import FieldError
from texloom.field.direction import DirectionField, check_order
from texloom.field.frames import VertexFrames
from texloom.field.multigrid import one_thread
from texloom.field.smooth import near
from texloom.mesh.mesh import Mesh

_REACH = 0.02  # of the diagonal: how far the local smoothing reaches


def directions(
    mesh: Mesh, order: int, *, vertices: Int[np.ndarray, "arrow"], directions: Float[np.ndarray, "arrow 3"]
) -> DirectionField:
    """The field through unit tangents at a few vertices. Smoothing may turn it there by a little, as in the paper.

    Costs one distance field an arrow. Raises: FieldError, if the symmetry is not 1, 2, 4 or 6 or there is no arrow.
    """
    check_order(order)
    weights, first = basis(mesh, vertices)
    frames = VertexFrames(mesh, order)
    power = np.zeros(len(mesh.vertices), complex)
    for column, arrow in enumerate(first):
        power += weights[:, column] * _spread(frames, int(vertices[arrow]), directions[arrow])
    length = np.abs(power)
    known = length > 1e-6
    power[known] /= length[known]
    return near(mesh, order, power=power, weight=known / (_REACH * mesh.diagonal) ** 2)


def scales(
    mesh: Mesh, *, vertices: Int[np.ndarray, "arrow"], scales: Float[np.ndarray, "arrow"]
) -> Float64[np.ndarray, "vertex"]:
    """The scales given at a few vertices, interpolated as logarithms and kept within their range."""
    weights, first = basis(mesh, vertices)
    logs = np.log(scales[first])
    return np.exp(np.clip((weights * logs).sum(axis=1), logs.min(), logs.max()))


def basis(
    mesh: Mesh, vertices: Int[np.ndarray, "arrow"]
) -> tuple[Float64[np.ndarray, "vertex centre"], Int[np.ndarray, "centre"]]:
    """What each arrow weighs at every vertex: 1 at its own, 0 at the others', summing to 1; and which arrows count.

    Of several arrows at one vertex the first counts. Parts of the mesh without an arrow weigh all alike.
    """
    from texloom.mesh.geodesic import GeodesicDistances

    if len(vertices) == 0:
        raise FieldError("radial basis functions need an arrow: give one, or choose the smooth field")
    centres, first = np.unique(vertices, return_index=True)
    solver = GeodesicDistances(mesh)
    distance = np.stack([solver.from_vertices(np.array([centre])) for centre in centres], axis=1) / mesh.diagonal
    apart = 2 * np.max(distance, where=np.isfinite(distance), initial=1.0)
    distance[~np.isfinite(distance)] = apart  # no way from there: as far from all of them
    count = len(centres)
    between = distance[centres]
    system = np.ones((count + 1, count + 1))
    system[:count, :count] = (between + between.T) / 2
    system[count, count] = 0.0
    rows = np.concatenate([distance, np.ones((len(distance), 1))], axis=1)
    with one_thread():
        return np.linalg.solve(system, rows.T)[:count].T, first


def _spread(frames: VertexFrames, vertex: int, direction: Float[np.ndarray, "3"]) -> Complex128[np.ndarray, "vertex"]:
    """A tangent of one vertex turned by the smallest rotation into every other tangent plane, as powers."""
    normals = frames.mesh.vertex_normals
    own = normals[vertex]
    cosine = np.maximum(normals @ own, -0.999)
    turned = direction - (normals @ direction / (1.0 + cosine))[:, None] * (normals + own)
    return frames.powers(np.arange(len(normals)), turned)
