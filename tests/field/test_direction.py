"""Vectors -> field -> vectors is the identity; a refined mesh carries the same field."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.meshes import all_meshes, closed_meshes, flat_square, sphere
from texloom.errors import FieldError
from texloom.field.direction import (
    DirectionField,
    carry,
    from_constant,
    from_vectors,
    tangent_part,
    upright,
    vertex_directions,
)
from texloom.mesh.refine import refine


def random_tangents(mesh, seed=0):
    tangents = tangent_part(np.random.default_rng(seed).normal(size=mesh.vertices.shape), mesh.vertex_normals)
    return tangents / np.linalg.norm(tangents, axis=1, keepdims=True)


def symmetric_mismatch(a, b, normals, order):
    """How far b is from the nearest of the ``order`` directions of a, as |power − 1|."""
    along, across = np.sum(a * b, axis=1), np.sum(np.cross(normals, a) * b, axis=1)
    return np.abs((along + 1j * across) ** order - 1)


@pytest.mark.parametrize("order", [1, 2, 4, 6])
@pytest.mark.parametrize("name", all_meshes())
def test_vectors_come_back(name, order):
    mesh = all_meshes()[name]
    given_directions = random_tangents(mesh)
    back = vertex_directions(mesh, from_vectors(mesh, order, 3.0 * given_directions))
    assert symmetric_mismatch(given_directions, back, mesh.vertex_normals, order).max() < 1e-5
    if order == 1:
        np.testing.assert_allclose(back, given_directions, atol=1e-6)


def test_vertex_directions_are_unit_tangents():
    mesh = sphere(2)
    found = vertex_directions(mesh, from_vectors(mesh, 4, random_tangents(mesh)))
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(np.sum(found * mesh.vertex_normals, axis=1), 0, atol=1e-12)


@given(st.floats(-np.pi, np.pi))
def test_constant_field_on_a_plane_is_its_power(angle):
    mesh = flat_square(3)
    direction = np.array([np.cos(angle), np.sin(angle), 0.5])  # the part along the normal does not count
    field = from_constant(mesh, 2, direction)
    axis = mesh.face_frames[:, 0, 0] + 1j * mesh.face_frames[:, 0, 1]
    expected = (np.exp(1j * angle) / axis) ** 2
    np.testing.assert_allclose(field.power, np.repeat(expected[:, None], 3, axis=1), atol=1e-6)


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_carry_is_the_parent_field(order):
    mesh = sphere(1)
    field = from_vectors(mesh, order, random_tangents(mesh))
    refined = refine(mesh, 0.2)
    carried = carry(field, mesh, refined)

    # The child's direction in space, taken back into the parent's frame, has the parent's interpolated power.
    angle = np.angle(carried.power) / order
    first, second = refined.mesh.face_frames[:, None, 0], refined.mesh.face_frames[:, None, 1]
    in_space = np.cos(angle)[..., None] * first + np.sin(angle)[..., None] * second
    x, y = np.einsum("fad,fcd->afc", mesh.face_frames[refined.parent], in_space)
    parent_power = np.einsum("fcb,fb->fc", refined.corner_barycentric, field.power[refined.parent])
    np.testing.assert_allclose(np.abs(carried.power) * (x + 1j * y) ** order, parent_power, atol=2e-5)


def test_carry_to_itself_changes_nothing():
    mesh = sphere(2)
    field = from_vectors(mesh, 4, random_tangents(mesh))
    np.testing.assert_allclose(carry(field, mesh, refine(mesh, 10.0)).power, field.power, atol=1e-6)


@pytest.mark.parametrize("name", closed_meshes())
def test_upright_stands_up(name):
    mesh = closed_meshes()[name]
    up = np.cross(mesh.vertex_normals, upright(mesh))
    steep = np.hypot(mesh.vertex_normals[:, 0], mesh.vertex_normals[:, 2]) > 0.1
    assert (up[steep, 1] > 0).all()


def test_field_without_directions_shows_upright():
    mesh = flat_square(2)
    nothing = DirectionField(4, np.zeros((len(mesh.faces), 3), np.complex64))
    np.testing.assert_allclose(vertex_directions(mesh, nothing), upright(mesh))


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda mesh: from_vectors(mesh, 3, mesh.vertices), "symmetry 3"),
        (lambda mesh: from_vectors(mesh, 1, mesh.vertices[:-1]), "8 directions for 9 vertices"),
        (lambda mesh: from_vectors(mesh, 1, np.full_like(mesh.vertices, np.nan)), "9 of 9 directions are not finite"),
        (lambda mesh: from_constant(mesh, 1, np.zeros(3)), "not all 0"),
        (lambda mesh: from_constant(mesh, 1, np.array([0.0, 0.0, 2.0])), "0,0,2 is at a right angle"),
    ],
)
def test_wrong_input_is_named(build, message):
    with pytest.raises(FieldError, match=message):
        build(flat_square(2))
