"""Where a field turns around a point: the index of every face."""

import numpy as np
from jaxtyping import Complex128, Float64

from texloom.field.direction import DirectionField
from texloom.field.transport import Transport
from texloom.mesh.mesh import Mesh


def indices(mesh: Mesh, field: DirectionField) -> Float64[np.ndarray, "face"]:
    """Turns of the field around each face, in multiples of 1 / order; 0 where it is regular.

    Around the face the field turns by the smallest angles that take it along each edge; what that lacks of the
    face's holonomy is whole turns of the power (Knöppel et al. 2013, eq. 7). Over a closed mesh the indices sum to the
    Euler characteristic, whatever the field.
    """
    transport = Transport(mesh)
    power = transport.to_vertices(field.power, field.order)
    power = np.where(power == 0, 1.0, power)
    turn = _turns(mesh, power, np.exp(1j * field.order * transport.along_halfedge))
    return np.round((turn.sum(axis=1) + field.order * transport.holonomy) / (2 * np.pi)) / field.order


def _turns(
    mesh: Mesh, power: Complex128[np.ndarray, "vertex"], along: Complex128[np.ndarray, "face 3"]
) -> Float64[np.ndarray, "face 3"]:
    """Smallest turn of the power along each halfedge; halfedges of a pair turn oppositely, even by half a turn."""
    carried = power[mesh.faces] * along
    turn = np.angle(np.roll(power[mesh.faces], -1, axis=1) * np.conj(carried)).ravel()
    second = np.flatnonzero((mesh.twins >= 0) & (mesh.twins < np.arange(len(turn))))
    turn[second] = -turn[mesh.twins[second]]
    return turn.reshape(-1, 3)
