"""Nested even points: on the surface, kept, apart from each other, and joined as the surface is."""

from collections.abc import Callable

import igl
import numpy as np
import pytest
from scipy.spatial import KDTree

from tests.data import DATA, needs_data
from tests.meshes import as_mesh, cone, cylinder, flat_square, slivers, sphere, torus
from texloom.errors import MeshError, ParameterError
from texloom.kernels import launch
from texloom.mesh.mesh import Mesh
from texloom.points import Hierarchy, Level, hierarchy

COUNTS = (150, 600, 2400)


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as the parts of one."""
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=False)]
    return as_mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def box(thickness: float) -> Mesh:
    """A closed box of 1 × 1 × ``thickness``."""
    lattice = flat_square(10)
    top = lattice.vertices + [0, 0, thickness]
    count = len(lattice.vertices)
    outer = np.flatnonzero(lattice.twins < 0)
    tails = lattice.faces.reshape(-1)[outer]
    heads = lattice.faces[:, [1, 2, 0]].reshape(-1)[outer]
    sides = [[tails, heads + count, tails + count], [tails, heads, heads + count]]
    walls = np.concatenate([np.stack(side, axis=1) for side in sides])
    faces = np.concatenate([lattice.faces[:, ::-1], lattice.faces + count, walls])
    return as_mesh(np.concatenate([lattice.vertices, top]), faces)


def two_boxes() -> Mesh:
    """Cubes that share an upright edge, where four faces meet."""
    one = box(1.0)
    both = joined(one, as_mesh(one.vertices + [1, 1, 0], one.faces))
    vertices, number = np.unique(both.vertices.round(9), axis=0, return_inverse=True)
    return as_mesh(vertices, number.reshape(-1)[both.faces])


def upside_down(level: Level) -> int:
    """Faces that oppose the mean of their corners' normals."""
    normals = level.normal[level.mesh.faces].mean(1)
    return int((np.einsum("fx,fx->f", level.mesh.face_normals, normals) < 0).sum())


def euler(mesh: Mesh) -> int:
    return len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)


def boundary_loops(mesh: Mesh) -> int:
    """Boundaries, counted by walking along them."""
    outer = np.flatnonzero(mesh.twins < 0)
    heads = mesh.faces[:, [1, 2, 0]].reshape(-1)
    following = dict(zip(mesh.faces.reshape(-1)[outer], heads[outer], strict=True))
    loops = 0
    while following:
        loops += 1
        vertex = next(iter(following))
        while vertex in following:
            vertex = following.pop(vertex)
    return loops


SURFACES: dict[str, Callable[[], Mesh]] = {
    "sphere": lambda: sphere(3),
    "torus": torus,
    "square": flat_square,
    "cylinder": cylinder,
    "cone": cone,
    "two triangles": lambda: flat_square(1),
    "parts": lambda: joined(torus(), as_mesh(sphere(2).vertices * 0.3, sphere(2).faces)),
}


@pytest.fixture(scope="module", params=list(SURFACES))
def made(request: pytest.FixtureRequest) -> Hierarchy:
    return hierarchy(SURFACES[request.param](), COUNTS, seed=3)


def test_points_are_as_many_as_asked_for_and_lie_on_the_surface(made: Hierarchy) -> None:
    for level, count in zip(made.levels, COUNTS, strict=True):
        assert level.count == len(level.mesh.vertices) == count
        assert (level.barycentric >= 0).all()
        np.testing.assert_allclose(level.barycentric.sum(1), 1)
        corners = made.surface.vertices[made.surface.faces[level.face]]
        np.testing.assert_allclose(np.einsum("pc,pcx->px", level.barycentric, corners), level.position, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(level.normal, axis=1), 1)


def test_coarse_points_stay(made: Hierarchy) -> None:
    for coarse, fine in zip(made.levels, made.levels[1:], strict=False):
        np.testing.assert_array_equal(fine.position[: coarse.count], coarse.position)
        np.testing.assert_array_equal(fine.face[: coarse.count], coarse.face)


def test_points_are_even(made: Hierarchy) -> None:
    """A boundary makes small levels less even: its points double, the others more than quadruple, so rows must end."""
    open_levels = (made.surface.twins < 0).any()
    for number, level in enumerate(made.levels):
        assert level.variation <= (0.14 if open_levels and number else 0.1)
        assert level.closest >= 0.5
        assert 0.75 * level.spacing < level.nearest.mean() < 1.05 * level.spacing


