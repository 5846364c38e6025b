import numpy as np
import pytest

from tests.meshes import all_meshes, boundary_meshes, closed_meshes, cone, flat_square, octahedron, sphere, torus
from texloom.mesh.mesh import Mesh, edge_runs

EULER = {"sphere": 2, "torus": 0, "octahedron": 2, "tetrahedron": 2, "flat_square": 1, "cone": 1, "cylinder": 0}
each_mesh = pytest.mark.parametrize("mesh", all_meshes().values(), ids=all_meshes().keys())


def naive_twins(mesh: Mesh) -> np.ndarray:
    """The halfedge that runs the other way, by a dictionary."""
    ends = {}
    for face, corners in enumerate(mesh.faces):
        for corner in range(3):
            ends[int(corners[corner]), int(corners[(corner + 1) % 3])] = 3 * face + corner
    return np.array([ends.get((head, tail), -1) for tail, head in ends])


@each_mesh
def test_twins_equal_the_naive_ones(mesh):
    np.testing.assert_array_equal(mesh.twins, naive_twins(mesh))


@each_mesh
def test_twins_do_not_depend_on_how_edges_are_sorted(mesh):
    shift = 2**31 - 2 - int(mesh.faces.max())
    huge = Mesh(mesh.vertices, (mesh.faces.astype(np.int64) + shift).astype(np.int32))  # too many to count
    np.testing.assert_array_equal(huge.twins, mesh.twins)


@each_mesh
def test_edges_come_in_one_order_however_they_are_sorted(mesh):
    for few, many in zip(edge_runs(mesh.faces), edge_runs(1000 * mesh.faces + 7), strict=True):
        np.testing.assert_array_equal(few, many)


@each_mesh
def test_every_halfedge_lies_on_its_edge(mesh):
    ends = np.stack([mesh.faces, mesh.faces[:, [1, 2, 0]]], axis=-1).reshape(-1, 2)
    np.testing.assert_array_equal(mesh.edges[mesh.halfedge_edges], np.sort(ends, axis=1))
    np.testing.assert_array_equal(mesh.edges, np.unique(np.sort(ends, axis=1), axis=0))


@pytest.mark.parametrize(("name", "mesh"), (closed_meshes() | boundary_meshes()).items())
def test_the_euler_characteristic_is_that_of_the_shape(name, mesh):
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.faces) == EULER[name]


def test_an_edge_that_is_not_two_opposite_halfedges_is_a_boundary():
    three = Mesh(np.eye(5, 3), np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]], np.int32))
    same_way = Mesh(np.eye(4, 3), np.array([[0, 1, 2], [0, 1, 3]], np.int32))
    assert (three.twins == -1).all()
    assert (same_way.twins == -1).all()


def test_edge_runs_count_the_faces_of_each_edge():
    order, starts, counts = edge_runs(np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]], np.int32))
    np.testing.assert_array_equal(counts, [3, 1, 1, 1, 1, 1, 1])
    np.testing.assert_array_equal(order[:3], [0, 3, 6])
    np.testing.assert_array_equal(starts, [0, 3, 4, 5, 6, 7, 8])


@each_mesh
def test_fans_are_walked_around_counter_clockwise(mesh):
    tails = mesh.faces.reshape(-1)
    met = [mesh.first_halfedges[mesh.first_halfedges >= 0]]
    for here, following in mesh.fan_steps:
        np.testing.assert_array_equal(tails[following], tails[here])
        incoming = here - here % 3 + (here + 2) % 3
        np.testing.assert_array_equal(mesh.twins[incoming], following)
        met.append(following)
    np.testing.assert_array_equal(np.sort(np.concatenate(met)), np.arange(len(tails)))
    assert mesh.agrees


@pytest.mark.parametrize("faces", [[[0, 1, 2], [1, 0, 3], [0, 1, 4]], [[0, 1, 2], [0, 1, 3]]])
def test_faces_that_do_not_agree(faces):
    assert not Mesh(np.eye(5, 3), np.array(faces, np.int32)).agrees


@each_mesh
def test_areas_and_angles_add_up(mesh):
    assert mesh.vertex_areas.sum() == pytest.approx(mesh.face_areas.sum())
    np.testing.assert_allclose(mesh.corner_angles.sum(axis=1), np.pi, rtol=1e-9)


def test_areas_of_known_shapes():
    assert flat_square(5, size=3).face_areas.sum() == pytest.approx(9)
    assert octahedron().face_areas.sum() == pytest.approx(8 * np.sqrt(3) / 2)


def test_the_angle_defect_sums_to_the_euler_characteristic():
    for mesh, euler in ((sphere(2), 2), (torus(), 0)):
        around = np.bincount(mesh.faces.reshape(-1), weights=mesh.corner_angles.reshape(-1))
        assert (2 * np.pi - around).sum() == pytest.approx(2 * np.pi * euler, abs=1e-9)


def test_normals_point_outward():
    mesh = sphere(4)
    np.testing.assert_allclose(mesh.vertex_normals, mesh.vertices, atol=0.01)
    np.testing.assert_allclose(flat_square(3).vertex_normals, np.tile([0, 0, 1], (16, 1)))


@each_mesh
def test_frames_are_orthonormal_and_right_handed(mesh):
    first, second = mesh.face_frames[:, 0], mesh.face_frames[:, 1]
    np.testing.assert_allclose(np.cross(first, second), mesh.face_normals, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(mesh.face_frames, axis=2), 1)
    sides = mesh.vertices[mesh.faces[:, 1]] - mesh.vertices[mesh.faces[:, 0]]
    np.testing.assert_allclose(np.cross(first, sides), 0, atol=1e-9)


def test_the_rim_of_a_cone_is_its_boundary():
    mesh = cone(12, 4)
    np.testing.assert_array_equal(mesh.boundary_vertices, np.abs(mesh.vertices[:, 2]) < 1e-12)
    assert not sphere(1).boundary_vertices.any()


def test_sizes():
    mesh = flat_square(2, size=3)
    assert mesh.longest_side == 3
    assert mesh.diagonal == pytest.approx(3 * np.sqrt(2))


def test_parts_are_numbered_by_their_lowest_vertex():
    parts = all_meshes()["two_parts"].vertex_parts
    np.testing.assert_array_equal(parts, np.repeat([0, 1], [66, 25]))
