"""Solves with Hermitian Laplacians of a surface, in time and memory linear in its vertices.

Small systems are factored. Larger ones are solved by conjugate gradients, preconditioned by smoothed aggregation
(Vaněk et al. 1996; aggregates by distance-2 independent sets, Bell et al. 2012): neighbours are lumped, each turned by
the connection into the frame of its lump's root, until the system is small. At 187 k vertices setting up and
solving took 1.0 s of CPU time, ordering (nested dissection) and factoring the same matrix 3.7 s.

Sums run in a fixed order, so that the result is the same for any number of threads.
"""

import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Bool, Complex128, Float64, Int32

from texloom import draws
from texloom.field.lanczos import iterated_inverse, normalized

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_DIRECT = 5000  # unknowns; up to here factoring is the faster way
_STRONG = 0.05  # of the geometric mean of the diagonals: weaker couplings do not join two unknowns in one lump
_DAMPING = 2 / 3  # of Jacobi steps: the spectral radius of a diagonally dominant matrix so scaled is at most 2
_SWEEPS = 2
_MOST_STEPS = 200
_INVERSE_STEPS = 40  # of power iteration on the factored level; cheap there
_REFINING_STEPS = 2  # of inverse iteration on each finer level


class Multigrid:
    """A Hermitian positive definite matrix, made ready for many right-hand sides."""

    def __init__(self, matrix: "csr_array") -> None:
        self.matrix = matrix
        self._diagonal: np.ndarray = np.real(matrix.diagonal())
        self._prolongation: csr_array | None = None
        if len(self._diagonal) > _DIRECT:
            prolongation, lumps = _prolongation(matrix, self._diagonal)
            if lumps < 0.7 * len(self._diagonal):
                self._lumps = lumps
                self._prolongation = prolongation
                self._restriction = prolongation.conj().T.tocsr()
                self._coarse = Multigrid(self._restriction @ (matrix @ prolongation))
                return
        self._factor = _factor(matrix)

    def solve(
        self, right: Complex128[np.ndarray, "n"], *, start: Complex128[np.ndarray, "n"] | None = None, tolerance: float
    ) -> Complex128[np.ndarray, "n"]:
        """The solution, to ``tolerance`` times the length of the right-hand side; exact to rounding where factored."""
        if self._prolongation is None:
            return self._factor(right)
        return _conjugate_gradients(self, right, np.zeros_like(right) if start is None else start, tolerance)

    def smallest(
        self, mass: Float64[np.ndarray, "n"], part: Int32[np.ndarray, "n"], start: Complex128[np.ndarray, "n"]
    ) -> Complex128[np.ndarray, "n"]:
        """The smoothest vector of every part: the eigenvector of least energy for the given mass, of unit length.

        Inverse iteration from ``start``, first on the coarsest level; its energy is within a few percent of the least.
        Among equally smooth vectors the result is near the one nearest to ``start``.
        """
        if self._prolongation is None:
            return iterated_inverse(self._factor, start, mass=mass, part=part, steps=_INVERSE_STEPS)
        first = np.full(self._lumps, len(part), np.int64)
        columns, rows = _entries(self._prolongation)
        np.minimum.at(first, columns, rows)
        coarse_mass = np.abs(self._restriction) ** 2 @ mass
        coarse = self._coarse.smallest(coarse_mass, part[first], (self._restriction @ (mass * start)) / coarse_mass)
        return self._iterate(self._prolongation @ coarse, mass, part, _REFINING_STEPS)

    def cycle(self, right: Complex128[np.ndarray, "n"]) -> Complex128[np.ndarray, "n"]:
        """One V-cycle from zero: nearly the solution, and a fixed Hermitian function of the right-hand side."""
        if self._prolongation is None:
            return self._factor(right)
        step = _DAMPING / self._diagonal
        value = step * right
        for _ in range(_SWEEPS - 1):
            value = value + step * (right - self.matrix @ value)
        residual = self._restriction @ (right - self.matrix @ value)
        value = value + self._prolongation @ self._coarse.cycle(residual)
        for _ in range(_SWEEPS):
            value = value + step * (right - self.matrix @ value)
        return value

    def _iterate(
        self, vector: Complex128[np.ndarray, "n"], mass: Float64[np.ndarray, "n"], part: np.ndarray, steps: int
    ) -> Complex128[np.ndarray, "n"]:
        """Inverse power iteration, every part at unit length of its own."""
        vector = normalized(vector, mass, part)
        for _ in range(steps):
            energy = max(_dot(vector, self.matrix @ vector).real / _dot(vector, mass * vector).real, 1e-300)
            right = mass * vector
            vector = normalized(self.solve(right, start=vector / energy, tolerance=1e-3), mass, part)
        return vector


def principal_block(matrix: "csr_array", where: Bool[np.ndarray, "n"]) -> "csr_array":
    """The rows and columns of the marked unknowns."""
    return matrix if where.all() else matrix[where][:, where].tocsr()


def plus_diagonal(matrix: "csr_array", diagonal: Float64[np.ndarray, "n"]) -> "csr_array":
    """The matrix with numbers added to its diagonal."""
    from scipy.sparse import csr_array, diags_array

    return csr_array(matrix + diags_array(diagonal, format="csr"))


def one_thread() -> AbstractContextManager[object]:
    """BLAS at one thread: its pool only slows the small blocks of a sparse factorisation down."""
    controller = _blas_controller("scipy.linalg" in sys.modules)
    return nullcontext() if controller is None else controller.limit(limits=1, user_api="blas")


