"""Principal directions where they are known."""

import numpy as np
import pytest

from tests.meshes import cylinder, flat_square, sphere, tiny_far, torus
from texloom.errors import FieldError
from texloom.field.curvature import along_curvature
from texloom.field.direction import vertex_directions
from texloom.field.singularities import indices


def test_a_cylinder_has_lines_along_its_axis():
    mesh = cylinder(32, 12)
    found = vertex_directions(mesh, along_curvature(mesh, 2))
    inside = np.abs(mesh.vertices[:, 2] - 1) < 0.7
    assert np.abs(found[inside, 2]).min() > 0.99


def test_crosses_on_a_cylinder_follow_axis_and_rim():
    mesh = cylinder(32, 12)
    found = vertex_directions(mesh, along_curvature(mesh, 4))
    inside = np.abs(mesh.vertices[:, 2] - 1) < 0.7
    along = np.abs(found[inside, 2])
    assert np.minimum(along, 1 - along).max() < 0.05


def test_a_torus_has_lines_the_long_way_outside():
    mesh = torus(48, 24)
    field = along_curvature(mesh, 2)
    found = vertex_directions(mesh, field)
    outside = np.linalg.norm(mesh.vertices[:, :2], axis=1) > 1.3
    around = np.cross([0, 0, 1], mesh.vertices)
    around /= np.linalg.norm(around, axis=1, keepdims=True)
    assert np.abs(np.sum(found * around, axis=1))[outside].min() > 0.98
    np.testing.assert_allclose(indices(mesh, field).sum(), 0, atol=1e-9)


@pytest.mark.parametrize("mesh", [flat_square(6), sphere(2), tiny_far()], ids=["plane", "sphere", "tiny far sphere"])
def test_where_curvature_has_no_direction_the_field_is_smooth(mesh):
    field = along_curvature(mesh, 4)
    assert np.isfinite(field.power).all()
    np.testing.assert_allclose(np.abs(field.power), 1, atol=1e-5)
    assert np.count_nonzero(indices(mesh, field)) <= 24


@pytest.mark.parametrize("order", [1, 6])
def test_other_symmetries_are_refused(order):
    with pytest.raises(FieldError, match=f"2 or 4, not {order}"):
        along_curvature(cylinder(), order)
