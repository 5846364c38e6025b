"""Differential operators on a mesh: cotangents, the Laplacian, the mass of vertices."""

from typing import Any

import numpy as np
from jaxtyping import Float64

from texloom.mesh.mesh import Mesh


def cotangents(mesh: Mesh) -> Float64[np.ndarray, "face 3"]:
    """Cotangent of the angle at every corner; negative where it is obtuse.

    The weight of halfedge ``3 f + c`` is half the cotangent at corner ``(c + 2) % 3``, the one it does not touch.
    """
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    doubled_area = np.maximum(2 * mesh.face_areas, np.finfo(np.float64).tiny)
    dots = [np.einsum("ij,ij->i", *sides) for sides in ((b - a, c - a), (c - b, a - b), (a - c, b - c))]
    return np.stack(dots, axis=1) / doubled_area[:, None]


def laplacian(mesh: Mesh) -> Any:
    """The cotangent Laplacian as a sparse matrix (CSC): positive semidefinite, rows sum to 0, no unit of length.

    ``(L x)_i = Σ_j w_ij (x_i - x_j)`` with ``w_ij`` half the sum of the two cotangents across the edge. Divide by
    ``mass`` for a pointwise value (Pinkall & Polthier 1993, eq. 2).
    """
    from scipy.sparse import coo_array

    weights = (0.5 * cotangents(mesh)[:, [2, 0, 1]]).reshape(-1)
    tails, heads = mesh.faces.reshape(-1), mesh.faces[:, [1, 2, 0]].reshape(-1)
    rows = np.concatenate([tails, heads, tails, heads])
    columns = np.concatenate([tails, heads, heads, tails])
    values = np.concatenate([weights, weights, -weights, -weights])
    count = len(mesh.vertices)
    return coo_array((values, (rows, columns)), shape=(count, count)).tocsc()


def mass(mesh: Mesh) -> Any:
    """Areas of the vertices on the diagonal of a sparse matrix (CSC), in squared world units."""
    from scipy.sparse import diags_array

    return diags_array(mesh.vertex_areas, format="csc")
