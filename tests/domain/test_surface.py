"""Patches traced on surfaces: the plane's where it is flat, pasted and read back, over everything, to the bit."""

import numpy as np
import pytest
from numpy import ndarray

from tests.data import DATA, needs_data
from tests.meshes import as_mesh, cylinder, flat_square, sphere, torus
from texloom.domain.grid import Grid
from texloom.domain.patches import Patches
from texloom.domain.surface import Surface, texel_for_repeats
from texloom.errors import FieldError, ParameterError
from texloom.field.direction import from_constant, from_vectors
from texloom.field.smooth import smoothest
from texloom.kernels.launch import thread_count, use
from texloom.mesh.mend import mend
from texloom.mesh.mesh import Mesh


def cube(cells: int = 6) -> Mesh:
    """A cube of side 1, every face ``cells × cells``."""
    square = flat_square(cells)
    x, y, z = np.eye(3)
    sides = [(x, y, z), (y, z, x), (z, x, y), (y, x, -z), (z, y, -x), (x, z, -y)]
    points = [(square.vertices[:, :2] - 0.5) @ np.array([u, v]) + 0.5 * w for u, v, w in sides]
    count = len(square.vertices)
    faces = [square.faces + k * count for k in range(6)]
    return mend(np.concatenate(points), np.concatenate(faces)).mesh