@cache
def _blas_controller(scipy_loaded: bool) -> Any:
    """Finding the BLAS libraries takes as long as a small solve, so once, and again when SciPy has brought its own."""
    try:
        from threadpoolctl import ThreadpoolController
    except ImportError:
        return None
    return ThreadpoolController()


def _factor(matrix: "csr_array") -> Callable[[np.ndarray], np.ndarray]:
    """The solving function of a small matrix."""
    from scipy.sparse.linalg import splu

    with one_thread():
        # Columns one by one: a surface's factors have few columns alike, and panels of them only cost
        return splu(
            matrix.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            relax=1,
            panel_size=1,
            options={"SymmetricMode": True},
        ).solve


def _conjugate_gradients(
    system: Multigrid, right: np.ndarray, value: np.ndarray, tolerance: float
) -> Complex128[np.ndarray, "n"]:
    """Preconditioned conjugate gradients (Saad 2003, algorithm 9.1), from ``value``."""
    goal = tolerance * np.sqrt(_dot(right, right).real)
    residual = right - system.matrix @ value
    search, previous = np.zeros_like(right), 1.0
    for _ in range(_MOST_STEPS):
        if np.sqrt(_dot(residual, residual).real) <= goal:
            break
        preconditioned = system.cycle(residual)
        current = _dot(residual, preconditioned).real
        search = preconditioned + (current / previous) * search
        image = system.matrix @ search
        step = current / _dot(search, image).real
        value = value + step * search
        residual = residual - step * image
        previous = current
    return value


def _prolongation(matrix: "csr_array", diagonal: Float64[np.ndarray, "n"]) -> tuple["csr_array", int]:
    """Lumps to unknowns, and the number of lumps.

    Constant over a lump up to the connection's turns, then smoothed by one Jacobi step.
    """
    from scipy.sparse import csr_array, diags_array

    strong = _strong_part(matrix, diagonal)
    lump, turn = _lumps(strong, _independent_set(strong))
    count, lumps = len(lump), int(lump.max()) + 1
    plain = csr_array((turn, lump, np.arange(count + 1)), shape=(count, lumps))
    return csr_array(plain - diags_array(_DAMPING / diagonal) @ (matrix @ plain)), lumps


def _strong_part(matrix: "csr_array", diagonal: Float64[np.ndarray, "n"]) -> "csr_array":
    """The couplings worth lumping along, with the diagonal."""
    from scipy.sparse import csr_array

    columns, rows = _entries(matrix)
    bound = _STRONG * np.sqrt(diagonal)
    keep = (np.abs(matrix.data) > bound[rows] * np.sqrt(diagonal)[columns]) | (rows == columns)
    starts = np.concatenate([[0], np.cumsum(np.bincount(rows[keep], minlength=len(diagonal)))])
    return csr_array((matrix.data[keep], columns[keep], starts), shape=matrix.shape)


def _independent_set(graph: "csr_array") -> Bool[np.ndarray, "n"]:
    """Unknowns more than two couplings apart, as many as fit; ranks by hash decide, so that no order shows."""
    count = len(graph.indptr) - 1
    rank = np.empty(count, np.int64)
    rank[draws.permutation(0, count=count)] = np.arange(count)
    chosen, undecided = np.zeros(count, bool), np.ones(count, bool)
    while undecided.any():
        key = np.where(chosen, count + rank, np.where(undecided, rank, -1))
        strongest = _neighbourhood_max(graph, _neighbourhood_max(graph, key))
        chosen |= undecided & (strongest == rank)
        undecided &= (strongest < count) & ~chosen
    return chosen


def _neighbourhood_max(graph: "csr_array", key: np.ndarray) -> np.ndarray:
    return np.maximum.reduceat(key[graph.indices], graph.indptr[:-1])


def _lumps(graph: "csr_array", root: Bool[np.ndarray, "n"]) -> tuple[np.ndarray, Complex128[np.ndarray, "n"]]:
    """The lump of every unknown, and its frame's turn against the root's: two rounds of joining, outwards from roots.

    Everyone joins along its strongest coupling to a neighbour that already belongs.
    """
    lump = np.where(root, np.cumsum(root) - 1, -1)
    turn = root.astype(complex)
    columns, rows = _entries(graph)
    strength = np.abs(graph.data)
    for _joining in range(2):
        joinable = np.flatnonzero((lump[rows] < 0) & (lump[columns] >= 0))
        best = joinable[np.lexsort((strength[joinable], rows[joinable]))]
        last = np.append(rows[best][1:] != rows[best][:-1], True)[: len(best)]
        best = best[last]
        lump[rows[best]] = lump[columns[best]]
        turn[rows[best]] = np.negative(graph.data[best]) / strength[best] * turn[columns[best]]
    alone = np.flatnonzero(lump < 0)  # couplings that rounding left strong one way only
    lump[alone], turn[alone] = np.count_nonzero(root) + np.arange(len(alone)), 1.0
    return lump, turn


def _entries(matrix: "csr_array") -> tuple[np.ndarray, np.ndarray]:
    """Column and row of every stored entry."""
    return matrix.indices, np.repeat(np.arange(len(matrix.indptr) - 1), np.diff(matrix.indptr))


def _dot(a: np.ndarray, b: np.ndarray) -> complex:
    """Inner product, by NumPy's own summation: BLAS would split it over its threads."""
    return complex((np.conj(a) * b).sum())
