"""The smoothest n-fold direction field: automatic, through arrows, or near given directions.

Smoothness is the energy of the connection Laplacian raised to the n-th power (Knöppel et al. 2013, §3 and §6, with
the plain edge energy in place of their finite elements). Boundaries are free. Every connected part of the mesh is
solved on its own: a part without arrows gets its smoothest field.
"""

from functools import cached_property

import numpy as np
from jaxtyping import Complex128, Float, Float64, Int

from texloom.errors import FieldError
from texloom.field.direction import DirectionField, check_order
from texloom.field.frames import VertexFrames
from texloom.field.laplacian import connection_laplacian
from texloom.field.multigrid import Multigrid, plus_diagonal, principal_block
from texloom.mesh.mesh import Mesh

_TOLERANCE = 1e-10  # of the right-hand side; far from its arrows a field fades by many powers of ten
_SHIFT = 1e-3  # over the area: lifts the energy of a perfectly parallel field off 0, far below any other's


def smoothest(mesh: Mesh, order: int) -> DirectionField:
    """The smoothest field of all, turned as a whole so that it stands as upright as it can (``direction.upright``).

    Raises: FieldError, if the symmetry is not 1, 2, 4 or 6.
    """
    return SmoothSolver(mesh, order).solve(np.empty((0, 3)))


def through_arrows(
    mesh: Mesh, order: int, *, vertices: Int[np.ndarray, "arrow"], directions: Float[np.ndarray, "arrow 3"]
) -> DirectionField:
    """The smoothest field that has the given directions at the given vertices. See ``SmoothSolver``."""
    return SmoothSolver(mesh, order, vertices).solve(directions)


def near(
    mesh: Mesh, order: int, *, power: Complex128[np.ndarray, "vertex"], weight: Float[np.ndarray, "vertex"]
) -> DirectionField:
    """The field that is both smooth and near given powers (in the polar angles of ``VertexFrames``).

    ``weight`` is 1 over the square of the length (world units) within which smoothness may override a power; 0 where
    nothing is known. A part that knows nothing gets its smoothest field.
    """
    solver = SmoothSolver(mesh, order)
    known = np.bincount(mesh.vertex_parts, weights=weight > 0)[mesh.vertex_parts] > 0
    value = np.empty(len(power), complex)
    if known.any():
        pull = (mesh.vertex_areas * weight)[known]
        system = Multigrid(plus_diagonal(principal_block(solver.laplacian, known), pull))
        value[known] = system.solve(pull * power[known], start=power[known], tolerance=_TOLERANCE)
    value[~known] = solver.automatic(~known)
    return solver.frames.field(value)


class SmoothSolver:
    """The smoothest field through arrows at fixed vertices: set up once, then solved for any directions there.

    Arrows are met exactly; several at one vertex are met in the mean of their powers. Setting up takes most of the
    time. Raises: FieldError, if the symmetry is not 1, 2, 4 or 6.
    """

    def __init__(self, mesh: Mesh, order: int, vertices: Int[np.ndarray, "arrow"] | None = None) -> None:
        check_order(order)
        self.frames = VertexFrames(mesh, order)
        self.vertices = np.asarray([] if vertices is None else vertices, np.int64)
        self.laplacian = connection_laplacian(self.frames.transport, order)
        self._fixed = np.zeros(len(mesh.vertices), bool)
        self._fixed[self.vertices] = True
        in_pinned_part = np.isin(mesh.vertex_parts, mesh.vertex_parts[self.vertices])
        self._free = in_pinned_part & ~self._fixed
        self._unpinned = ~in_pinned_part
        if self._free.any():
            self._system = Multigrid(principal_block(self.laplacian, self._free))

    def solve(self, directions: Float[np.ndarray, "arrow 3"]) -> DirectionField:
        """The field through these tangent vectors, one for each vertex the solver was set up with.

        Raises: FieldError, if arrows at one vertex cancel.
        """
        value = self._fixed_powers(directions)
        if self._free.any():
            right = -(self.laplacian @ value)[self._free]
            value[self._free] = self._system.solve(right, tolerance=_TOLERANCE)
        if self._unpinned.any():
            value[self._unpinned] = self._smoothest_of_unpinned
        return self.frames.field(value)

    def automatic(self, where: np.ndarray) -> Complex128[np.ndarray, "where"]:
        """Powers of the smoothest field of whole parts: those of the vertices marked by ``where``."""
        if not where.any():
            return np.empty(0, complex)
        mass = _safe_areas(self.frames.mesh)[where]
        part = np.unique(self.frames.mesh.vertex_parts[where], return_inverse=True)[1]
        area = np.bincount(part, weights=mass)[part]
        shifted = plus_diagonal(principal_block(self.laplacian, where), _SHIFT * mass / area)
        target = self.frames.upright_power[where]
        value = Multigrid(shifted).smallest(mass, part, target)
        # Every turn of the whole is as smooth: take the one nearest to upright
        overlap = mass * np.conj(value) * target
        total = np.bincount(part, weights=np.real(overlap)) + 1j * np.bincount(part, weights=np.imag(overlap))
        return value * np.exp(1j * np.angle(total))[part]

    @cached_property
    def _smoothest_of_unpinned(self) -> Complex128[np.ndarray, "unpinned"]:
        return self.automatic(self._unpinned)

    def _fixed_powers(self, directions: Float[np.ndarray, "arrow 3"]) -> Complex128[np.ndarray, "vertex"]:
        """Unit powers at the fixed vertices, 0 elsewhere."""
        if len(directions) != len(self.vertices):
            raise FieldError(f"{len(directions)} directions for {len(self.vertices)} arrows: give one for each")
        value = np.zeros(len(self._fixed), complex)
        np.add.at(value, self.vertices, self.frames.powers(self.vertices, directions))
        cancelled = np.flatnonzero(self._fixed & (np.abs(value) < 1e-6))
        if len(cancelled):
            raise FieldError(f"the arrows at vertex {cancelled[0]} cancel each other: keep one, or move them apart")
        value[self._fixed] /= np.abs(value[self._fixed])
        return value


def _safe_areas(mesh: Mesh) -> Float64[np.ndarray, "vertex"]:
    """Vertex areas, none of them 0."""
    areas = mesh.vertex_areas
    return np.maximum(areas, 1e-12 * max(areas.mean(), 1e-300))