def around(mesh: Mesh, order: int = 1, pole: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Surface:
    """A surface of about a thousand texels with a field around an axis."""
    texel = float(np.sqrt(mesh.face_areas.sum() / 2000))
    return Surface.build(mesh, from_vectors(mesh, order, np.cross(pole, mesh.vertices)), texel=texel)


def pasted_and_read(surface: Surface, patches: Patches, patch: int) -> tuple[ndarray, ndarray]:
    """A patch's [row, column] ramp pasted onto the sites and read back, and which samples could be read."""
    entry = np.flatnonzero(patches.cover_patch == patch)
    site = np.searchsorted(patches.cover_start, entry, side="right") - 1
    value = np.full((surface.count, 2), np.nan)
    value[site] = patches.cover_position[entry]
    assert patches.weights is not None
    read = np.einsum("sc,scd->sd", patches.weights[patch], value[patches.sites[patch]])
    return read, (patches.sites[patch, :, 0] >= 0) & np.isfinite(read).all(axis=1)


def test_a_flat_square_gives_the_patches_of_the_grid() -> None:
    n = 30
    mesh = flat_square(n, float(n))
    surface = Surface.build(mesh, from_constant(mesh, 1, np.array([1.0, 0, 0])), texel=1.0)
    grid = Grid(n + 1, n + 1)
    assert surface.count == grid.count
    site_on_mesh = np.arange(grid.count).reshape(n + 1, n + 1)[::-1].ravel()  # rows run down, y runs up
    on_grid = np.array([r * (n + 1) + c for r in (10, 15, 20) for c in (10, 14, 21)], np.int32)
    expected = grid.patches(on_grid, 12)
    found = surface.patches(site_on_mesh[on_grid].astype(np.int32), 12)

    assert found.weights is not None and found.cover_turn is None
    value = np.random.default_rng(0).random(grid.count)
    read = (value[found.sites] * found.weights).sum(axis=-1)
    np.testing.assert_allclose(read, value[site_on_mesh[expected.sites[..., 0]]], atol=1e-4)
    start = np.append(0, np.cumsum(np.diff(expected.cover_start)[np.argsort(site_on_mesh)]))
    np.testing.assert_array_equal(found.cover_start, start)
    for site in (site_on_mesh[12 * (n + 1) + 13], site_on_mesh[18 * (n + 1) + 20]):
        row = np.argsort(site_on_mesh)[site]
        mine, theirs = (slice(*p.cover_start[k : k + 2]) for p, k in ((found, site), (expected, row)))
        np.testing.assert_array_equal(found.cover_patch[mine], expected.cover_patch[theirs])
        np.testing.assert_allclose(found.cover_position[mine], expected.cover_position[theirs], atol=1e-4)


@pytest.mark.parametrize("mesh", [torus(), sphere(3), cylinder()], ids=["torus", "sphere", "cylinder"])
def test_what_is_pasted_is_read_back(mesh: Mesh) -> None:
    surface = around(mesh)
    patches = surface.patches(surface.centres(8, seed=1), 12)
    sample = np.stack(np.divmod(np.arange(144), 12), axis=1)
    known = []
    for patch in range(patches.count):
        read, fine = pasted_and_read(surface, patches, patch)
        known.append(np.abs(read - sample)[fine])
    error = np.concatenate(known)
    assert len(error) > 0.6 * 144 * patches.count
    assert np.quantile(error, 0.5) < 0.03
    assert np.quantile(error, 0.99) < 0.4  # texels, where the field turns fastest


def test_the_cover_keeps_each_patch_once_in_order() -> None:
    surface = around(torus())
    patches = surface.patches(surface.centres(5, seed=0), 10)
    site = np.repeat(np.arange(surface.count), np.diff(patches.cover_start))
    assert np.all(np.diff(site * patches.count + patches.cover_patch) > 0)
    assert patches.cover_position.min() >= -0.5
    assert patches.cover_position.max() <= 9.5


@pytest.mark.parametrize("mesh", [torus(), cylinder(), cube()], ids=["torus", "cylinder", "cube"])
@pytest.mark.parametrize("order", [1, 4])
def test_every_site_is_covered(mesh: Mesh, order: int) -> None:
    texel = float(np.sqrt(mesh.face_areas.sum() / 3000))
    surface = Surface.build(mesh, smoothest(mesh, order), texel=texel)
    patches = surface.patches(surface.centres(4, seed=2), 16)
    covered = np.diff(patches.cover_start) > 0
    # within two texels of a singularity of the field a site may stay uncovered
    assert covered.mean() > 0.995


def test_sites_far_denser_than_samples_are_all_placed() -> None:
    n, step = 96, 8  # 64 sites a texel: more than there is room for at first
    mesh = flat_square(n, float(n))
    surface = Surface.build(mesh, from_constant(mesh, 1, np.array([1.0, 0, 0])), texel=float(step))
    assert surface.count == (n + 1) ** 2
    centre = n // 2 * (n + 1) + n // 2
    patches = surface.patches(np.array([centre], np.int32), 6)
    offset = (surface.refined.mesh.vertices - surface.refined.mesh.vertices[centre])[:, 1::-1] / [-step, step]
    distance = np.abs(offset + 0.5).max(axis=1)  # from the middle of the patch
    placed = np.diff(patches.cover_start) == 1
    np.testing.assert_array_equal(placed[distance < 2.99], True)
    np.testing.assert_array_equal(placed[distance > 3.01], False)
    np.testing.assert_allclose(patches.cover_position, offset[placed] + 3, atol=1e-4)


def test_patches_do_not_depend_on_those_laid_with_them() -> None:
    surface = around(torus(), order=4)
    centres = surface.centres(4, seed=3)
    assert len(centres) > 64  # more than one batch
    together, alone = surface.patches(centres, 10), surface.patches(centres[70:71], 10)
    np.testing.assert_array_equal(together.sites[70], alone.sites[0])
    mine = together.cover_patch == 70
    np.testing.assert_array_equal(together.cover_position[mine], alone.cover_position)
    assert together.cover_turn is not None and alone.cover_turn is not None
    np.testing.assert_array_equal(together.cover_turn[mine], alone.cover_turn)


def test_turns_are_quarter_turns_and_match_the_frames() -> None:
    mesh = cube()
    surface = Surface.build(mesh, smoothest(mesh, 4), texel=0.02)
    patches = surface.patches(surface.centres(8, seed=0), 12)
    assert patches.cover_turn is not None
    quarters = patches.cover_turn / (np.pi / 2)
    np.testing.assert_allclose(quarters, np.round(quarters), atol=1e-6)
    # at the centre a patch's axes are the site's own directions, turned: its column axis leads to sample (6, 7)
    assert patches.weights is not None
    place = np.einsum("psc,pscd->psd", patches.weights, surface.refined.mesh.vertices[patches.sites])
    checked = 0
    for patch, site in enumerate(patches.centres):
        entries = slice(*patches.cover_start[site : site + 2])
        turn = patches.cover_turn[entries][patches.cover_patch[entries] == patch]
        if len(turn) == 0 or (patches.sites[patch, [6 * 12 + 5, 6 * 12 + 7], 0] < 0).any():
            continue
        way = place[patch, 6 * 12 + 7] - place[patch, 6 * 12 + 5]
        d, n = surface.direction[site], surface.normal[site]
        axis = np.cos(turn[0]) * d + np.sin(turn[0]) * np.cross(n, d)
        checked += 1
        assert way @ axis / np.linalg.norm(way) > 0.7
    assert checked > 30


def test_patches_end_at_a_boundary() -> None:
    mesh = cylinder(radius=1.0, height=1.0)
    surface = around(mesh)
    rim = np.flatnonzero(surface.refined.mesh.boundary_vertices)[:1].astype(np.int32)
    patches = surface.patches(rim, 12)
    reached = patches.sites[0, :, 0].reshape(12, 12) >= 0
    assert 0.35 < reached.mean() < 0.75
    np.testing.assert_array_equal(patches.sites[0][~reached.ravel()], -1)
    assert patches.weights is not None
    np.testing.assert_allclose(patches.weights[0][reached.ravel()].sum(axis=1), 1, atol=1e-5)
    np.testing.assert_array_equal(patches.weights[0][~reached.ravel()], 0)


def test_a_moebius_strip_takes_patches_once_mended() -> None:
    count = 40
    angle = 2 * np.pi * np.arange(count) / count
    across = np.stack([np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)], axis=1)
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([ring - 0.3 * across, ring + 0.3 * across])
    i = np.arange(count - 1)
    a, b, c, d = i, i + 1, count + i + 1, count + i
    last = [[count - 1, count, 0], [count - 1, 0, 2 * count - 1]]
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1), last])
    mesh = mend(points, faces).mesh
    surface = Surface.build(mesh, smoothest(mesh, 2), texel=0.03)
    patches = surface.patches(surface.centres(4, seed=0), 12)
    assert (np.diff(patches.cover_start) > 0).mean() > 0.98


