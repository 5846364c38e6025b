import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.meshes import all_meshes, closed_meshes, flat_square, joined, octahedron, shifted, sphere, tetrahedron, torus
from texloom.errors import MeshError
from texloom.mesh.mend import mend
from texloom.mesh.mesh import Mesh, edge_runs
from texloom.mesh.weld import weld

each_mesh = pytest.mark.parametrize("mesh", all_meshes().values(), ids=all_meshes().keys())


def assert_manifold(mesh: Mesh) -> None:
    """Every edge is a boundary or two opposite halfedges, every vertex one fan."""
    _, _, counts = edge_runs(mesh.faces)
    assert counts.max() <= 2
    assert (mesh.twins >= 0).sum() == 2 * (counts == 2).sum()
    np.testing.assert_array_equal(np.unique(mesh.faces), np.arange(len(mesh.vertices)))
    for vertex in range(len(mesh.vertices)):
        corners = set(np.flatnonzero(mesh.faces.reshape(-1) == vertex).tolist())
        assert fan_of(mesh, min(corners)) == corners


def fan_of(mesh: Mesh, corner: int) -> set[int]:
    """Corners reached from one by turning around its vertex."""
    fan, pending = {corner}, [corner]
    while pending:
        at = pending.pop()
        before = at - at % 3 + (at + 2) % 3
        forth, back = mesh.twins[before], mesh.twins[at]
        around = [] if forth < 0 else [int(forth)]
        around += [] if back < 0 else [int(back - back % 3 + (back + 1) % 3)]
        pending += [new for new in around if new not in fan]
        fan.update(around)
    return fan


