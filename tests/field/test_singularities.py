"""Indices sum to the Euler characteristic, and sit where fields are known to turn."""

import numpy as np
import pytest

from tests.meshes import closed_meshes, flat_square
from texloom.field.direction import from_vectors
from texloom.field.singularities import indices
from texloom.field.smooth import smoothest


@pytest.mark.parametrize("order", [1, 2, 4, 6])
@pytest.mark.parametrize("name", closed_meshes())
def test_indices_sum_to_the_euler_characteristic(name, order):
    mesh = closed_meshes()[name]
    euler = len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)
    np.testing.assert_allclose(indices(mesh, smoothest(mesh, order)).sum(), euler)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", closed_meshes())
def test_any_field_sums_to_it(name, seed):
    mesh = closed_meshes()[name]
    euler = len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)
    noise = np.random.default_rng(seed).normal(size=mesh.vertices.shape)
    np.testing.assert_allclose(indices(mesh, from_vectors(mesh, 2, noise)).sum(), euler)


@pytest.mark.parametrize("turns", [-2, -1, 1, 2])
@pytest.mark.parametrize("order", [1, 2, 4])
def test_a_planar_vortex_has_its_turns(order, turns):
    mesh = flat_square(16)
    x, y = (mesh.vertices[:, :2] - [0.51, 0.48]).T
    angle = turns * np.arctan2(y, x) / order + 0.3
    index = indices(mesh, from_vectors(mesh, order, np.stack([np.cos(angle), np.sin(angle), 0 * x], axis=1)))
    np.testing.assert_allclose(index.sum(), turns / order)
    centre = mesh.vertices[mesh.faces].mean(axis=1)[index != 0, :2]
    np.testing.assert_allclose(centre, [[0.51, 0.48]] * len(centre), atol=0.1)
