"""Levels of a surface: how many, how dense, and how the sites of each lie beside those of the coarser one."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from numpy import ndarray
from scipy.spatial import KDTree

from tests.domain.test_surface import cube
from tests.meshes import as_mesh, cylinder, flat_square, single_triangle, sphere, torus, two_parts
from tests.rolled import TEXEL, inner, rolled, turned, unrolled
from texloom.domain.levels import Beside, Levels, lay_levels
from texloom.domain.surface import Surface
from texloom.errors import ParameterError
from texloom.field.smooth import smoothest
from texloom.kernels.launch import thread_count, use
from texloom.mesh.mesh import Mesh


def surface_on(mesh: Mesh, texels: int = 1500, order: int = 4) -> Surface:
    """About so many texels of a smooth field."""
    return Surface.build(mesh, smoothest(mesh, order), texel=float(np.sqrt(mesh.face_areas.sum() / texels)))


def pairs(surface: Surface, levels: Levels) -> Iterator[tuple[Surface, Surface, Beside]]:
    """Every domain, what lies beside it, and how."""
    yield from zip(levels.domains, (*levels.domains[1:], surface), levels.onto, strict=True)


def places(domain: Surface) -> ndarray:
    return domain.refined.mesh.vertices


def apart(coarse: Surface, fine: Surface, beside: Beside) -> ndarray:
    """World distances of the places to the sites that they are said to be beside."""
    return np.linalg.norm(places(fine) - places(coarse)[beside.site], axis=1)


SURFACES: dict[str, Callable[[], Surface]] = {
    "sphere": lambda: surface_on(sphere(3)),
    "torus": lambda: surface_on(torus(), order=1),
    "square": lambda: surface_on(flat_square(8), order=2),
    "cylinder": lambda: surface_on(cylinder()),
    "parts": lambda: surface_on(two_parts(), 3000),
}


@pytest.fixture(scope="module", params=list(SURFACES))
def made(request: pytest.FixtureRequest) -> tuple[Surface, Levels]:
    surface = SURFACES[request.param]()
    return surface, lay_levels(surface, 3, seed=1)


def test_each_level_is_twice_as_fine_as_the_one_before(made: tuple[Surface, Levels]) -> None:
    surface, levels = made
    texels = float(surface.area.sum())
    assert len(levels.onto) == len(levels.domains) == 3
    for coarseness, domain in zip((4, 2, 1), levels.domains, strict=True):
        assert domain.texel == pytest.approx(coarseness * surface.texel)
        assert domain.count == pytest.approx(1.1547 * texels / coarseness**2, rel=0.01)
        near = KDTree(places(domain)).query(places(domain), 2)[0][:, 1]
        assert 0.8 < np.median(near) / domain.texel < 1.05  # a site a texel


def test_sites_of_a_level_stay_in_the_finer_ones(made: tuple[Surface, Levels]) -> None:
    for coarse, fine, beside in list(pairs(*made))[:-1]:
        same = KDTree(places(fine)).query(places(coarse), 2)
        assert (same[0][:, 0] == 0).all() and (same[0][:, 1] > 0).all()
        kept = same[1][:, 0]
        np.testing.assert_array_equal(beside.site[kept], np.arange(coarse.count))
        np.testing.assert_array_equal(beside.offset[kept], 0)
        others = np.setdiff1d(np.arange(fine.count), kept)
        assert (np.abs(beside.offset[others]).max(axis=1) > 0.2).all()


def test_places_are_beside_the_nearest_site(made: tuple[Surface, Levels]) -> None:
    """The whole nearest by brute force, nearly always; and their offset is as long as they are apart."""
    for coarse, fine, beside in pairs(*made):
        found = apart(coarse, fine, beside)
        least = KDTree(places(coarse)).query(places(fine))[0]
        assert (found < least + 1e-6 * coarse.texel).mean() > 0.995
        assert (found < 1.1 * least + 1e-6 * coarse.texel).all()
        np.testing.assert_allclose(
            np.linalg.norm(beside.offset, axis=1), found / coarse.texel_length[beside.site], atol=1e-4
        )


def test_parts_never_mix(made: tuple[Surface, Levels]) -> None:
    surface, levels = made
    middle = surface.refined.mesh.vertices[surface.refined.mesh.vertex_parts == 0].mean(axis=0)
    for coarse, fine, beside in pairs(surface, levels):
        ours, theirs = (domain.refined.mesh.vertex_parts for domain in (fine, coarse))
        assert ours.max() == theirs.max() == surface.mesh.vertex_parts.max()
        first = [np.linalg.norm(places(d) - middle, axis=1) < 1.5 for d in (fine, coarse)]
        if ours.max():
            np.testing.assert_array_equal(first[0], first[1][beside.site])


def test_the_field_is_that_of_the_surface(made: tuple[Surface, Levels]) -> None:
    surface, levels = made
    branch = 2 * np.pi / surface.field.order
    for domain in levels.domains:
        _, near = KDTree(places(surface)).query(places(domain))
        theirs, ours, normal = surface.direction[near], domain.direction, domain.normal
        angle = np.arctan2(np.einsum("sx,sx->s", np.cross(normal, ours), theirs), np.einsum("sx,sx->s", ours, theirs))
        away = np.abs(angle - branch * np.rint(angle / branch))
        assert np.quantile(away, 0.9) < 0.15 * domain.texel / surface.texel  # what it turns by to the next site


@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_on_a_rolled_plane_offsets_and_turns_are_those_of_the_plane(order: int) -> None:
    """Also where the frames of a symmetric field change from one of its directions to the next."""
    surface = rolled(order)
    levels = lay_levels(surface, 3)
    assert [round(domain.texel / TEXEL) for domain in levels.domains] == [2, 1]  # a third would have 45 sites
    for coarse, fine, beside in pairs(surface, levels):
        at, ok = turned(coarse)[beside.site], inner(fine, 3)
        row, column = beside.offset.T * coarse.texel / TEXEL
        way = np.stack([np.cos(at) * row + np.sin(at) * column, np.cos(at) * column - np.sin(at) * row], axis=1)
        np.testing.assert_allclose((unrolled(coarse)[beside.site] + way)[ok], unrolled(fine)[ok], atol=0.01)
        error = np.exp(1j * (at + beside.turn - turned(fine)))[ok]
        np.testing.assert_allclose(error, np.ones_like(error), atol=1e-3)
        assert (beside.turn != 0).any() == (order > 2)


def test_the_sides_of_a_sheet_do_not_mix() -> None:
    """The finest texels are twice as long as the sheet is thick: what faces up is beside what faces up."""
    solid = cube(8)
    surface = surface_on(as_mesh(solid.vertices * [1, 1, 0.015], solid.faces), 2500)
    for coarse, fine, beside in pairs(surface, lay_levels(surface, 3)):
        agree = np.einsum("sx,sx->s", fine.normal, coarse.normal[beside.site]) > 0
        assert (~agree).mean() < 0.002  # at the rim, where there is none that does
        inside = np.abs(places(fine)[:, :2]).max(axis=1) < 0.5 - coarse.texel
        assert inside.sum() > 0.3 * fine.count and agree[inside].all()


def test_texels_follow_the_scale() -> None:
    mesh = flat_square(8)
    scale = 1 + 2 * mesh.vertices[:, 0]
    surface = Surface.build(mesh, smoothest(mesh, 1), texel=0.02, scale=scale)
    levels = lay_levels(surface, 2)
    for coarse, fine, beside in pairs(surface, levels):
        np.testing.assert_allclose(coarse.scale, 1 + 2 * places(coarse)[:, 0], rtol=1e-4)
        found = apart(coarse, fine, beside)
        assert np.quantile(found / coarse.texel_length[beside.site], 0.99) < 0.75
        left, right = (np.count_nonzero(np.abs(places(coarse)[:, 0] - x) < 0.15) for x in (0.15, 0.85))
        assert left / right == pytest.approx((2.7 / 1.3) ** 2, rel=0.25)


def test_small_surfaces_have_fewer_levels() -> None:
    counts = {texels: [d.count for d in lay_levels(surface_on(sphere(2), texels), 4).domains] for texels in (60, 900)}
    assert counts[60] == [69]
    assert counts[900] == [64, 259, 1039]
    mesh = single_triangle()
    tiny = Surface.build(mesh, smoothest(mesh, 1), texel=0.5)
    levels = lay_levels(tiny, 3)
    assert [domain.count for domain in levels.domains] == [64]
    assert np.isfinite(levels.onto[0].offset).all() and len(levels.onto[0].site) == tiny.count


def test_no_level_is_refused() -> None:
    with pytest.raises(ParameterError, match="0 levels: give 1 or more"):
        lay_levels(surface_on(sphere(2)), 0)


def test_same_seed_same_levels_on_any_number_of_threads() -> None:
    before, made = thread_count(), []
    try:
        for threads in (1, 2):
            use(threads=threads)
            made.append(lay_levels(surface_on(torus()), 2, seed=7))
    finally:
        use(threads=before)
    for one, other in zip(made[0].domains, made[1].domains, strict=True):
        np.testing.assert_array_equal(places(one), places(other))
    for one, other in zip(made[0].onto, made[1].onto, strict=True):
        for name in ("site", "offset", "turn"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    other = lay_levels(surface_on(torus()), 2, seed=8)
    assert not np.array_equal(places(other.domains[0]), places(made[0].domains[0]))
