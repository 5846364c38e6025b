import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.meshes import all_meshes, as_mesh, flat_square, octahedron, slivers, sphere
from texloom.errors import MeshError
from texloom.mesh.mesh import Mesh
from texloom.mesh.refine import estimate_sites, refine

each_mesh = pytest.mark.parametrize("mesh", all_meshes().values(), ids=all_meshes().keys())


def shape_quality(mesh: Mesh) -> np.ndarray:
    """1 for an equilateral face, 0 for one without area."""
    sides = mesh.edge_lengths[mesh.halfedge_edges].reshape(-1, 3)
    return 4 * np.sqrt(3) * mesh.face_areas / (sides**2).sum(axis=1)


@each_mesh
def test_no_edge_is_longer_than_wanted_and_no_crack_opens(mesh):
    length = mesh.diagonal / 25
    finer = refine(mesh, length).mesh
    assert finer.edge_lengths.max() <= length
    assert len(finer.vertices) - len(finer.edges) + len(finer.faces) == len(mesh.vertices) - len(mesh.edges) + len(
        mesh.faces
    )
    boundary = finer.edge_lengths[finer.halfedge_edges[finer.twins < 0]].sum()
    assert boundary == pytest.approx(mesh.edge_lengths[mesh.halfedge_edges[mesh.twins < 0]].sum(), rel=1e-6)


@each_mesh
def test_the_surface_stays_what_it_was(mesh):
    finer = refine(mesh, mesh.diagonal / 25)
    corners = mesh.vertices[mesh.faces[finer.parent]]
    places = np.einsum("fck,fkx->fcx", finer.corner_barycentric.astype(float), corners)
    scale = np.abs(mesh.vertices).max()
    np.testing.assert_allclose(places, finer.mesh.vertices[finer.mesh.faces], atol=1e-12 * scale)
    corners = mesh.vertices[mesh.faces[finer.vertex_parent_face]]
    places = np.einsum("vk,vkx->vx", finer.vertex_barycentric.astype(float), corners)
    np.testing.assert_allclose(places, finer.mesh.vertices, atol=1e-12 * scale)
    np.testing.assert_array_equal(finer.mesh.vertices[: len(mesh.vertices)], mesh.vertices)
    area = np.bincount(finer.parent, weights=finer.mesh.face_areas)
    np.testing.assert_allclose(area, mesh.face_areas, rtol=1e-5)
    assert (np.diff(finer.parent) >= 0).all()
    aligned = np.einsum("fx,fx->f", finer.mesh.face_normals, mesh.face_normals[finer.parent])
    assert aligned.min() > 0.999


def test_a_mesh_that_is_fine_enough_comes_back_itself():
    mesh = sphere(2)
    same = refine(mesh, 10.0)
    assert same.mesh is mesh
    np.testing.assert_array_equal(same.parent, np.arange(len(mesh.faces)))
    np.testing.assert_array_equal(same.corner_barycentric, np.tile(np.eye(3), (len(mesh.faces), 1, 1)))


def test_a_length_for_every_vertex_grades_the_mesh():
    mesh = flat_square(2)
    wanted = 0.02 + 0.2 * mesh.vertices[:, 0]
    finer = refine(mesh, wanted).mesh
    middle = finer.vertices[finer.edges].mean(axis=1)
    assert (finer.edge_lengths <= 0.02 + 0.2 * middle[:, 0] + 1e-9).all()
    assert finer.edge_lengths[middle[:, 0] > 0.8].mean() > 3 * finer.edge_lengths[middle[:, 0] < 0.1].mean()


def test_one_length_and_the_same_at_every_vertex_agree():
    mesh = octahedron()
    one, many = refine(mesh, 0.2), refine(mesh, np.full(6, 0.2))
    np.testing.assert_array_equal(one.mesh.faces, many.mesh.faces)
    np.testing.assert_array_equal(one.mesh.vertices, many.mesh.vertices)


def test_thin_faces_become_rounder_not_thinner():
    mesh = slivers(4, thinness=0.02)
    finer = refine(mesh, 0.02).mesh
    assert np.mean(shape_quality(finer)) > 2 * np.mean(shape_quality(mesh))
    assert shape_quality(finer).min() > 0.5 * shape_quality(mesh).min()


def test_equilateral_faces_stay_so():
    np.testing.assert_allclose(shape_quality(refine(octahedron(), 0.1).mesh), 1)


@settings(deadline=None)
@given(st.floats(0.05, 0.5))
def test_the_estimate_is_near(length):
    for mesh in (octahedron(), flat_square(3)):
        assert estimate_sites(mesh, length) == pytest.approx(len(refine(mesh, length).mesh.vertices), rel=0.6)


def test_a_length_beyond_reason_is_refused():
    with pytest.raises(MeshError, match=r"refining edges to 1e-09 would need about .* vertices"):
        refine(sphere(1), 1e-9)
    with pytest.raises(MeshError, match="a length of 0"):
        refine(sphere(1), 0.0)


@pytest.mark.parametrize("corners", [[[0, 0, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 0], [2, 0, 0], [0, 0, 0]]])
def test_the_rest_of_a_face_is_cut_along_its_shorter_diagonal(corners):
    finer = refine(as_mesh(corners, [[0, 1, 2]]), 1.2)  # along the longer one, 1.41, more cuts would follow
    assert len(finer.mesh.faces) == 3
