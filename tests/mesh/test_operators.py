import numpy as np
import pytest

from tests.meshes import all_meshes, flat_square, octahedron, sphere
from texloom.mesh.operators import cotangents, laplacian, mass

each_mesh = pytest.mark.parametrize("mesh", all_meshes().values(), ids=all_meshes().keys())


@each_mesh
def test_the_laplacian_is_symmetric_and_blind_to_constants(mesh):
    matrix = laplacian(mesh)
    scale = abs(matrix).max()
    assert abs(matrix - matrix.T).max() <= 1e-12 * scale
    np.testing.assert_allclose(matrix @ np.ones(len(mesh.vertices)), 0, atol=1e-9 * scale)


def test_linear_functions_are_harmonic_on_the_plane():
    mesh = flat_square(5)
    inside = ~mesh.boundary_vertices
    np.testing.assert_allclose((laplacian(mesh) @ mesh.vertices)[inside], 0, atol=1e-12)


def test_the_energy_of_a_linear_function_is_its_squared_slope_times_the_area():
    mesh = flat_square(4, size=2)
    height = mesh.vertices @ [3, 1, 0]
    assert height @ laplacian(mesh) @ height == pytest.approx(10 * 4)


def test_coordinates_on_a_sphere_are_eigenfunctions():
    mesh = sphere(4)
    energy = mesh.vertices.T @ laplacian(mesh) @ mesh.vertices
    np.testing.assert_allclose(energy, 2 * mesh.vertices.T @ mass(mesh) @ mesh.vertices, atol=0.02)


def test_cotangents_of_equilateral_faces():
    np.testing.assert_allclose(cotangents(octahedron()), 1 / np.sqrt(3))
