"""Tangents at corners: against sums over corners that share all, one corner at a time."""

import numpy as np

from tests.output.shapes import sphere
from texloom.output.tangents import corner_tangents, face_tangents


def naive_tangents(mesh, uv, normals):
    """MikkTSpace by the letter: project, weigh by angle, sum over equal corners."""
    sums, keys, hands = {}, [], []
    for face, where, up in zip(mesh.faces, uv.astype(float), normals, strict=True):
        p = mesh.vertices[face]
        steps = np.array([where[1] - where[0], where[2] - where[0]])
        area = np.linalg.det(steps)
        hand = -1.0 if area < 0 else 1.0
        along = (np.linalg.solve(steps, [p[1] - p[0], p[2] - p[0]])[0]) if area else np.zeros(3)
        for c in range(3):
            a, b = p[(c + 1) % 3] - p[c], p[(c + 2) % 3] - p[c]
            angle = np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b))
            flat = along - up[c] * (along @ up[c])
            keys.append((face[c], where[c].tobytes(), hand))
            hands.append(hand)
            sums[keys[-1]] = sums.get(keys[-1], 0) + angle * flat / (np.linalg.norm(flat) or 1)
    total = np.array([sums[key] for key in keys])
    length = np.linalg.norm(total, axis=1, keepdims=True)
    unit = np.divide(total, length, out=np.zeros_like(total), where=length > 1e-9)
    return np.column_stack([unit, hands]).reshape(-1, 3, 4)


def test_tangents_are_sums_over_corners_that_share_all():
    mesh = sphere(6)
    normals = mesh.vertex_normals[mesh.faces]
    rng = np.random.default_rng(4)
    at_vertex = rng.random((len(mesh.vertices), 2))
    uv = at_vertex[mesh.faces]  # some faces mirrored
    alone = rng.random(len(uv)) < 0.3
    uv[alone] = rng.random((int(alone.sum()), 3, 2))
    uv[::11] = uv[::11, :1]  # no area
    uv = uv.astype(np.float32)
    found, expected = corner_tangents(mesh.vertices, mesh.faces, uv, normals=normals), naive_tangents(mesh, uv, normals)
    np.testing.assert_array_equal(found[..., 3], expected[..., 3])
    assert {-1.0, 1.0} == set(found[..., 3].ravel())
    np.testing.assert_allclose(np.linalg.norm(found[..., :3], axis=2), 1, atol=1e-6)
    lost = ~expected[..., :3].any(axis=2)
    assert 0 < lost.sum() < lost.size / 2
    np.testing.assert_allclose(found[~lost, :3], expected[~lost, :3], atol=1e-5)
    np.testing.assert_allclose(np.einsum("fci,fci->fc", found[..., :3], normals)[lost], 0, atol=1e-6)


def test_a_faces_tangent_is_where_u_grows():
    mesh = sphere(4)
    uv = np.random.default_rng(5).random((len(mesh.faces), 3, 2))
    tangent, sign = face_tangents(mesh.vertices, mesh.faces, uv)
    for face in range(len(uv)):
        p, steps = mesh.vertices[mesh.faces[face]], uv[face, 1:] - uv[face, 0]
        along = np.linalg.solve(steps, p[1:] - p[0])[0]
        np.testing.assert_allclose(tangent[face], along / np.linalg.norm(along), atol=1e-9)
        assert sign[face] == np.sign(np.linalg.det(steps))
