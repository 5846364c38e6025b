"""Groups of faces as one patch: discs that cover everything, laid flat without flips, tears or undue stretch."""

import numpy as np
import pytest
from numpy import ndarray

from tests.data import DATA, needs_data
from tests.domain.test_surface import cube
from tests.meshes import all_meshes, as_mesh, cone, cylinder, flat_square, sphere, torus
from texloom.domain.faces import lay_flat
from texloom.domain.groups import Groups, group
from texloom.errors import ParameterError
from texloom.field.direction import from_constant, from_vectors
from texloom.field.smooth import smoothest
from texloom.io.mesh import read_mesh
from texloom.kernels.launch import thread_count, use
from texloom.mesh.mesh import Mesh

WIDTH = 16.0


def laid(mesh: Mesh, order: int, faces_a_group: float = 12.0) -> ndarray:
    """Every face flat along the smoothest field; a squared width is the area of so many faces of the mean."""
    texel = float(np.sqrt(mesh.face_areas.mean() * faces_a_group)) / WIDTH
    return lay_flat(mesh, smoothest(mesh, order), texel=texel)


def linear_maps(flat: ndarray, layout: ndarray) -> tuple[ndarray, ndarray]:
    """α and β of w = α z + β conj(z) + γ from each flat face to its place in the layout."""
    system = np.empty((len(flat), 2, 2), complex)
    system[:, :, 0] = flat[:, 1:] - flat[:, :1]
    system[:, :, 1] = np.conj(system[:, :, 0])
    solved = np.linalg.solve(system, (layout[:, 1:] - layout[:, :1])[..., None])[..., 0]
    return solved[:, 0], solved[:, 1]


def areas(flat: ndarray) -> ndarray:
    """Signed areas of triangles in the complex plane."""
    return np.imag(np.conj(flat[:, 1] - flat[:, 0]) * (flat[:, 2] - flat[:, 0])) / 2


def check_laws(mesh: Mesh, flat: ndarray, order: int, groups: Groups) -> None:
    """What holds for any mesh and field."""
    patch, layout = groups.patch, groups.layout
    count = int(patch.max()) + 1
    lowest = np.unique(patch, return_index=True)[1]
    assert len(lowest) == count and np.all(np.diff(lowest) > 0)  # all numbers used, by the lowest face

    for own in range(count):
        faces = np.flatnonzero(patch == own)
        assert is_disc(mesh, faces)
        vertex, first, index = np.unique(mesh.faces[faces], return_index=True, return_inverse=True)
        place = layout[faces].ravel()[first]
        np.testing.assert_array_equal(place[index.ravel()], layout[faces].ravel())  # one place a vertex
        if len(faces) == 1:
            np.testing.assert_array_equal(layout[faces], flat[faces])

    assert np.all(np.sign(areas(layout)) == np.sign(areas(flat)))
    alpha, beta = linear_maps(flat, layout)
    assert np.max(np.abs(alpha) + np.abs(beta)) < 1.5 + 1e-9
    assert np.min(np.abs(alpha) - np.abs(beta)) > 1 / 1.5 - 1e-9
    off = np.abs(np.angle(alpha**order)) / order
    assert np.degrees(np.max(off)) < 45