def test_nearest_is_nearest_of_all(made: Hierarchy) -> None:
    """Among neighbours in the triangulation is the nearest point there is, nearly always."""
    finest = made.levels[-1]
    apart = KDTree(finest.position).query(finest.position, 2)[0][:, 1]
    assert (finest.nearest >= apart - 1e-12).all()
    assert np.isclose(finest.nearest, apart).mean() > 0.99


def test_the_triangulation_is_the_surface(made: Hierarchy) -> None:
    surface = made.surface
    for level in made.levels:
        mesh = level.mesh
        assert mesh.agrees and (mesh.first_halfedges >= 0).all()
        assert euler(mesh) == euler(surface)
        assert boundary_loops(mesh) == boundary_loops(surface)
        assert mesh.vertex_parts.max() == surface.vertex_parts.max()
        seen = np.einsum("fx,fx->f", mesh.face_normals, level.normal[mesh.faces].mean(1))
        assert (seen > 0).mean() > 0.99
    assert made.levels[-1].mesh.face_areas.sum() == pytest.approx(surface.face_areas.sum(), rel=0.05)


def test_points_of_a_boundary_lie_on_it(made: Hierarchy) -> None:
    outer = np.flatnonzero(made.surface.twins < 0)
    for level in made.levels:
        face, corner = np.divmod(outer, 3)
        on_rim = np.zeros(level.count, bool)
        for f, c in zip(face, corner, strict=True):
            on_rim |= (level.face == f) & (level.barycentric[:, (c + 2) % 3] == 0)
        assert on_rim[level.mesh.boundary_vertices].all()


def test_places_on_the_coarser_level_are_the_nearest(made: Hierarchy) -> None:
    """Found by coming ever nearer, so a fold of the coarse mesh may stop it a little early."""
    for coarse, fine in zip(made.levels, made.levels[1:], strict=False):
        assert fine.on_coarser is not None
        face, barycentric = fine.on_coarser
        places = np.einsum("pc,pcx->px", barycentric, coarse.position[coarse.mesh.faces[face]])
        np.testing.assert_array_equal(places[: coarse.count], coarse.position)
        faces = coarse.mesh.faces.astype(np.int64)
        nearest = np.sqrt(igl.point_mesh_squared_distance(fine.position, coarse.position, faces)[0])
        away = np.linalg.norm(places - fine.position, axis=1)
        assert (away <= nearest + 0.05 * coarse.spacing).all()
    assert made.levels[0].on_coarser is None


def test_parts_have_points_by_their_area() -> None:
    mesh = joined(sphere(3), as_mesh(sphere(3).vertices * 0.5 + [3, 0, 0], sphere(3).faces))
    level = hierarchy(mesh, (1000,)).levels[0]
    small = (level.position[:, 0] > 2).sum()
    assert 180 < small < 220  # a fifth of the area
    tiny = joined(sphere(3), as_mesh(sphere(2).vertices * 0.01 + [3, 0, 0], sphere(2).faces))
    assert (hierarchy(tiny, (300,)).levels[0].position[:, 0] > 2).sum() >= 4


@pytest.mark.parametrize(("thickness", "inward"), [(0.05, 1.3), (0.005, 2.7)])
def test_the_sides_of_a_sheet_do_not_mix(thickness: float, inward: float) -> None:
    """A box half, or a twentieth, as thick as the coarse spacing: edges from side to side are at its border only."""
    made = hierarchy(box(thickness), (300, 1200))
    for level in made.levels:
        tails, heads = level.mesh.edges.T
        through = np.einsum("ex,ex->e", level.normal[tails], level.normal[heads]) < -0.9
        middle = level.position[level.mesh.edges[through]].mean(1)
        assert through.any() and (0.5 - np.abs(middle[:, :2] - 0.5).max(1)).max() < inward * level.spacing
        for side in (level.normal[:, 2] > 0.9, level.normal[:, 2] < -0.9):
            assert side.sum() > 0.4 * level.count


