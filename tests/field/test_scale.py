"""Scales between arrows."""

import numpy as np
import pytest

from tests.meshes import all_meshes, flat_square, sphere, two_parts
from texloom.errors import FieldError
from texloom.field.scale import checked, from_arrows, uniform


@pytest.mark.parametrize("smoothness", ["harmonic", "biharmonic"])
@pytest.mark.parametrize("name", all_meshes())
def test_arrows_are_met_and_bound_the_rest(name, smoothness):
    mesh = all_meshes()[name]
    vertices, scales = np.array([0, 1, 2]), np.array([1.0, 4.0, 0.5])
    found = from_arrows(mesh, vertices=vertices, scales=scales, smoothness=smoothness)
    np.testing.assert_allclose(found[vertices], scales, rtol=1e-9)
    assert found.min() >= 0.5 * (1 - 1e-9)
    assert found.max() <= 4.0 * (1 + 1e-9)


@pytest.mark.parametrize("smoothness", ["harmonic", "biharmonic"])
def test_one_arrow_is_one_scale(smoothness):
    found = from_arrows(sphere(2), vertices=np.array([5]), scales=np.array([3.0]), smoothness=smoothness)
    np.testing.assert_allclose(found, 3.0)


@pytest.mark.parametrize("smoothness", ["harmonic", "biharmonic"])
def test_half_way_between_poles_is_the_geometric_mean(smoothness):
    mesh = sphere(4)
    poles = np.array([0, 1])
    found = from_arrows(mesh, vertices=poles, scales=np.array([1.0, 4.0]), smoothness=smoothness)
    np.testing.assert_allclose(found[np.abs(mesh.vertices[:, 0]) < 1e-9], 2.0, rtol=1e-3)


def test_biharmonic_has_no_spikes():
    """Next to an arrow a smooth slope has hardly moved; the harmonic one is far off."""
    mesh = sphere(4)
    beside = np.flatnonzero((mesh.vertices[:, 0] > 0.99) & (mesh.vertices[:, 0] < 1))
    steps = {
        kind: np.abs(np.log(from_arrows(mesh, vertices=np.array([0, 1]), scales=np.array([1.0, 4.0]), smoothness=kind)))
        for kind in ("harmonic", "biharmonic")
    }
    assert steps["biharmonic"][beside].max() < 0.1 < steps["harmonic"][beside].max()


def test_a_part_without_arrows_takes_the_mean():
    mesh = two_parts()
    count = len(mesh.vertices) - 25
    found = from_arrows(mesh, vertices=np.array([0, 9]), scales=np.array([1.0, 9.0]))
    np.testing.assert_allclose(found[count:], 3.0)


def test_several_at_one_vertex_count_as_their_mean():
    found = from_arrows(flat_square(2), vertices=np.array([4, 4]), scales=np.array([1.0, 4.0]))
    np.testing.assert_allclose(found, 2.0)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.ones(8), "8 scales for 9 vertices"),
        (np.ones((9, 1)), "9 scales for 9 vertices"),
        (np.array([1, 1, 0, 1, 1, -1, 1, 1, 1.0]), "2 of 9 scales .* number 2: 0"),
        (np.full(9, np.nan), "9 of 9 scales"),
        (np.full(9, np.inf), "9 of 9 scales"),
    ],
)
def test_wrong_scales_are_named(values, message):
    with pytest.raises(FieldError, match=message):
        checked(flat_square(2), values)


def test_wrong_arrows_are_named():
    mesh = flat_square(2)
    with pytest.raises(FieldError, match="no arrow gives a scale"):
        from_arrows(mesh, vertices=np.array([], int), scales=np.array([]))
    with pytest.raises(FieldError, match="1 of 1 arrows' scales"):
        from_arrows(mesh, vertices=np.array([0]), scales=np.array([-1.0]))
    with pytest.raises(FieldError):
        uniform(mesh, 0.0)
    np.testing.assert_array_equal(uniform(mesh, 2.5), np.full(9, 2.5))