def is_disc(mesh: Mesh, faces: ndarray) -> bool:
    """Connected over edges, without holes, handles or pinches: V - E + F = 1 with all faces in one piece."""
    halfedges = (3 * faces[:, None] + np.arange(3)).ravel()
    inside = mesh.twins[halfedges]
    inside = np.isin(inside, halfedges) & (inside >= 0)
    edges = len(halfedges) - np.count_nonzero(inside) // 2
    reached, front = {int(faces[0])}, [int(faces[0])]
    members = set(faces.tolist())
    while front:
        for twin in mesh.twins[3 * front.pop() :][:3]:
            if twin >= 0 and twin // 3 in members - reached:
                reached.add(int(twin // 3))
                front.append(int(twin // 3))
    return len(reached) == len(faces) and len(np.unique(mesh.faces[faces])) - edges + len(faces) == 1


def wraps_around(mesh: Mesh, groups: Groups, vertex: int) -> bool:
    """Whether all faces around a vertex are in one group."""
    return len(np.unique(groups.patch[(mesh.faces == vertex).any(axis=1)])) == 1


@pytest.mark.parametrize("order", [1, 2, 4, 6])
@pytest.mark.parametrize("name", all_meshes())
def test_laws_on_analytic_meshes(name: str, order: int) -> None:
    mesh = all_meshes()[name]
    for faces_a_group in (3.0, 12.0):
        flat = laid(mesh, order, faces_a_group)
        check_laws(mesh, flat, order, group(mesh, flat, order=order, width=WIDTH))


@needs_data
@pytest.mark.parametrize("name", ["bunny-watertight-3k.obj", "wingnut-3k.obj", "fandisk-6k.obj", "block-slivers.obj"])
def test_laws_on_real_meshes(name: str) -> None:
    mesh = read_mesh(DATA / "meshes" / name).mesh
    flat = laid(mesh, 4)
    groups = group(mesh, flat, order=4, width=WIDTH)
    check_laws(mesh, flat, 4, groups)
    if name != "block-slivers.obj":
        area = np.bincount(groups.patch, weights=np.abs(areas(flat)))
        assert area[area < 0.15 * WIDTH**2].sum() < 0.02 * area.sum()


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_a_plane_stays_as_it_is(order: int) -> None:
    n = 20
    mesh = flat_square(n)
    flat = lay_flat(mesh, from_constant(mesh, order, np.array([1.0, 0.3, 0])), texel=1 / 80)
    branch = np.random.default_rng(0).integers(order, size=len(flat))
    flat *= np.exp(2j * np.pi * branch / order)[:, None]  # which direction a face follows is a matter of chance
    groups = group(mesh, flat, order=order, width=WIDTH)
    assert 20 < groups.patch.max() + 1 < 35  # 25 squared widths
    turned = np.exp(1j * np.arctan2(0.3, 1.0))
    plane = 80 * (mesh.vertices[:, 0] - 1j * mesh.vertices[:, 1])[mesh.faces] * turned
    for own in range(groups.patch.max() + 1):
        member = groups.patch == own
        edges, mine = (z[member].ravel()[1:] - z[member].ravel()[0] for z in (plane, groups.layout))
        turn = np.vdot(edges, mine) / np.vdot(edges, edges)
        np.testing.assert_allclose(mine, turn * edges, atol=1e-9)
        np.testing.assert_allclose(turn**order, 1, atol=1e-9)


def test_groups_are_as_wide_as_asked() -> None:
    mesh = sphere(5)
    flat = laid(mesh, 4, 20)
    share = np.bincount(group(mesh, flat, order=4, width=WIDTH).patch, weights=np.abs(areas(flat))) / WIDTH**2
    assert 0.8 < np.median(share) < 1.25
    assert share.max() < 2.5
    assert share[share < 0.15].sum() < 0.01 * share.sum()


def test_the_layout_is_the_least_squares_one() -> None:
    mesh = torus(48, 24)
    flat = laid(mesh, 4)
    groups = group(mesh, flat, order=4, width=WIDTH)
    alpha, _ = linear_maps(flat, groups.layout)
    own_turn = 1j ** np.round(np.angle(alpha) / (np.pi / 2))
    apex = np.roll(flat, -2, axis=1)
    across = np.conj(flat - apex) * (np.roll(flat, -1, axis=1) - apex)
    weight = np.clip(across.real / np.abs(across.imag), 0.1, 10)
    edge = np.roll(flat, -1, axis=1) - flat
    for own in range(groups.patch.max() + 1):
        member = np.flatnonzero(groups.patch == own)
        vertex, node = np.unique(mesh.faces[member], return_inverse=True)
        node = node.reshape(-1, 3)
        root = np.sqrt(weight[member].ravel())
        rows = np.zeros((3 * len(member), len(vertex)))
        rows[np.arange(len(rows)), np.roll(node, -1, axis=1).ravel()] = root
        rows[np.arange(len(rows)), node.ravel()] = -root
        target = root * (own_turn[member, None] * edge[member]).ravel()
        expected = np.linalg.lstsq(rows, target, rcond=None)[0]
        found = np.empty(len(vertex), complex)
        found[node] = groups.layout[member]
        np.testing.assert_allclose(found - found.mean(), expected - expected.mean(), atol=0.02)


@pytest.mark.parametrize("order", [1, 2, 4])
def test_a_singularity_is_on_the_rim(order: int) -> None:
    n = 24
    mesh = flat_square(n)
    middle = n // 2 * (n + 1) + n // 2
    away = mesh.vertices - mesh.vertices[middle]
    angle = np.arctan2(away[:, 1], away[:, 0]) / order  # once around, the field turns by one symmetry
    field = from_vectors(mesh, order, np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1))
    flat = lay_flat(mesh, field, texel=1 / 80)
    groups = group(mesh, flat, order=order, width=WIDTH)
    check_laws(mesh, flat, order, groups)
    assert not wraps_around(mesh, groups, middle)
    inner = ~mesh.boundary_vertices
    assert any(wraps_around(mesh, groups, vertex) for vertex in np.flatnonzero(inner))  # others may be inside


def test_a_sharp_apex_is_on_the_rim_and_a_blunt_one_may_be_inside() -> None:
    inside, single = {}, {}
    for height in (0.2, 1.5, 3.0):  # 0.02, 0.45 and 0.68 of a full circle are missing at the apex
        mesh = cone(24, 12, height=height)
        field = from_vectors(mesh, 4, np.broadcast_to([1.0, 0.2, 0.0], mesh.vertices.shape))
        flat = lay_flat(mesh, field, texel=1 / 20)
        found = [group(mesh, flat, order=4, width=WIDTH, seed=seed) for seed in range(6)]
        inside[height] = [wraps_around(mesh, groups, 0) for groups in found]
        single[height] = [np.count_nonzero(np.bincount(groups.patch) == 1) for groups in found]
    assert any(inside[0.2]) and not any(inside[1.5]) and not any(inside[3.0])
    assert np.mean(single[1.5]) < 4  # cut where the field jumps, not torn to pieces after


def test_corners_of_a_cube_are_on_the_rim() -> None:
    mesh = cube(12)
    flat = lay_flat(mesh, smoothest(mesh, 4), texel=1 / 50)
    corners = np.flatnonzero(np.all(np.abs(mesh.vertices) > 0.499, axis=1))
    for seed in range(4):
        groups = group(mesh, flat, order=4, width=WIDTH, seed=seed)
        assert len(corners) == 8 and not any(wraps_around(mesh, groups, corner) for corner in corners)
        assert np.bincount(groups.patch).min() > 1
        assert groups.patch.max() + 1 < 59  # its squared widths: groups bend around the edges


@pytest.mark.parametrize("order", [1, 4])
def test_where_the_field_turns_fast_lengths_count_more(order: int) -> None:
    mesh = flat_square(24)
    angle = 10 * mesh.vertices[:, 0]  # 115 degrees in a width
    field = from_vectors(mesh, order, np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1))
    flat = lay_flat(mesh, field, texel=1 / 80)
    groups = group(mesh, flat, order=order, width=WIDTH)
    check_laws(mesh, flat, order, groups)
    assert groups.patch.max() + 1 < 100  # 25 squared widths


def test_a_thin_tube_is_cut_open() -> None:
    mesh = cylinder(around=10, rings=30, radius=0.2, height=3.0)
    flat = lay_flat(mesh, from_vectors(mesh, 1, np.broadcast_to([0.0, 0, 1], mesh.vertices.shape)), texel=1 / 10)
    groups = group(mesh, flat, order=1, width=WIDTH)  # its girth is 12 texels
    check_laws(mesh, flat, 1, groups)
    assert groups.patch.max() + 1 < 20


def test_large_faces_stay_alone() -> None:
    mesh = flat_square(4)
    flat = lay_flat(mesh, smoothest(mesh, 4), texel=1 / 80)  # sides of 20 and 28 texels
    groups = group(mesh, flat, order=4, width=WIDTH)
    np.testing.assert_array_equal(groups.patch, np.arange(len(flat)))
    np.testing.assert_array_equal(groups.layout, flat)


def test_a_texture_that_grows_along_the_surface() -> None:
    mesh = flat_square(24)
    scale = 1 + 0.5 * mesh.vertices[:, 0]
    flat = lay_flat(mesh, smoothest(mesh, 4), texel=1 / 100, scale=scale)
    groups = group(mesh, flat, order=4, width=WIDTH)
    check_laws(mesh, flat, 4, groups)
    assert groups.patch.max() + 1 < 50  # some 27 squared widths


def test_same_groups_again_for_any_thread_count() -> None:
    mesh = torus(48, 24)
    flat = laid(mesh, 4)
    threads = thread_count()
    try:
        runs = []
        for number in (1, 3):
            use(threads=number)
            runs.append(group(mesh, flat, order=4, width=WIDTH, seed=5))
    finally:
        use(threads=threads)
    np.testing.assert_array_equal(runs[0].patch, runs[1].patch)
    np.testing.assert_array_equal(runs[0].layout, runs[1].layout)
    other = group(mesh, flat, order=4, width=WIDTH, seed=6)
    assert np.any(other.patch != runs[0].patch)


def test_turning_the_plane_over_changes_no_group() -> None:
    mesh = torus(32, 16)
    flat = laid(mesh, 2)
    groups, mirrored = (group(mesh, z, order=2, width=WIDTH) for z in (flat, np.conj(flat)))
    np.testing.assert_array_equal(groups.patch, mirrored.patch)
    np.testing.assert_allclose(groups.layout, np.conj(mirrored.layout), atol=1e-9)


@pytest.mark.parametrize("width", [0.0, -3.0, np.nan, np.inf])
def test_no_width_is_refused(width: float) -> None:
    mesh = as_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(ParameterError, match="give a width above 0"):
        group(mesh, laid(mesh, 1), order=1, width=width)
