"""Stencils on surfaces: samples a texel apart along the site's own frame, until the surface ends."""

import numpy as np
import pytest
from numpy import ndarray

from tests.meshes import cylinder, flat_square, sphere
from tests.rolled import inner, rolled, turned, unrolled
from texloom.domain.neighbourhoods import Neighbourhoods, Stencils, as_stencils
from texloom.domain.surface import Surface
from texloom.field.direction import from_constant, from_vectors
from texloom.kernels.launch import thread_count, use

ORDERS = pytest.mark.parametrize("order", [1, 2, 4, 6])
DIAGONAL = np.array([0.8, 0.6, 0.0])


def places(surface: Surface, stencils: Stencils) -> tuple[ndarray, ndarray]:
    """Where every sample lies, and which there are."""
    there = stencils.sites[..., 0] >= 0
    assert stencils.weights is not None
    np.testing.assert_array_equal(stencils.sites < 0, ~there[..., None] & np.ones(3, bool))
    np.testing.assert_allclose(stencils.weights.sum(axis=2), there, atol=1e-5)
    corners = surface.refined.mesh.vertices[stencils.sites]
    return np.einsum("nsc,nscx->nsx", stencils.weights, corners), there


def steps(surface: Surface, at: ndarray) -> ndarray:
    """[row, column] texels of places (site, sample, 3) in the tangent plane of each site."""
    way = (at - surface.refined.mesh.vertices[:, None]) / surface.texel_length[:, None, None]
    up = np.cross(surface.normal, surface.direction)
    return np.stack([-np.einsum("nsx,nx->ns", way, up), np.einsum("nsx,nx->ns", way, surface.direction)], axis=-1)


@ORDERS
@pytest.mark.parametrize("width", [3, 7])
def test_in_the_plane_samples_lie_at_whole_steps_as_far_as_it_goes(order: int, width: int) -> None:
    mesh = flat_square(16, 16.0)
    surface = Surface.build(mesh, from_constant(mesh, order, DIAGONAL), texel=0.8)
    stencils = surface.stencils(width)
    offset = np.stack(np.divmod(np.arange(width**2), width), axis=1) - width // 2
    np.testing.assert_array_equal(stencils.offset, offset[None])
    at, there = places(surface, stencils)
    np.testing.assert_allclose(
        steps(surface, at)[there], np.broadcast_to(offset, at.shape[:2] + (2,))[there], atol=1e-3
    )

    # A sample is there where the way to it, up or down and then left or right, stays inside
    up = np.cross(surface.normal, surface.direction)
    corner = surface.refined.mesh.vertices[:, None] - 0.8 * offset[:, :1] * up[:, None]
    end = corner + 0.8 * offset[:, 1:] * surface.direction[:, None]
    depth = np.minimum(*(np.minimum(way, 16 - way)[..., :2].min(axis=2) for way in (corner, end)))
    assert there[depth > 0.01].all()
    assert not there[depth < -0.01].any()


@ORDERS
def test_on_a_rolled_plane_samples_lie_where_the_plane_says(order: int) -> None:
    """Also where the frames of a symmetric field change from one of its directions to the next."""
    surface = rolled(order)
    stencils = surface.stencils(5)
    assert stencils.weights is not None
    at = unrolled(surface)
    far = inner(surface, 4)
    read = np.einsum("nsc,nscx->nsx", stencils.weights, at[stencils.sites])[far] - at[far, None]
    (row, column), angle = np.moveaxis(stencils.offset[0], 1, 0), turned(surface)[far, None]
    expected = np.cos(angle) * row + np.sin(angle) * column, np.cos(angle) * column - np.sin(angle) * row
    there = stencils.sites[far, :, 0] >= 0
    assert there.mean() > 0.8
    np.testing.assert_allclose(read[there], np.stack(expected, axis=-1)[there], atol=0.02)


def test_on_a_sphere_steps_are_along_its_circles() -> None:
    """Around an axis: the middle row stays on its parallel, the middle column on its meridian."""
    mesh = sphere(4)
    surface = Surface.build(mesh, from_vectors(mesh, 1, np.cross([0.0, 0, 1], mesh.vertices)), texel=0.05)
    at, there = places(surface, surface.stencils(7))
    far = np.abs(surface.refined.mesh.vertices[:, 2]) < 0.7
    assert there[far].all()
    x, y, z = np.moveaxis(at[far].reshape(-1, 7, 7, 3), 3, 0)
    latitude, longitude = np.arctan2(z, np.hypot(x, y)), np.unwrap(np.unwrap(np.arctan2(y, x), axis=1), axis=2)
    np.testing.assert_allclose(latitude[:, 3] - latitude[:, 3, 3:4], 0, atol=0.004)
    np.testing.assert_allclose(longitude[:, :, 3] - longitude[:, 3, 3:4], 0, atol=0.004)
    np.testing.assert_allclose(np.diff(latitude[:, :, 3], axis=1), -0.05, atol=0.003)
    np.testing.assert_allclose(np.diff(longitude[:, 3], axis=1) * np.cos(latitude[:, 3, 3:4]), 0.05, atol=0.003)


def test_nothing_lies_beyond_a_boundary() -> None:
    mesh = cylinder(48, 16, height=1.0)
    surface = Surface.build(mesh, from_vectors(mesh, 1, np.cross([0.0, 0, 1], mesh.vertices)), texel=0.05)
    _, there = places(surface, surface.stencils(7))
    height = surface.refined.mesh.vertices[:, 2]
    for row in range(-3, 4):
        whole = there.reshape(-1, 7, 7)[:, row + 3]
        end = height - 0.05 * row
        assert whole[(end > 0.001) & (end < 0.999)].all()
        assert not whole[(end < -0.001) | (end > 1.001)].any()


def test_scale_spreads_samples() -> None:
    mesh = flat_square(8, 4.0)
    field = from_constant(mesh, 1, np.array([1.0, 0, 0]))
    surface = Surface.build(mesh, field, texel=0.1, scale=1 + 0.25 * mesh.vertices[:, 0])
    at, there = places(surface, surface.stencils(5))
    middle = np.abs(surface.refined.mesh.vertices[:, :2] - 2).max(axis=1) < 0.5
    assert there[middle].all()
    x = at[middle].reshape(-1, 5, 5, 3)[..., 0]
    np.testing.assert_allclose(np.diff(np.log(1 + 0.25 * x), axis=2), 0.025, atol=1e-3)


def test_threads_make_no_difference() -> None:
    before, made = thread_count(), []
    try:
        for threads in (1, 2):
            use(threads=threads)
            made.append(rolled(4).stencils(5))
    finally:
        use(threads=before)
    np.testing.assert_array_equal(made[0].sites, made[1].sites)
    np.testing.assert_array_equal(made[0].weights, made[1].weights)


def test_neighbours_as_samples() -> None:
    sites, offset = np.array([[2, -1], [0, 1]], np.int32), np.zeros((1, 2, 2), np.float32)
    stencils = as_stencils(Neighbourhoods(sites, offset))
    assert stencils.weights is None and stencils.offset is offset
    np.testing.assert_array_equal(stencils.sites[..., 0], sites)
