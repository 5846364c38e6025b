"""Triangulations that change: always a surface, Delaunay in the plane, the same parts and boundaries."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from tests.meshes import cylinder, flat_square, octahedron, sphere, torus
from texloom.mesh.mesh import Mesh
from texloom.mesh.query import closest_points
from texloom.points.crowding import crowded, upturned
from texloom.points.ground import Ground
from texloom.points.places import Places
from texloom.points.start import start
from texloom.points.tiling import Tiling, any_halfedge

MESHES = {"sphere": sphere(2), "torus": torus(24, 12), "cylinder": cylinder(16, 6), "square": flat_square(8)}


def tiling_of(mesh: Mesh, *, bend: float = 0.0, length: float = 1e9) -> Tiling:
    return start(Ground(mesh, np.ones(len(mesh.vertices))), length, bend=bend, kept=Places.empty(0))


def check(tiling: Tiling, like: Mesh) -> None:
    """Twins, rims and first halfedges say what the faces say, and the surface is what it was."""
    mesh = tiling.mesh()
    assert mesh.agrees
    np.testing.assert_array_equal(tiling.twins, mesh.twins)
    np.testing.assert_array_equal(tiling.rim, mesh.boundary_vertices)
    np.testing.assert_array_equal(tiling.faces.reshape(-1)[tiling.first], np.arange(tiling.count))
    euler = len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)
    assert euler == len(like.vertices) - len(like.edges) + len(like.faces)
    assert tiling.edge_count == len(mesh.edges)
    corners = tiling.ground.mesh.faces[tiling.places.face]
    places = np.einsum("pc,pcx->px", tiling.places.barycentric, tiling.ground.mesh.vertices[corners])
    np.testing.assert_allclose(places, mesh.vertices, atol=1e-9)


@pytest.fixture(params=list(MESHES))
def mesh(request: pytest.FixtureRequest) -> Mesh:
    return MESHES[request.param]


def test_it_starts_as_the_mesh(mesh: Mesh) -> None:
    tiling = tiling_of(mesh)
    check(tiling, mesh)
    np.testing.assert_array_equal(tiling.faces, mesh.faces)


@pytest.mark.parametrize("shortest_first", [True, False])
def test_points_can_be_taken_out(mesh: Mesh, shortest_first: bool) -> None:
    tiling = tiling_of(mesh)
    before = tiling.count
    gone = tiling.thin_out(np.inf, most=before // 2, seed=1, shortest_first=shortest_first, careful=False)
    assert 0 < gone <= before // 2 and tiling.count == before - gone
    check(tiling, mesh)


def test_the_last_points_stay() -> None:
    """Of a torus seven, of a sphere four at the least; none of these may go."""
    for mesh, least in ((MESHES["torus"], 7), (octahedron(), 4)):
        tiling = tiling_of(mesh)
        while tiling.thin_out(np.inf, most=1000, seed=0, shortest_first=True, careful=False):
            pass
        assert least <= tiling.count < least + 6
        check(tiling, mesh)


def test_points_can_be_put_in(mesh: Mesh) -> None:
    tiling = tiling_of(mesh)
    before = tiling.count
    assert tiling.fill_in(20) == 20
    assert tiling.count == before + 20
    check(tiling, mesh)


def test_every_face_in_four(mesh: Mesh) -> None:
    tiling = tiling_of(mesh)
    points, edges, faces = tiling.count, tiling.edge_count, len(tiling.faces)
    tiling.quarter()
    assert (tiling.count, len(tiling.faces)) == (points + edges, 4 * faces)
    check(tiling, mesh)


def test_steps_change_no_topology(mesh: Mesh) -> None:
    tiling = tiling_of(mesh, bend=0.05)
    tiling.quarter()
    tiling.spread(tiling.ground.spacing(tiling.count), 10)
    check(tiling, mesh)


def test_frozen_points_stay(mesh: Mesh) -> None:
    tiling = tiling_of(mesh)
    kept = tiling.places.at.copy()
    tiling = tiling.copy(bend=0.0, frozen=tiling.count)
    tiling.quarter()
    tiling.thin_out(np.inf, most=10_000, seed=0, shortest_first=False, careful=False)
    tiling.spread(tiling.ground.spacing(tiling.count), 3)
    np.testing.assert_array_equal(tiling.places.at[: len(kept)], kept)


def test_in_the_plane_flips_make_it_delaunay() -> None:
    """The same triangles as Qhull's, of points scattered by repulsion."""
    tiling = tiling_of(flat_square(12))
    tiling.thin_out(np.inf, most=60, seed=4, shortest_first=False)
    tiling.spread(tiling.ground.spacing(tiling.count), 3)
    inside = {tuple(sorted(face)) for face in tiling.faces.tolist() if not tiling.rim[face].any()}
    theirs = {tuple(sorted(face)) for face in Delaunay(tiling.places.at[:, :2]).simplices.tolist()}
    assert len(inside) > 60 and inside <= theirs


