"""Sites of a surface domain, as outputs see them."""

import numpy as np

from tests.output.shapes import sphere
from texloom.domain.surface import Surface
from texloom.field.direction import from_constant
from texloom.output.sites import SurfaceSites


def test_sites_of_a_surface_find_their_way_home_and_are_shaded_smoothly():
    mesh = sphere(8)
    surface = Surface.build(mesh, from_constant(mesh, 1, np.array([1.0, 0.3, 0.0])), texel=0.1)
    sites = SurfaceSites.of(surface)
    home = sites.at_corners(mesh.vertices[mesh.faces])
    np.testing.assert_allclose(home, sites.vertices[sites.faces], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(sites.shown_normal, axis=1), 1, atol=1e-6)
    outwards = sites.vertices / np.linalg.norm(sites.vertices, axis=1, keepdims=True)
    smooth = np.einsum("si,si->s", sites.shown_normal, outwards)
    assert smooth.min() > 0.995 > np.einsum("si,si->s", sites.normal, outwards).min()
    np.testing.assert_allclose(sites.upward, np.cross(sites.normal, sites.direction), atol=1e-6)
