"""The iterative route and the direct one give one answer."""

import numpy as np
import pytest
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh, spsolve

from tests.meshes import flat_square, joined, octahedron, shifted, sphere, torus
from texloom.field import multigrid
from texloom.field.laplacian import connection_laplacian
from texloom.field.multigrid import Multigrid, plus_diagonal, principal_block
from texloom.field.transport import Transport
from texloom.mesh.mesh import Mesh


@pytest.fixture
def small_levels(monkeypatch):
    """Coarsen from 100 unknowns on, so that small meshes have several levels."""
    monkeypatch.setattr(multigrid, "_DIRECT", 100)


@pytest.mark.parametrize("order", [0, 1, 4, 6])
def test_solution_is_the_direct_one(order, small_levels):
    matrix = connection_laplacian(Transport(sphere(4)), order)
    free = np.ones(matrix.shape[0], bool)
    free[[0, 700]] = False
    block = principal_block(matrix, free)
    right = np.random.default_rng(0).normal(size=(block.shape[0], 2)) @ [1, 1j]
    expected = spsolve(block.tocsc(), right)
    found = Multigrid(block).solve(right, tolerance=1e-11)
    np.testing.assert_allclose(found, expected, atol=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize("order", [1, 4])
def test_a_cycle_takes_most_of_the_error(order, small_levels):
    """Convergence that does not depend on the size is what multigrid is for."""
    for subdivisions in (4, 5):
        matrix = connection_laplacian(Transport(sphere(subdivisions)), order)
        right = np.random.default_rng(0).normal(size=matrix.shape[0]).astype(complex)
        system = Multigrid(matrix)
        few = np.linalg.norm(matrix @ _steps(system, right, 8) - right)
        assert few < 1e-3 * np.linalg.norm(right)


def _steps(system, right, count):
    value, previous = np.zeros_like(right), multigrid._MOST_STEPS
    multigrid._MOST_STEPS = count
    try:
        return multigrid._conjugate_gradients(system, right, value, 0.0)
    finally:
        multigrid._MOST_STEPS = previous


def test_smallest_has_the_least_energy(small_levels):
    mesh = torus(48, 24)
    matrix = plus_diagonal(connection_laplacian(Transport(mesh), 2), 1e-3 * mesh.vertex_areas)
    least = eigsh(matrix, k=1, M=diags_array(mesh.vertex_areas).tocsc(), sigma=0, return_eigenvectors=False)[0]
    start = np.exp(1j * np.arange(len(mesh.vertices)))
    found = Multigrid(matrix).smallest(mesh.vertex_areas, mesh.vertex_parts, start)
    energy = np.vdot(found, matrix @ found).real / np.sum(mesh.vertex_areas * np.abs(found) ** 2)
    np.testing.assert_allclose(energy, least, rtol=0.03)


@pytest.mark.parametrize("order", [1, 4])
def test_powers_of_the_inverse_are_those_of_plain_iteration(order):
    """Parts of all sizes at once, whose scales differ by many powers of ten."""
    tiny = Mesh(1e-5 * np.eye(3), np.array([[0, 1, 2]], np.int32))
    mesh = joined(sphere(3), shifted(torus(60, 12), (1e4, 0.0, 0.0)), octahedron(), flat_square(24), tiny)
    area = np.bincount(mesh.vertex_parts, weights=mesh.vertex_areas)[mesh.vertex_parts]
    matrix = plus_diagonal(connection_laplacian(Transport(mesh), order), 1e-3 * mesh.vertex_areas / area)
    start = np.exp(1j * np.arange(len(mesh.vertices)) ** 2)
    system = Multigrid(matrix)
    expected = system._iterate(start, mesh.vertex_areas, mesh.vertex_parts, multigrid._INVERSE_STEPS)
    found = system.smallest(mesh.vertex_areas, mesh.vertex_parts, start)
    largest = np.array([np.abs(expected[mesh.vertex_parts == part]).max() for part in range(5)])[mesh.vertex_parts]
    np.testing.assert_allclose(found / largest, expected / largest, atol=1e-7)


def test_unknowns_without_couplings_are_solved_too(small_levels):
    matrix = connection_laplacian(Transport(sphere(3)), 1)
    scattered = principal_block(matrix, np.arange(matrix.shape[0]) % 3 == 0)
    right = np.ones(scattered.shape[0], complex)
    np.testing.assert_allclose(scattered @ Multigrid(scattered).solve(right, tolerance=1e-10), right, atol=1e-6)
