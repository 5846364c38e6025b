"""Sweep distance: how far along a direction field every vertex lies from where the field begins.

Turk's talk orders the vertices of a mesh by it, but does not say what the start of a field is on a closed surface, or
of a field that runs in loops. Here it is the least-squares distance: the function whose steps along the edges agree
best with the field's, the zero being given vertices, or its own lowest value on each part of the mesh.
"""

import numpy as np
from jaxtyping import Float64, Int

from texloom.errors import FieldError
from texloom.field.direction import DirectionField, vertex_directions
from texloom.field.laplacian import connection_laplacian, edge_weights
from texloom.field.multigrid import Multigrid, principal_block
from texloom.field.transport import Transport
from texloom.mesh.mesh import Mesh

_TOLERANCE = 1e-6  # of the right-hand side: an order needs no more


def sweep_distance(
    mesh: Mesh, field: DirectionField, start: Int[np.ndarray, "start"] | None = None
) -> Float64[np.ndarray, "vertex"]:
    """Distance from the start along the field, in world units; negative before it, where the start is given.

    Minimises Σ w_ij (s_j − s_i − ½ (d_i + d_j) · (x_j − x_i))² over the edges, cotangent weights w and the field's
    directions d (of a symmetric field's the most upright). Parts without a vertex of ``start`` begin at their own
    lowest value. O(vertex) time.

    Raises: FieldError, if a start is no vertex.
    """
    fixed = np.zeros(len(mesh.vertices), bool)
    pinned = np.empty(0, np.int64) if start is None else np.asarray(start, np.int64)
    if len(pinned) and (pinned.min() < 0 or pinned.max() >= len(fixed)):
        raise FieldError(f"a sweep from vertex {pinned.max()}, but the last is {len(fixed) - 1} (counted from 0)")
    fixed[pinned] = True
    part = mesh.vertex_parts
    open_parts = ~np.isin(part, part[pinned])
    first = np.unique(part, return_index=True)[1]
    fixed[first[open_parts[first]]] = True
    distance = np.zeros(len(fixed))
    free = ~fixed
    if free.any():
        matrix = principal_block(connection_laplacian(Transport(mesh), 0), free)
        right = _divergence(mesh, field)[free].astype(complex)
        distance[free] = np.real(Multigrid(matrix).solve(right, tolerance=_TOLERANCE))
    lowest = np.full(len(first), np.inf)
    np.minimum.at(lowest, part, distance)
    return np.where(open_parts, distance - lowest[part], distance)


def _divergence(mesh: Mesh, field: DirectionField) -> Float64[np.ndarray, "vertex"]:
    """Σ_j w_ij of the steps wanted from each vertex's neighbours j to itself."""
    low, high = mesh.edges.T
    direction = vertex_directions(mesh, field)
    edge = mesh.vertices[high] - mesh.vertices[low]
    step = edge_weights(mesh) * 0.5 * np.einsum("ed,ed->e", direction[low] + direction[high], edge)
    count = len(mesh.vertices)
    return np.bincount(high, step, count) - np.bincount(low, step, count)
