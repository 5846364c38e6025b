"""Tangent frames that an atlas's UVs imply, as viewers rebuild them."""

import numpy as np
from jaxtyping import Float, Float32, Int

from texloom.output.corners import shared_corners


def corner_tangents(
    vertices: Float[np.ndarray, "vertex 3"],
    faces: Int[np.ndarray, "face 3"],
    uv: Float[np.ndarray, "face 3 2"],
    *,
    normals: Float[np.ndarray, "face 3 3"],
) -> Float32[np.ndarray, "face 3 4"]:
    """glTF tangents at every corner: (x, y, z, w), the direction of +u and the handedness, bitangent = w n × t.

    As MikkTSpace: each face's tangent is projected on the corner's normal and averaged by corner angle over the corners
    that share vertex, uv, normal and handedness. Departure: MikkTSpace also splits groups where faces are joined by
    no edge; that is not done. A face without area in UV takes any tangent.
    """
    tangent, sign = _face_tangents(vertices, faces, uv)
    flat = tangent[:, None, :] - normals * np.einsum("fi,fci->fc", tangent, normals)[..., None]
    flat = _unit(flat) * _corner_angles(vertices[faces])[..., None]
    handed = np.repeat(sign.astype(np.int8), 3)
    first, group = shared_corners(faces.reshape(-1), uv.reshape(-1, 2), normals.reshape(-1, 3), handed)
    total = np.stack([np.bincount(group, flat[..., axis].reshape(-1), len(first)) for axis in range(3)], axis=1)
    shared = total[group].reshape(*faces.shape, 3)
    lost = np.linalg.norm(shared, axis=2) < 1e-9
    shared[lost] = _any_tangent(np.asarray(normals)[lost])
    result = np.empty((*faces.shape, 4), np.float32)
    result[..., :3] = _unit(shared)
    result[..., 3] = sign[:, None]
    return result


def _face_tangents(
    vertices: Float[np.ndarray, "vertex 3"], faces: Int[np.ndarray, "face 3"], uv: Float[np.ndarray, "face 3 2"]
) -> tuple[Float[np.ndarray, "face 3"], Float[np.ndarray, "face"]]:
    """dP/du of each face, not unit, and +1 where u, v, normal are right-handed, −1 where the UVs are mirrored."""
    corner = vertices[faces]
    e1, e2 = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    uv = np.asarray(uv, np.float64)
    d1, d2 = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    area = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
    sign = np.where(area < 0, -1.0, 1.0)
    return _unit((e1 * d2[:, 1:] - e2 * d1[:, 1:]) * sign[:, None]), sign


def _corner_angles(corner: Float[np.ndarray, "face 3 3"]) -> Float[np.ndarray, "face 3"]:
    """Interior angles, radians."""
    ahead = _unit(np.roll(corner, -1, axis=1) - corner)
    back = _unit(np.roll(corner, 1, axis=1) - corner)
    return np.arccos(np.clip(np.einsum("fci,fci->fc", ahead, back), -1.0, 1.0))


def _any_tangent(normals: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """Some direction across each normal."""
    axis = np.eye(3)[np.argmin(np.abs(normals), axis=-1)]
    return np.cross(normals, axis)


def _unit(vectors: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors, dtype=np.float64), where=length > 0)