def test_scale_spreads_sites_samples_and_centres() -> None:
    mesh = flat_square(8, 1.0)
    scale = 1 + 2 * mesh.vertices[:, 0]
    field = from_constant(mesh, 1, np.array([1.0, 0, 0]))
    surface = Surface.build(mesh, field, texel=0.01, scale=scale)
    x = surface.refined.mesh.vertices[:, 0]
    np.testing.assert_allclose(surface.scale, 1 + 2 * x, rtol=1e-5)
    centres = surface.centres(6, seed=0)
    left, right = np.count_nonzero(x[centres] < 0.3), np.count_nonzero(x[centres] > 0.7)
    assert left > 2 * right
    middle = np.argmin(np.linalg.norm(surface.refined.mesh.vertices - [0.5, 0.5, 0], axis=1))
    patches = surface.patches(np.array([middle], np.int32), 12)
    assert patches.weights is not None
    row = np.einsum("sc,sc->s", patches.weights[0], x[patches.sites[0]])[6 * 12 : 7 * 12]
    np.testing.assert_allclose(np.log(1 + 2 * row), np.log(2) + 0.02 * (np.arange(12) - 6), atol=2e-3)


def test_one_thread_and_two_agree_to_the_bit() -> None:
    before, found = thread_count(), []
    for threads in (1, 2):
        use(threads=threads)
        surface = around(torus(), order=4)
        found.append(surface.patches(surface.centres(6, seed=5), 12))
    use(threads=before)
    for part in ("centres", "sites", "weights", "cover_start", "cover_patch", "cover_position", "cover_turn"):
        np.testing.assert_array_equal(getattr(found[0], part), getattr(found[1], part))


def test_one_triangle_larger_than_texels_is_refined() -> None:
    mesh = as_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    surface = Surface.build(mesh, from_constant(mesh, 1, np.array([1.0, 0, 0])), texel=0.02)
    assert 0.4 < surface.area.mean() < 2.1
    np.testing.assert_allclose(surface.area.sum(), 0.5 / 0.02**2, rtol=1e-5)
    patches = surface.patches(surface.centres(6, seed=0), 16)
    assert np.diff(patches.cover_start).min() > 0


def test_bad_sizes_are_refused() -> None:
    mesh = flat_square(2)
    field = from_constant(mesh, 1, np.array([1.0, 0, 0]))
    with pytest.raises(ParameterError, match="above 0"):
        Surface.build(mesh, field, texel=0.0)
    with pytest.raises(FieldError, match="one for each vertex"):
        Surface.build(mesh, field, texel=0.1, scale=np.ones(3))
    with pytest.raises(FieldError, match="not above 0"):
        Surface.build(mesh, field, texel=0.1, scale=np.zeros(9))
    with pytest.raises(ParameterError, match="repeats"):
        texel_for_repeats(mesh, -1, 128)


@needs_data
def test_a_real_mesh_is_covered() -> None:
    trimesh = pytest.importorskip("trimesh")
    raw = trimesh.load(DATA / "meshes" / "bunny-watertight-3k.obj", process=False, force="mesh")
    mesh = mend(np.asarray(raw.vertices), np.asarray(raw.faces)).mesh
    surface = Surface.build(mesh, smoothest(mesh, 4), texel=texel_for_repeats(mesh, 2, 64))
    patches = surface.patches(surface.centres(8, seed=0), 32)
    assert (np.diff(patches.cover_start) == 0).mean() < 1e-3
