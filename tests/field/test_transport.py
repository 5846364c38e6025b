"""Transport on surfaces whose curvature is known."""

import numpy as np
import pytest

from tests.meshes import all_meshes, closed_meshes, flat_square, octahedron, sphere
from texloom.field.transport import Transport


@pytest.mark.parametrize("name", closed_meshes())
def test_holonomy_sums_to_the_euler_characteristic(name):
    mesh = closed_meshes()[name]
    euler = len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)
    np.testing.assert_allclose(Transport(mesh).holonomy.sum(), 2 * np.pi * euler, atol=1e-9)


@pytest.mark.parametrize("mesh", [octahedron(), sphere(3)], ids=["octahedron", "sphere"])
def test_holonomy_of_an_octant_is_a_right_angle(mesh):
    inside = (mesh.vertices[mesh.faces].mean(axis=1) > 0).all(axis=1)
    np.testing.assert_allclose(Transport(mesh).holonomy[inside].sum(), np.pi / 2)


@pytest.mark.parametrize("name", all_meshes())
def test_a_trip_around_a_face_turns_by_its_holonomy(name):
    transport = Transport(all_meshes()[name])
    around = np.exp(1j * transport.along_halfedge).prod(axis=1)
    np.testing.assert_allclose(around, np.exp(1j * transport.holonomy), atol=1e-9)


@pytest.mark.parametrize("name", all_meshes())
def test_there_and_back_is_no_turn(name):
    mesh = all_meshes()[name]
    turn = Transport(mesh).along_halfedge.ravel()
    paired = np.flatnonzero(mesh.twins >= 0)
    np.testing.assert_allclose(np.exp(1j * (turn[paired] + turn[mesh.twins[paired]])), 1, atol=1e-9)


def test_on_a_plane_transport_is_the_identity():
    mesh = flat_square(4)
    transport = Transport(mesh)
    axis = mesh.face_frames[:, :1, 0] + 1j * mesh.face_frames[:, :1, 1]
    # Directions of the plane in each vertex's polar angles, seen from every face around it
    at_corner = np.exp(1j * transport.vertex_to_face) * axis
    first = at_corner[0, 0]
    power = np.zeros(len(mesh.vertices), complex)
    power[mesh.faces.ravel()] = (first / at_corner).ravel()
    np.testing.assert_allclose(power[mesh.faces] * at_corner, first, atol=1e-12)
    np.testing.assert_allclose(
        power[mesh.faces] * np.exp(1j * transport.along_halfedge), np.roll(power[mesh.faces], -1, axis=1), atol=1e-12
    )


def test_corners_and_vertices_are_inverse():
    mesh = sphere(2)
    transport = Transport(mesh)
    power = np.exp(1j * np.random.default_rng(0).uniform(0, 6, len(mesh.vertices)))
    np.testing.assert_allclose(transport.to_vertices(transport.to_corners(power, 4), 4), power, atol=1e-12)