def test_points_that_stay_come_first() -> None:
    """Put into a finer mesh of the same surface, they keep their places."""
    for mesh in MESHES.values():
        coarse = tiling_of(mesh)
        coarse.thin_out(np.inf, most=coarse.count // 2, seed=2, shortest_first=False, careful=False)
        coarse.spread(coarse.ground.spacing(coarse.count), 5)
        spacing = coarse.ground.spacing(4 * coarse.count)
        fine = start(coarse.ground, 0.6 * spacing, bend=0.0, kept=coarse.places)
        assert fine.frozen == coarse.count < fine.count
        np.testing.assert_array_equal(fine.places.at[: coarse.count], coarse.places.at)
        np.testing.assert_array_equal(fine.rim[: coarse.count], coarse.rim)
        check(fine, mesh)


def test_a_crowd_is_found_through_no_sheet() -> None:
    """Two sheets a hundredth apart are no crowd; two points of one are, whatever edges there are."""
    square = flat_square(8)
    sheets = Mesh(
        np.concatenate([square.vertices, square.vertices + [0, 0, 0.01]]),
        np.concatenate([square.faces, square.faces + len(square.vertices)]),
    )
    tiling = tiling_of(sheets)
    assert len(crowded(tiling, 0.1)) == 0
    assert len(crowded(tiling, 0.13)) > 0


def fin(depth: float = 1.0, thickness: float = 0.02) -> Mesh:
    """A strip folded at y = 0: up the one side, normal up, over the narrow border, and back below."""
    across = [(-depth, thickness), (-depth / 2, thickness), (0, thickness), (0, 0), (-depth / 2, 0), (-depth, 0)]
    lattice = flat_square(5)
    column, row = (np.round(5 * lattice.vertices[:, axis]).astype(int) for axis in (0, 1))
    folded = np.array(across)[row]
    return Mesh(np.stack([0.4 * column - 1, folded[:, 0], folded[:, 1]], axis=1), lattice.faces)


def test_the_middle_of_an_edge_over_a_border_is_half_way_over_it() -> None:
    """The one end is 0.2 from the border above, the other 0.5 below: the middle is 0.15 below, a little aside."""
    mesh = fin()
    ground = Ground(mesh, np.ones(len(mesh.vertices)))
    wanted = np.array([[-0.05, -0.2, 0.02], [0.05, -0.5, 0.0], [-0.6, -0.3, 0.02], [0.6, -0.3, 0.02]])
    up = mesh.face_normals[:, 2]
    face, barycentric = np.empty(4, np.int32), np.empty((4, 3))
    for point, place in enumerate(wanted):
        sheet = np.flatnonzero(up > 0.9 if place[2] > 0 else up < -0.9)
        part = Mesh(mesh.vertices, mesh.faces[sheet])
        found, barycentric[point : point + 1] = closest_points(part, place[None])
        face[point] = sheet[found[0]]
    at = ground.positions(face, barycentric) - ground.origin
    normal = ground.mesh.face_normals[face]
    places = Places(at, np.ones(4), normal, face, barycentric, np.full(4, -1, np.int32))
    faces = np.array([[0, 1, 2], [1, 0, 3]], np.int32)
    twins = Mesh(at, faces).twins
    tiling = Tiling(ground, places, faces, twins.copy(), any_halfedge(faces, 4), np.ones(4, np.int32), 0.5)
    middle = tiling.middles(np.flatnonzero(twins >= 0)[:1].astype(np.int32))
    position = middle.at[0] + ground.origin
    assert middle.normal[0, 2] < -0.9
    np.testing.assert_allclose(position, [0, -0.15, 0], atol=0.08)


def test_what_lies_upside_down_is_found() -> None:
    tiling = tiling_of(flat_square(4))
    assert len(upturned(tiling)) == 0
    inner = int(np.flatnonzero(tiling.rim == 0)[0])
    tiling.places.at[inner] += [0.4, 0, 0]  # past its neighbour
    over = tiling.mesh().face_normals[:, 2] < 0
    np.testing.assert_array_equal(upturned(tiling), np.unique(tiling.faces[over]))
    assert inner in upturned(tiling)
    tiling.frozen = tiling.count
    assert len(upturned(tiling)) == 0
