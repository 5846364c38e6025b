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
    corner = _corners(vertices, faces)
    tangent, sign = _face_tangents(corner, uv)
    weighted = np.empty((3, len(faces), 3))
    for k, angle in enumerate(_corner_angles(corner)):
        normal = np.ascontiguousarray(normals[:, k].T)
        weighted[:, :, k] = _unit(tangent - normal * _dot(tangent, normal)) * angle
    handed = np.repeat(sign.astype(np.int8), 3)
    first, group = shared_corners(faces.reshape(-1), uv.reshape(-1, 2), normals.reshape(-1, 3), handed)
    total = np.stack([np.bincount(group, along.reshape(-1), len(first)) for along in weighted])
    shared = np.empty((len(first), 4), np.float32)
    shared[:, :3] = _unit(total).T
    shared[:, 3] = handed[first]
    result = shared.take(group, axis=0).reshape(*faces.shape, 4)
    lost = (_length(total) < 1e-9)[group].reshape(faces.shape)
    if lost.any():
        result[lost, :3] = _any_tangent(np.asarray(normals)[lost])
    return result


def face_tangents(
    vertices: Float[np.ndarray, "vertex 3"], faces: Int[np.ndarray, "face 3"], uv: Float[np.ndarray, "face 3 2"]
) -> tuple[Float[np.ndarray, "face 3"], Float[np.ndarray, "face"]]:
    """dP/du of each face, unit, and +1 where u, v, normal are right-handed, −1 where the UVs are mirrored."""
    tangent, sign = _face_tangents(_corners(vertices, faces), uv)
    return np.ascontiguousarray(tangent.T), sign


# Below, vectors lie axis by axis: arithmetic on rows of three numbers costs several times as much.


def _corners(
    vertices: Float[np.ndarray, "vertex 3"], faces: Int[np.ndarray, "face 3"]
) -> list[Float[np.ndarray, "3 face"]]:
    """Positions of the first, second and third corner of every face."""
    along = np.ascontiguousarray(vertices.T)
    return [along.take(column, axis=1) for column in faces.T]


def _face_tangents(
    corner: list[Float[np.ndarray, "3 face"]], uv: Float[np.ndarray, "face 3 2"]
) -> tuple[Float[np.ndarray, "3 face"], Float[np.ndarray, "face"]]:
    """Those of ``face_tangents``."""
    e1, e2 = corner[1] - corner[0], corner[2] - corner[0]
    u, v = np.asarray(uv.transpose(2, 1, 0), np.float64, order="C")
    area = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0])
    sign = np.where(area < 0, -1.0, 1.0)
    return _unit((e1 * (v[2] - v[0]) - e2 * (v[1] - v[0])) * sign), sign


def _corner_angles(corner: list[Float[np.ndarray, "3 face"]]) -> list[Float[np.ndarray, "face"]]:
    """Interior angles at the first, second and third corner, radians."""
    along = [_unit(corner[(k + 1) % 3] - corner[k]) for k in range(3)]
    return [np.arccos(np.clip(-_dot(along[k], along[k - 1]), -1.0, 1.0)) for k in range(3)]


def _any_tangent(normals: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """Some unit direction across each normal."""
    axis = np.eye(3)[np.argmin(np.abs(normals), axis=-1)]
    return _unit(np.cross(normals, axis).T).T


def _dot(a: Float[np.ndarray, "3 *n"], b: Float[np.ndarray, "3 *n"]) -> Float[np.ndarray, "*n"]:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _length(vectors: Float[np.ndarray, "3 *n"]) -> Float[np.ndarray, "*n"]:
    return np.sqrt(_dot(vectors, vectors))


def _unit(vectors: Float[np.ndarray, "3 *n"]) -> Float[np.ndarray, "3 *n"]:
    """Unit vectors; zero stays zero."""
    length = _length(vectors)
    return vectors / np.where(length > 0, length, np.inf)