def soup(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Every face with its own vertices."""
    return mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(mesh.faces.size).reshape(-1, 3)


def volume(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


@each_mesh
def test_a_good_mesh_is_left_alone(mesh):
    mended = mend(mesh.vertices, mesh.faces)
    assert mended.mends == ()
    np.testing.assert_array_equal(mended.mesh.vertices, mesh.vertices)
    np.testing.assert_array_equal(mended.mesh.faces, mesh.faces)
    np.testing.assert_array_equal(mended.corner_origin, mesh.faces)
    np.testing.assert_array_equal(mended.face_origin, np.arange(len(mesh.faces)))


@each_mesh
def test_a_soup_is_welded(mesh):
    vertices, faces = soup(mesh)
    mended = mend(vertices, faces)
    assert mended.mends in ((f"welded {len(vertices) - len(mesh.vertices)} duplicate vertices",), ())
    assert len(mended.mesh.vertices) == len(mesh.vertices)
    np.testing.assert_array_equal(mended.mesh.twins, mesh.twins)
    np.testing.assert_array_equal(mended.corner_origin, faces)


def test_vertices_that_rounding_pulled_apart_are_welded():
    vertices, faces = soup(sphere(2))
    moved = vertices + np.random.default_rng(0).uniform(-1e-10, 1e-10, vertices.shape)
    mended = mend(moved, faces)
    assert len(mended.mesh.vertices) == 66
    assert (mended.mesh.twins >= 0).all()


def test_an_outlier_does_not_weld_the_rest():
    mesh = joined(sphere(2), shifted(octahedron(), (1e12, 0, 0)))
    assert len(mend(mesh.vertices, mesh.faces).mesh.vertices) >= 66


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(sorted(closed_meshes())))
def test_faces_turned_over_at_random_are_turned_back(seed, name):
    mesh = closed_meshes()[name]
    turned = np.random.default_rng(seed).random(len(mesh.faces)) < 0.4
    faces = mesh.faces.copy()
    faces[turned] = faces[turned][:, ::-1]
    mended = mend(mesh.vertices, faces)
    assert (mended.mesh.twins >= 0).all()
    if 0 < turned.sum() < len(turned):
        assert volume(mended.mesh) > 0
        assert mended.mends == (f"turned over {turned.sum()} face{'s' if turned.sum() > 1 else ''}",)


def test_a_closed_part_that_agrees_with_itself_keeps_its_side():
    mesh = sphere(1)
    inside_out = mend(mesh.vertices, mesh.faces[:, ::-1])
    assert inside_out.mends == ()
    assert volume(inside_out.mesh) < 0


def test_an_open_part_keeps_the_side_most_faces_show():
    mesh = flat_square(4)
    faces = mesh.faces.copy()
    faces[:5] = faces[:5][:, ::-1]
    np.testing.assert_allclose(mend(mesh.vertices, faces).mesh.face_normals[:, 2], 1)


def test_corners_follow_their_face_when_it_is_turned():
    mesh = flat_square(2)
    faces = mesh.faces.copy()
    faces[0] = faces[0][::-1]
    mended = mend(mesh.vertices, faces)
    np.testing.assert_array_equal(faces.reshape(-1)[mended.corner_given], mended.corner_origin)
    np.testing.assert_array_equal(mesh.vertices[mended.corner_origin], mended.mesh.vertices[mended.mesh.faces])


def test_folded_duplicate_and_unused_are_dropped():
    mesh = flat_square(3)
    vertices = np.concatenate([mesh.vertices, [[5, 5, 5]]])
    faces = np.concatenate([[[0, 0, 1]], mesh.faces, mesh.faces[3:5][:, [1, 2, 0]]])
    mended = mend(vertices, faces)
    assert mended.mends == (
        "dropped 1 unreferenced vertex",
        "dropped 1 degenerate face",
        "dropped 2 duplicate faces",
    )
    np.testing.assert_array_equal(mended.face_origin, 1 + np.arange(len(mesh.faces)))


def test_two_faces_back_to_back_are_one():
    mesh = octahedron()
    vertices = np.concatenate([mesh.vertices, mesh.vertices[:3] + 5])
    mended = mend(vertices, np.concatenate([mesh.faces, [[6, 7, 8], [7, 6, 8]]]))
    assert mended.mends == ("dropped 1 duplicate face",)
    np.testing.assert_array_equal(mended.face_origin, np.arange(9))


def test_a_vertex_falls_to_an_exact_copy_that_no_face_uses():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [1, 0, 0]], np.float64)
    np.testing.assert_array_equal(weld(vertices, np.array([[3, 1, 2]], np.int32)), [0, 1, 2, 0, 1])


def test_a_face_without_area_is_taken_out_without_opening_the_surface():
    mesh = tetrahedron()  # put a vertex on edge 0-1, known to one side only
    middle = mesh.vertices[[0, 1]].mean(axis=0)
    faces = [[0, 4, 2], [4, 1, 2], [0, 1, 4], [0, 2, 3], [0, 3, 1], [1, 3, 2]]
    mended = mend(np.concatenate([mesh.vertices, [middle]]), np.array(faces))
    assert mended.mends == ("removed 1 face without area",)
    assert (mended.mesh.twins >= 0).all()
    assert mended.mesh.face_areas.min() > 0.1
    assert mended.mesh.face_areas.sum() == pytest.approx(mesh.face_areas.sum())
    np.testing.assert_array_equal(
        np.concatenate([mesh.vertices, [middle]])[mended.corner_origin], mended.mesh.vertices[mended.mesh.faces]
    )


def test_a_fin_is_parted_from_the_flat_pair():
    vertices = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [-1, 0, 0], [0, 0, 1]], float)
    mended = mend(vertices, np.array([[0, 1, 4], [0, 2, 1], [0, 1, 3]]))  # the fin comes first
    assert mended.mends == ("split 1 non-manifold edge",)
    np.testing.assert_array_equal(mended.mesh.twins >= 0, [0, 0, 0, 0, 0, 1, 1, 0, 0])
    assert_manifold(mended.mesh)


def test_two_spheres_that_touch_are_parted():
    mesh = joined(sphere(1), shifted(sphere(1), (2, 0, 0)))
    mended = mend(mesh.vertices, mesh.faces)
    assert mended.mends == ("welded 1 duplicate vertex", "split 1 non-manifold vertex")
    assert len(mended.mesh.vertices) == len(mesh.vertices)
    assert_manifold(mended.mesh)


def test_a_one_sided_band_is_cut_open():
    count = 20
    angle = 2 * np.pi * np.arange(count) / count
    across = np.array([-0.3, 0.3])[None, :]
    radius = 1 + across * np.cos(angle / 2)[:, None]
    z = across * np.sin(angle / 2)[:, None]
    points = np.stack([radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None], z], axis=-1).reshape(-1, 3)
    corners = [(2 * i, 2 * i + 1, 2 * (i + 1), 2 * (i + 1) + 1) for i in range(count - 1)]
    corners.append((2 * count - 2, 2 * count - 1, 1, 0))
    faces = np.array([face for a, b, c, d in corners for face in ((a, c, b), (b, c, d))])
    mended = mend(points, faces)
    assert mended.mends[-1] == "cut one-sided (non-orientable) parts open along 1 edge"
    assert len(mended.mesh.vertices) == 2 * count + 2
    assert_manifold(mended.mesh)


def test_nested_crowding_ends_manifold():
    """Three tori that share a pole vertex, a fin through one of them, and a doubled cube edge."""
    mesh = joined(torus(8, 6), sphere(1), shifted(octahedron(), (0, 0, 2)))
    extra = [[0, 1, 50], [1, 0, 51], [0, 7, 52], [7, 0, 53], [50, 51, 60]]
    mended = mend(mesh.vertices, np.concatenate([mesh.faces, extra]))
    assert_manifold(mended.mesh)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(4, 9), st.integers(1, 24))
def test_any_faces_at_all_end_manifold_or_refused(seed, vertex_count, face_count):
    random = np.random.default_rng(seed)
    vertices = random.integers(0, 3, (vertex_count, 3)).astype(float)
    faces = random.integers(0, vertex_count, (face_count, 3))
    try:
        mended = mend(vertices, faces)
    except MeshError:
        return
    assert_manifold(mended.mesh)
    np.testing.assert_array_equal(vertices[mended.corner_origin], mended.mesh.vertices[mended.mesh.faces])
    np.testing.assert_array_equal(faces.reshape(-1)[mended.corner_given], mended.corner_origin)


@pytest.mark.parametrize(
    ("vertices", "faces", "said"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), int), "the mesh is empty"),
        (np.zeros((4, 3)), np.zeros((0, 3), int), "4 vertices but no faces"),
        (np.eye(3), [[0, 1, 7]], r"face 0 .* names vertex 7 .* has 3 vertices"),
        (np.eye(3), [[0, -1, 2]], "names vertex -1"),
        (np.diag([1, np.nan, 1]), [[0, 1, 2]], r"vertex 1 .* is at \(0, nan, 0\); 1 position"),
        (np.zeros((3, 3)), [[0, 1, 2]], "all 1 faces are degenerate"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]], "all 1 faces are degenerate"),
    ],
)
def test_what_cannot_be_mended_is_refused(vertices, faces, said):
    with pytest.raises(MeshError, match=said):
        mend(np.asarray(vertices, float), np.asarray(faces))
