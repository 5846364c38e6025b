"""Walks, descents and slides on meshes, against straight lines and exhaustive search."""

import numpy as np
import warp as wp

from tests.meshes import as_mesh, cylinder, flat_square, sphere, torus
from texloom.kernels.ground import Ground as GroundStruct
from texloom.kernels.ground import slide, walk
from texloom.kernels.launch import launch
from texloom.kernels.points import settle
from texloom.mesh.mesh import Mesh
from texloom.mesh.query import closest_points
from texloom.points.ground import Ground, bare_ground


@wp.kernel(enable_backward=False)
def walk_each(
    start: int,
    ground: GroundStruct,
    way: wp.array(dtype=wp.vec3d),
    length: wp.float64,
    face: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec3d),
    whole: wp.array(dtype=int),
):
    i = start + wp.tid()
    f, b, went = walk(ground, face[i], place[i], way[i], length)
    face[i] = f
    place[i] = b
    whole[i] = int(went)


@wp.kernel(enable_backward=False)
def slide_each(
    start: int,
    ground: GroundStruct,
    length: wp.array(dtype=wp.float64),
    halfedge: wp.array(dtype=int),
    share: wp.array(dtype=wp.float64),
):
    i = start + wp.tid()
    h, s = slide(ground, halfedge[i], share[i], length[i])
    halfedge[i] = h
    share[i] = s


def walked(mesh: Mesh, way: np.ndarray, length: float, face: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, ...]:
    """Where walks end, in space and on the mesh."""
    face, place, whole = face.copy(), place.copy(), np.zeros(len(face), np.int32)
    inputs = [bare_ground(mesh.vertices, mesh.faces, mesh.twins), way, length]
    launch(walk_each, len(face), inputs=inputs, outputs=[face, place, whole])
    return np.einsum("pc,pcx->px", place, mesh.vertices[mesh.faces[face]]), face, place, whole


def scattered(mesh: Mesh, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    return random.integers(0, len(mesh.faces), count).astype(np.int32), random.dirichlet([1, 1, 1], count)


def test_in_the_plane_a_walk_is_a_line() -> None:
    mesh = flat_square(9)
    face, place = scattered(mesh, 300, 0)
    angle = np.random.default_rng(1).uniform(0, 2 * np.pi, 300)
    way = np.stack([np.cos(angle), np.sin(angle), 0.5 * np.ones(300)], axis=1)  # the upright part does not count
    there, _, place_there, whole = walked(mesh, way, 0.3, face, place)
    begin = np.einsum("pc,pcx->px", place, mesh.vertices[mesh.faces[face]])
    end = begin + 0.3 * way * [1, 1, 0]
    inside = ((end > 0) & (end < 1))[:, :2].all(1)
    assert 100 < inside.sum() < 300
    np.testing.assert_array_equal(whole, inside)
    np.testing.assert_allclose(there[inside], end[inside], atol=1e-12)
    assert (place_there >= 0).all()
    assert (np.abs(there[~inside][:, :2] - 0.5).max(1) > 0.5 - 1e-9).all()  # ended at the rim


def test_around_a_prism_a_walk_is_a_helix() -> None:
    """Unrolled, a prism is a plane: angle and height grow evenly."""
    mesh = cylinder(around=12, rings=5)
    width = 2 * np.sin(np.pi / 12)
    face, place = np.array([60], np.int32), np.array([[0.4, 0.3, 0.3]])
    begin = np.einsum("pc,pcx->px", place, mesh.vertices[mesh.faces[face]])[0]
    tangent = mesh.face_normals[60] @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 0]])
    way = np.array([3 * width * tangent / np.linalg.norm(tangent) + [0, 0, 0.1]])
    there, end_face, _, whole = walked(mesh, way, float(np.linalg.norm(way)), face, place)
    assert whole[0] == 1
    assert there[0, 2] - begin[2] == np.float64(np.clip(there[0, 2] - begin[2], 0.1 - 1e-12, 0.1 + 1e-12))
    turned = np.arctan2(there[0, 1], there[0, 0]) - np.arctan2(begin[1], begin[0])
    assert abs(abs(turned) - 3 * 2 * np.pi / 12) < 1e-9  # three faces on, at the same place in its face


