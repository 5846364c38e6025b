import numpy as np
import pytest

from tests.meshes import flat_square, sphere, tiny_far, two_parts
from texloom.errors import ParameterError
from texloom.mesh.geodesic import GeodesicDistances, distances


def test_distances_on_the_plane_are_straight():
    mesh = flat_square(32)
    centre = 16 * 33 + 16
    straight = np.linalg.norm(mesh.vertices - mesh.vertices[centre], axis=1)
    np.testing.assert_allclose(distances(mesh, centre), straight, atol=0.03)


@pytest.mark.parametrize("subdivisions", [3, 4])
def test_distances_on_a_sphere_are_arcs_and_better_on_finer_ones(subdivisions):
    mesh = sphere(subdivisions)
    arcs = np.arccos(np.clip(mesh.vertices @ mesh.vertices[4], -1, 1))
    assert np.abs(distances(mesh, 4) - arcs).mean() < 0.5 * 0.5**subdivisions


def test_the_nearest_source_counts():
    mesh = flat_square(16)
    both = distances(mesh, np.array([0, 288]))
    assert both[0] == 0 and both[288] == 0
    far = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[[0, 288]], axis=2).min(axis=1)
    np.testing.assert_allclose(both, far, atol=0.12)


def test_another_part_is_infinitely_far():
    mesh = two_parts()
    solver = GeodesicDistances(mesh)
    assert np.isinf(solver.from_vertices(0)).sum() == 25
    assert np.isinf(solver.from_vertices(70)).sum() == 66
    assert np.isfinite(solver.from_vertices(np.array([0, 70]))).all()


def test_scale_and_place_do_not_matter():
    near = distances(sphere(2), 4)
    np.testing.assert_allclose(distances(tiny_far(), 4) * 1e6, near, atol=1e-3)


def test_a_source_that_is_no_vertex_is_refused():
    with pytest.raises(ParameterError, match="vertex 99 .* has 9 vertices"):
        distances(flat_square(2), 99)
