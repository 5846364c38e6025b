"""The site beside a place, by brute force."""

import numpy as np
import pytest
from numpy import ndarray

from tests.meshes import as_mesh, flat_square, sphere, torus
from texloom.domain.surface import Surface
from texloom.field.smooth import smoothest
from texloom.kernels.launch import launch
from texloom.kernels.neighbourhoods import find_beside
from texloom.mesh.mesh import Mesh


def surface_on(mesh: Mesh, order: int = 1) -> Surface:
    """The vertices of the mesh as sites; texels differ from site to site."""
    scale = 1 + 0.5 * mesh.vertices[:, 0] ** 2
    return Surface.build(mesh, smoothest(mesh, order), texel=0.1, scale=scale, spacing=np.inf)


def beside(
    surface: Surface, at: ndarray, along: ndarray, facing: ndarray, near: ndarray
) -> tuple[ndarray, ndarray, ndarray]:
    """Site, offset and turn of every place."""
    site, turn = np.empty(len(at), np.int32), np.empty(len(at), np.float32)
    offset = np.empty((len(at), 2), np.float32)
    frames = surface.refined.mesh.vertices, surface.direction, surface.normal, surface.texel_length, at, along, facing
    inputs = [near.astype(np.int32), *surface.neighbours, *(part.astype(np.float32) for part in frames)]
    launch(find_beside, len(at), inputs=inputs, outputs=[site, offset, turn])
    return site, offset, turn


def somewhere(surface: Surface, count: int) -> tuple[ndarray, ndarray, ndarray]:
    """Places in random faces: where, a tangent, and the normal."""
    rng, mesh = np.random.default_rng(0), surface.refined.mesh
    face = rng.integers(0, len(mesh.faces), count)
    at = np.einsum("pc,pcx->px", rng.dirichlet([1, 1, 1], count), mesh.vertices[mesh.faces[face]])
    return at, mesh.face_frames[face, 0], mesh.face_normals[face]


@pytest.mark.parametrize("mesh", [sphere(3), torus(), flat_square(12)], ids=["sphere", "torus", "square"])
@pytest.mark.parametrize("order", [1, 4])
def test_a_place_is_beside_the_nearest_site(mesh: Mesh, order: int) -> None:
    surface = surface_on(mesh, order)
    at, along, facing = somewhere(surface, 300)
    nearest = np.linalg.norm(at[:, None] - mesh.vertices, axis=2).argsort(axis=1)
    for begin in (0, 5, 20):
        site, offset, turn = beside(surface, at, along, facing, nearest[:, begin])
        np.testing.assert_array_equal(site, nearest[:, 0])

        direction, up = surface.direction[site], np.cross(surface.normal[site], surface.direction[site])
        way = at - mesh.vertices[site]
        row, column = -np.einsum("px,px->p", way, up), np.einsum("px,px->p", way, direction)
        length = np.linalg.norm(way, axis=1) / np.hypot(row, column) / surface.texel_length[site]
        np.testing.assert_allclose(offset, np.stack([row * length, column * length], axis=1), atol=1e-4)
        angle = np.arctan2(np.einsum("px,px->p", along, up), np.einsum("px,px->p", along, direction))
        np.testing.assert_allclose(np.exp(1j * turn), np.exp(-1j * angle), atol=1e-4)


def test_a_site_is_beside_itself_and_turned_by_what_is_asked() -> None:
    """``turn`` is the angle by which the site's frame is turned against the place's."""
    surface = surface_on(torus())
    angle = np.linspace(-3, 3, surface.count)[:, None]
    along = np.cos(angle) * surface.direction + np.sin(angle) * np.cross(surface.normal, surface.direction)
    itself = np.arange(surface.count)
    site, offset, turn = beside(surface, surface.refined.mesh.vertices, along, surface.normal, itself)
    np.testing.assert_array_equal(site, itself)
    np.testing.assert_array_equal(offset, 0)
    np.testing.assert_allclose(turn, -angle[:, 0], atol=1e-5)


def test_a_site_that_faces_away_is_no_neighbour() -> None:
    """At the rim of a thin lens, where a place nearer to a site of the other side is beside one of its own."""
    tilt = np.array([[1.0, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]])
    lens = as_mesh(sphere(3).vertices @ tilt * [1, 1, 0.02], sphere(3).faces)
    surface = surface_on(lens)
    first, second = np.concatenate([surface.edges, surface.edges[:, ::-1]]).T
    around_rim = (surface.normal[first, 2] > 0) & (surface.normal[second, 2] < 0)
    above, below = first[around_rim], second[around_rim]
    at = 0.4 * lens.vertices[above] + 0.6 * lens.vertices[below]
    site, _, _ = beside(surface, at, surface.direction[above], np.tile([0.0, 0, 1], (len(at), 1)), below)
    assert len(site) >= 20
    assert (surface.normal[site, 2] > 0).all()
