"""Distances along the surface."""

from typing import Any

import numpy as np
from jaxtyping import Float64, Int

from texloom.errors import ParameterError
from texloom.mesh.mesh import Mesh


class GeodesicDistances:
    """Distances from any vertices of one mesh by the heat method (Crane et al. 2013), factorized once a part.

    The error falls with the edge length; 100 k vertices take about 2 s to set up and 0.1 s a question.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._mesh = mesh
        self._solvers: dict[int, tuple[Any, np.ndarray]] = {}

    def from_vertices(self, sources: Int[np.ndarray, "source"] | int) -> Float64[np.ndarray, "vertex"]:
        """Distance of every vertex to the nearest source, in world units; infinite where there is no way.

        Raises: ParameterError, if a source is no vertex.
        """
        sources = np.unique(np.atleast_1d(np.asarray(sources, np.int64)))
        count = len(self._mesh.vertices)
        if len(sources) and (sources[0] < 0 or sources[-1] >= count):
            wrong = int(sources[0] if sources[0] < 0 else sources[-1])
            raise ParameterError(f"distance from vertex {wrong} (counted from 0): the mesh has {count} vertices")
        parts = self._mesh.vertex_parts
        distances = np.full(count, np.inf)
        for part in np.unique(parts[sources]):
            solver, members = self._solver(int(part))
            local = np.searchsorted(members, sources[parts[sources] == part])
            found = solver.compute_distance_multisource(local) * self._mesh.diagonal
            found -= found[local].min()
            found[local] = 0.0
            distances[members] = np.maximum(found, 0.0)
        return distances

    def _solver(self, part: int) -> tuple[Any, np.ndarray]:
        """The heat method on one part, and its vertices; positions are scaled to the size of the mesh."""
        if part not in self._solvers:
            import potpourri3d

            mesh = self._mesh
            members = np.flatnonzero(mesh.vertex_parts == part)
            number = np.full(len(mesh.vertices), -1, np.int32)
            number[members] = np.arange(len(members), dtype=np.int32)
            faces = number[mesh.faces[mesh.vertex_parts[mesh.faces[:, 0]] == part]]
            positions = (mesh.vertices[members] - mesh.vertices[members[0]]) / mesh.diagonal
            self._solvers[part] = potpourri3d.MeshHeatMethodDistanceSolver(positions, faces), members
        return self._solvers[part]


def distances(mesh: Mesh, sources: Int[np.ndarray, "source"] | int) -> Float64[np.ndarray, "vertex"]:
    """Distance of every vertex to the nearest source along the surface; ``GeodesicDistances`` for many questions."""
    return GeodesicDistances(mesh).from_vertices(sources)
