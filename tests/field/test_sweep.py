"""Sweep distances."""

import numpy as np
import pytest

from tests.meshes import all_meshes, flat_square, sphere, two_parts
from texloom.errors import FieldError
from texloom.field.direction import from_constant, from_vectors
from texloom.field.smooth import smoothest
from texloom.field.sweep import sweep_distance


@pytest.mark.parametrize("order", [1, 2])
def test_along_a_constant_field_it_is_the_coordinate(order):
    mesh = flat_square(9)
    along = np.array([1.0, 0.0, 0.0])
    field = from_constant(mesh, order, along)
    at = mesh.vertices @ along
    np.testing.assert_allclose(sweep_distance(mesh, field), at - at.min(), atol=1e-9)
    start = int(np.argmax(at))
    np.testing.assert_allclose(sweep_distance(mesh, field, np.array([start])), at - at.max(), atol=1e-9)


def test_from_pole_to_pole():
    """Meridians from the south pole: between the poles, where the field has no direction, the distance is the arc."""
    mesh = sphere(4)
    field = from_vectors(mesh, 1, np.array([[0.0, 0.0, 1.0]]) - mesh.vertices[:, 2:] * mesh.vertices)
    latitude = np.arcsin(np.clip(mesh.vertices[:, 2], -1, 1))
    distance, between = sweep_distance(mesh, field), np.abs(mesh.vertices[:, 2]) < 0.95
    equator = distance[np.abs(mesh.vertices[:, 2]) < 1e-9].mean()
    np.testing.assert_allclose((distance - equator)[between], latitude[between], atol=0.01)
    assert distance.argmin() == mesh.vertices[:, 2].argmin() and distance.argmax() == mesh.vertices[:, 2].argmax()


@pytest.mark.parametrize("name", all_meshes())
def test_every_part_begins_at_zero_and_follows_the_field(name):
    mesh = all_meshes()[name]
    distance = sweep_distance(mesh, smoothest(mesh, 1))
    for part in np.unique(mesh.vertex_parts):
        assert distance[mesh.vertex_parts == part].min() == pytest.approx(0.0, abs=1e-9)
    assert np.isfinite(distance).all()


def test_parts_are_measured_apart():
    mesh = two_parts()
    field = smoothest(mesh, 1)
    whole = sweep_distance(mesh, field)
    first = int(np.flatnonzero(mesh.vertex_parts == 0)[0])
    anchored = sweep_distance(mesh, field, np.array([first]))
    assert anchored[first] == 0.0
    np.testing.assert_allclose(anchored[mesh.vertex_parts == 1], whole[mesh.vertex_parts == 1], atol=1e-9)
    here = mesh.vertex_parts == 0
    np.testing.assert_allclose(anchored[here], whole[here] - whole[first], atol=1e-4)


def test_a_start_beyond_the_mesh_is_refused():
    mesh = flat_square(3)
    with pytest.raises(FieldError, match="a sweep from vertex 99, but the last is"):
        sweep_distance(mesh, smoothest(mesh, 1), np.array([99]))