def test_there_and_back() -> None:
    """On a sphere: turn round where a walk ends, and it comes home."""
    mesh = sphere(2)
    face, place = scattered(mesh, 50, 2)
    begin = np.einsum("pc,pcx->px", place, mesh.vertices[mesh.faces[face]])
    way = np.random.default_rng(3).standard_normal((50, 3))
    there, face_there, place_there, _ = walked(mesh, way, 0.5, face, place)
    shorter, *_ = walked(mesh, way, 0.5 - 1e-6, face, place)
    home, *_ = walked(mesh, shorter - there, 0.5, face_there, place_there)
    near = np.linalg.norm(home - begin, axis=1)
    assert np.median(near) < 1e-4


def test_a_walk_along_edges_goes_on() -> None:
    """Where rounding tells on which side of an edge it is, it does not go back and forth over it."""
    mesh = torus()
    face, corner = (part.ravel().astype(np.int32) for part in np.indices(mesh.faces.shape))
    tails, heads = np.eye(3)[corner], np.eye(3)[(corner + 1) % 3]
    along = np.einsum("pc,pcx->px", heads - tails, mesh.vertices[mesh.faces[face]])
    for share in np.random.default_rng(0).uniform(0, 1, 3)[:, None]:
        for way in (along, -along):
            *_, whole = walked(mesh, way, 0.9, face, (1 - share) * tails + share * heads)
            assert whole.all()


def test_descending_finds_the_closest_place() -> None:
    """On a convex mesh there is but one, and every way down leads to it."""
    mesh = sphere(3)
    wanted = np.random.default_rng(4).standard_normal((200, 3))
    wanted *= 1.3 / np.linalg.norm(wanted, axis=1, keepdims=True)
    near, _ = closest_points(mesh, wanted + 0.3)
    face, place = np.empty(200, np.int32), np.empty((200, 3))
    inputs = [bare_ground(mesh.vertices, mesh.faces, mesh.twins), wanted, near]
    launch(settle, 200, inputs=inputs, outputs=[face, place])
    found = np.einsum("pc,pcx->px", place, mesh.vertices[mesh.faces[face]])
    exact_face, exact = closest_points(mesh, wanted)
    best = np.einsum("pc,pcx->px", exact, mesh.vertices[mesh.faces[exact_face]])
    np.testing.assert_allclose(found, best, atol=1e-9)


def test_descending_stays_on_its_sheet() -> None:
    """A place just under the upper of two sheets, looked for from the lower one, is found on the lower."""
    square = flat_square(4)
    count = len(square.vertices)
    sheets = as_mesh(
        np.concatenate([square.vertices, square.vertices + [0, 0, 0.1]]),
        np.concatenate([square.faces, square.faces + count]),
    )
    face, place = np.empty(1, np.int32), np.empty((1, 3))
    wanted = np.array([[0.9, 0.8, 0.09]])
    inputs = [bare_ground(sheets.vertices, sheets.faces, sheets.twins), wanted, np.zeros(1, np.int32)]
    launch(settle, 1, inputs=inputs, outputs=[face, place])
    found = np.einsum("pc,pcx->px", place, sheets.vertices[sheets.faces[face]])
    np.testing.assert_allclose(found, [[0.9, 0.8, 0.0]], atol=1e-12)


def test_sliding_goes_along_the_rim() -> None:
    """Around a square of side 1 from the middle of its first edge, forth and back."""
    ground = Ground(flat_square(4), np.ones(25))
    first = int(np.flatnonzero((ground.mesh.twins < 0) & (ground.mesh.faces.reshape(-1) == 0))[0])
    lengths = np.array([0.0, 0.1, 1.0, 4.0, -0.2, -4.0, 0.875])
    halfedge, share = np.full(7, first, np.int32), np.full(7, 0.5)
    launch(slide_each, 7, inputs=[ground.arrays, lengths], outputs=[halfedge, share])
    corners = ground.mesh.faces.reshape(-1)
    heads = ground.mesh.faces[:, [1, 2, 0]].reshape(-1)
    tail, head = ground.mesh.vertices[corners[halfedge]], ground.mesh.vertices[heads[halfedge]]
    places = tail + share[:, None] * (head - tail)
    expected = [[0.125, 0], [0.225, 0], [1, 0.125], [0.125, 0], [0, 0.075], [0.125, 0], [1, 0]]
    np.testing.assert_allclose(places[:, :2], expected, atol=1e-12)