def test_an_edge_of_four_faces_is_parted() -> None:
    """Vertices with several fans once left faces behind whose corners were other points, far away."""
    mesh = two_boxes()
    assert not mesh.agrees
    made = hierarchy(mesh, COUNTS, scale=np.ones(len(mesh.vertices)))
    for level in made.levels:
        assert level.mesh.agrees and (level.mesh.twins >= 0).all() and upside_down(level) == 0
        assert level.mesh.edge_lengths.max() < 2 * level.spacing
        corners = mesh.vertices[mesh.faces[level.face]]
        np.testing.assert_allclose(np.einsum("pc,pcx->px", level.barycentric, corners), level.position, atol=1e-12)


def test_spacing_follows_the_scale() -> None:
    mesh = flat_square(20)
    scale = 1.0 + 2.0 * mesh.vertices[:, 0]
    level = hierarchy(mesh, (3000,), scale=scale).levels[0]
    np.testing.assert_allclose(level.scale, 1 + 2 * level.position[:, 0], atol=1e-9)
    left, right = (level.position[:, 0] < 0.2), (level.position[:, 0] > 0.8)
    world = level.nearest * level.scale
    assert world[right].mean() / world[left].mean() == pytest.approx(2.8 / 1.2, rel=0.08)
    assert level.variation < 0.1


def test_a_mesh_far_away_and_small_is_as_even() -> None:
    near = hierarchy(sphere(3), (500,)).levels[0]
    mesh = sphere(3)
    far = hierarchy(Mesh(mesh.vertices * 1e-3 + [100, 0, 0], mesh.faces), (500,)).levels[0]
    assert far.variation < 0.1 and far.spacing == pytest.approx(1e-3 * near.spacing, rel=1e-6)


def test_slivers_are_no_obstacle() -> None:
    level = hierarchy(slivers(6, thinness=0.05), (400,)).levels[0]
    assert level.variation < 0.12 and level.mesh.agrees


def test_same_seed_same_points_for_any_threads() -> None:
    before = launch.thread_count()
    try:
        made = []
        for threads in (1, 3):
            launch.use(threads=threads)
            made.append(hierarchy(torus(), (300, 1200), seed=5).levels[-1])
    finally:
        launch.use(threads=before)
    np.testing.assert_array_equal(made[0].position, made[1].position)
    np.testing.assert_array_equal(made[0].mesh.faces, made[1].mesh.faces)
    assert not np.array_equal(hierarchy(torus(), (300,), seed=6).levels[0].position, made[0].position[:300])


def test_any_rising_counts() -> None:
    made = hierarchy(sphere(3), (100, 130, 1000), report=lambda stage, done: None)
    assert [level.count for level in made.levels] == [100, 130, 1000]
    assert all(level.mesh.agrees and euler(level.mesh) == 2 for level in made.levels)


@pytest.mark.parametrize(
    ("counts", "words"),
    [((), "no level"), ((3,), "level of 3"), ((100, 100), "rising"), ((200, 100), "rising"), ((10**9,), "from 4 to")],
)
def test_wrong_counts_are_refused(counts: tuple[int, ...], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        hierarchy(torus(), counts)


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(ParameterError, match="too few for the parts"):
        hierarchy(torus(), (4,))  # a torus has at least seven
    with pytest.raises(ParameterError, match="512 positive numbers"):
        hierarchy(torus(), (100,), scale=np.zeros(512))
    with pytest.raises(ParameterError, match="512 positive numbers"):
        hierarchy(torus(), (100,), scale=np.ones(3))
    with pytest.raises(MeshError, match="no area"):
        hierarchy(as_mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]), (10,))


@needs_data
@pytest.mark.parametrize("name", ["spot-3k", "fandisk-6k", "lilium-open-3k", "two-knots-6k"])
def test_real_meshes_are_even(name: str) -> None:
    from texloom.io.mesh import read_mesh

    mesh = read_mesh(DATA / "meshes" / f"{name}.obj").mesh
    for level in hierarchy(mesh, (1000, 4000)).levels:
        assert level.variation <= 0.1 and level.closest >= 0.5
        assert euler(level.mesh) == euler(mesh)


@needs_data
@pytest.mark.parametrize("name", ["camel-head-open-11k", "teapot-4parts-4k"])
def test_thin_lips_leave_nothing_upside_down(name: str) -> None:
    """They are thinner than the points are apart, and rows of needles run along them."""
    from texloom.io.mesh import read_mesh

    for level in hierarchy(read_mesh(DATA / "meshes" / f"{name}.obj").mesh, (4000, 16_000)).levels:
        assert upside_down(level) == 0
        assert level.variation <= 0.08 and level.closest >= 0.5
