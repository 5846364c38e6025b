"""Radial basis functions: a partition of unity that meets its arrows."""

import numpy as np
import pytest

from tests.meshes import flat_square, sphere, two_parts
from texloom.errors import FieldError
from texloom.field import rbf
from texloom.field.direction import tangent_part, vertex_directions
from texloom.field.singularities import indices


def test_weights_are_one_at_their_own_arrow_and_sum_to_one():
    mesh, vertices = sphere(3), np.array([4, 0, 77, 200])
    weights, first = rbf.basis(mesh, vertices)
    np.testing.assert_allclose(weights[vertices[first]], np.eye(4), atol=0.05)  # heat distances are not quite symmetric
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-9)


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_equal_arrows_on_a_plane_are_a_constant_field(order):
    mesh = flat_square(10)
    direction = np.array([0.6, 0.8, 0.0])
    field = rbf.directions(mesh, order, vertices=np.array([0, 60, 120]), directions=np.tile(direction, (3, 1)))
    axis = mesh.face_frames[:, :1, 0] + 1j * mesh.face_frames[:, :1, 1]
    np.testing.assert_allclose(field.power * axis**order, (0.6 + 0.8j) ** order, atol=1e-5)


def test_the_field_passes_near_its_arrows():
    mesh, vertices = sphere(4), np.array([0, 2, 300])
    arrows = tangent_part(np.array([[0.1, 0.4, 1.0]]), mesh.vertex_normals[vertices])
    arrows /= np.linalg.norm(arrows, axis=1, keepdims=True)
    field = rbf.directions(mesh, 1, vertices=vertices, directions=arrows)
    found = vertex_directions(mesh, field)[vertices]
    assert np.sum(found * arrows, axis=1).min() > 0.97
    np.testing.assert_allclose(indices(mesh, field).sum(), 2)


def test_scales_are_met_and_bounded():
    mesh, vertices = flat_square(8), np.array([0, 80])
    found = rbf.scales(mesh, vertices=vertices, scales=np.array([1.0, 4.0]))
    np.testing.assert_allclose(found[vertices], [1, 4], rtol=1e-6)
    np.testing.assert_allclose(found[40], 2.0, rtol=0.05)
    assert 1 <= found.min() <= found.max() <= 4


def test_a_part_without_arrows_has_a_field_too():
    mesh = two_parts()
    field = rbf.directions(mesh, 4, vertices=np.array([0]), directions=np.array([[0.0, 1.0, 0.0]]))
    assert np.isfinite(field.power).all()
    np.testing.assert_allclose(np.abs(field.power), 1, atol=1e-5)


def test_no_arrow_is_refused():
    with pytest.raises(FieldError, match="need an arrow"):
        rbf.directions(flat_square(2), 1, vertices=np.array([], int), directions=np.empty((0, 3)))
