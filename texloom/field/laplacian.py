"""The connection Laplacian of n-fold directions on the vertices of a mesh."""

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float64

from texloom.field.transport import Transport
from texloom.mesh.mesh import Mesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_WEIGHT_RANGE = (1e-2, 1e2)  # an equilateral mesh has 0.58; see edge_weights


def connection_laplacian(transport: Transport, order: int) -> "csr_array":
    """The Hermitian matrix of the energy Σ w_ij |u_j − r_ij^n u_i|² over the edges, r_ij the turn along the edge.

    ``order`` 0 has no turn: the Laplacian of plain numbers. Vertices of no face get a 1 on the diagonal.
    """
    from scipy.sparse import csr_array, diags_array

    mesh, count = transport.mesh, len(transport.mesh.vertices)
    weights = edge_weights(mesh)
    turned = -weights * np.exp(-1j * order * _turn_along_edges(transport))
    row_starts = np.searchsorted(mesh.edges[:, 0], np.arange(count + 1)).astype(np.int32)
    upper = csr_array((turned, mesh.edges[:, 1], row_starts), shape=(count, count))
    diagonal = np.bincount(mesh.edges.ravel(), weights=np.repeat(weights, 2), minlength=count)
    diagonal[diagonal == 0] = 1.0
    return csr_array(upper + upper.conj().T.tocsr() + diags_array(diagonal.astype(complex), format="csr"))


def edge_weights(mesh: Mesh) -> Float64[np.ndarray, "edge"]:
    """Half the sum of the cotangents across each edge, kept within fixed bounds.

    Slivers and obtuse pairs give weights that are huge, zero or negative, with which the energy is no measure of
    smoothness; within bounds the matrix is diagonally dominant on any mesh.
    """
    opposite = mesh.corner_angles.take([2, 0, 1], axis=1)  # halfedge c faces corner c + 2
    cotangents = 0.5 / np.tan(np.clip(opposite, 1e-6, np.pi - 1e-6))
    weights = np.bincount(mesh.halfedge_edges, weights=cotangents.ravel(), minlength=len(mesh.edges))
    return np.clip(weights, *_WEIGHT_RANGE)


def _turn_along_edges(transport: Transport) -> Float64[np.ndarray, "edge"]:
    """The turn from the lower vertex of each edge to the higher one."""
    mesh = transport.mesh
    turns = np.empty(len(mesh.edges))
    is_forward = (mesh.faces < mesh.faces.take([1, 2, 0], axis=1)).ravel()
    forward, backward = np.flatnonzero(is_forward), np.flatnonzero(~is_forward)
    along = transport.along_halfedge.ravel()
    turns[mesh.halfedge_edges[backward]] = -along[backward]
    turns[mesh.halfedge_edges[forward]] = along[forward]
    return turns
