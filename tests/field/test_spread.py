"""Directions spread over points."""

import numpy as np
import pytest

from tests.meshes import flat_square, sphere
from texloom.errors import FieldError
from texloom.field.direction import vertex_directions
from texloom.field.singularities import indices
from texloom.field.smooth import through_arrows
from texloom.field.spread import directions

X = np.array([0.1, 0.2, 0.97])


def test_one_arrow_on_a_plane_goes_everywhere():
    mesh = flat_square(12)
    arrow = np.array([[0.6, 0.8, 0.0]])
    found = vertex_directions(mesh, directions(mesh, 1, vertices=np.array([40]), directions=arrow))
    np.testing.assert_allclose(found, np.broadcast_to(arrow, found.shape), atol=1e-6)


def test_arrows_are_met_and_the_rest_lies_near_the_smoothest():
    mesh = sphere(4)
    vertices = np.array([0, 2])
    arrows = np.cross(mesh.vertices[vertices], [[0.0, 0.3, 1.0]])
    arrows /= np.linalg.norm(arrows, axis=1, keepdims=True)
    field = directions(mesh, 1, vertices=vertices, directions=arrows)
    found = vertex_directions(mesh, field)
    np.testing.assert_allclose(found[vertices], arrows, atol=1e-6)
    solved = vertex_directions(mesh, through_arrows(mesh, 1, vertices=vertices, directions=arrows))
    near = np.arccos(np.clip(mesh.vertices @ mesh.vertices[vertices].T, -1, 1)).min(axis=1) < 0.8
    assert np.einsum("vd,vd->v", found, solved)[near].min() > 0.8


@pytest.mark.parametrize("order", [1, 2])
def test_no_singularities_but_those_the_sphere_forces(order):
    mesh = sphere(4)
    field = directions(mesh, order, vertices=np.array([0]), directions=np.array([np.cross(mesh.vertices[0], X)]))
    found = indices(mesh, field)
    assert np.isclose(found.sum(), 2.0)
    assert order == 2 or np.count_nonzero(found) <= 4  # doubled vectors turn twice as fast where they are short


def test_no_arrow_is_refused():
    with pytest.raises(FieldError, match="no arrows to spread"):
        directions(sphere(2), 1, vertices=np.empty(0, np.int64), directions=np.empty((0, 3)))
