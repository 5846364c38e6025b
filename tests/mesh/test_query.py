import numpy as np
import pytest

from tests.meshes import all_meshes, flat_square, single_triangle, sphere
from texloom.mesh.query import barycentric, closest_points


@pytest.mark.parametrize("mesh", all_meshes().values(), ids=all_meshes().keys())
def test_points_on_the_surface_are_found_where_they_are(mesh):
    random = np.random.default_rng(0)
    faces = random.integers(0, len(mesh.faces), 40)
    weights = random.dirichlet([1, 1, 1], 40)
    points = np.einsum("pk,pkx->px", weights, mesh.vertices[mesh.faces[faces]])
    found, places = closest_points(mesh, points)
    reached = np.einsum("pk,pkx->px", places, mesh.vertices[mesh.faces[found]])
    np.testing.assert_allclose(reached, points, atol=1e-9 * mesh.diagonal + 1e-12 * np.abs(points).max())
    np.testing.assert_allclose(places.sum(axis=1), 1)
    assert places.min() >= 0


def test_points_off_the_surface_fall_on_the_nearest_place():
    faces, places = closest_points(flat_square(4), np.array([[0.3, 0.6, 2.0], [-1, 0.5, 0], [2, 2, 1]]))
    mesh = flat_square(4)
    reached = np.einsum("pk,pkx->px", places, mesh.vertices[mesh.faces[faces]])
    np.testing.assert_allclose(reached, [[0.3, 0.6, 0], [0, 0.5, 0], [1, 1, 0]], atol=1e-12)


def test_no_point_is_nearer_than_the_closest():
    mesh = sphere(2)
    points = np.random.default_rng(1).normal(size=(20, 3))
    faces, places = closest_points(mesh, points)
    reached = np.einsum("pk,pkx->px", places, mesh.vertices[mesh.faces[faces]])
    to_vertices = np.linalg.norm(points[:, None] - mesh.vertices, axis=2).min(axis=1)
    assert (np.linalg.norm(points - reached, axis=1) <= to_vertices + 1e-12).all()


def test_barycentric_coordinates_of_corners_and_centre():
    corners = single_triangle().vertices[None].repeat(4, axis=0)
    places = np.concatenate([corners[0], [corners[0].mean(axis=0)]])
    np.testing.assert_allclose(barycentric(corners, places), [*np.eye(3), [1 / 3] * 3], atol=1e-15)
