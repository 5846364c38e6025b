"""Nested even point sets on a mesh, each with its own triangulation on the surface."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Float64, Int32

from texloom.errors import MeshError, ParameterError
from texloom.kernels.launch import launch
from texloom.kernels.points import settle
from texloom.mesh.mesh import Mesh
from texloom.mesh.split import split
from texloom.points.ground import Ground, bare_ground
from texloom.points.levels import lay, refined
from texloom.points.tiling import Tiling
from texloom.progress import Report, silent

_FEWEST = 4  # points: a tetrahedron
_MOST = 16_000_000  # points: beyond, the number was surely meant otherwise


@dataclass(frozen=True, eq=False)
class Level:
    """Points on a mesh, first those of the coarser level, and their triangulation.

    A point is a place in a face of the mesh. ``mesh`` has the points as vertices, oriented as the mesh is, and its
    parts, handles and boundaries. ``on_coarser`` places every point on the mesh of the coarser level.
    """

    face: Int32[np.ndarray, "point"]
    barycentric: Float64[np.ndarray, "point 3"]
    normal: Float64[np.ndarray, "point 3"]  # unit
    scale: Float64[np.ndarray, "point"]  # spacing here is proportional to it
    spacing: float  # world units between points in a triangular lattice, at scale 1
    mesh: Mesh
    on_coarser: tuple[Int32[np.ndarray, "point"], Float64[np.ndarray, "point 3"]] | None = None  # face, barycentric

    @property
    def count(self) -> int:
        """Points."""
        return len(self.face)

    @property
    def position(self) -> Float64[np.ndarray, "point 3"]:
        """World units."""
        return self.mesh.vertices

    @cached_property
    def nearest(self) -> Float64[np.ndarray, "point"]:
        """Distance of every point to the nearest of its neighbours in the triangulation, over the scale there.

        Straight distances: around the border of a sheet thinner than the spacing, less than on the surface.
        """
        lengths = self.mesh.edge_lengths / self.scale[self.mesh.edges].mean(axis=1)
        nearest = np.full(self.count, np.inf)
        for end in (0, 1):
            np.minimum.at(nearest, self.mesh.edges[:, end], lengths)
        return nearest

    @property
    def variation(self) -> float:
        """Coefficient of variation of ``nearest``: 0 in a lattice, 0.5 for random points."""
        return float(self.nearest.std() / self.nearest.mean())

    @property
    def closest(self) -> float:
        """The least of ``nearest`` over its mean."""
        return float(self.nearest.min() / self.nearest.mean())


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """Levels of points on a mesh, coarsest first."""

    surface: Mesh
    levels: tuple[Level, ...]


def hierarchy(
    mesh: Mesh,
    counts: Sequence[int],
    *,
    scale: Float[np.ndarray, "vertex"] | None = None,
    seed: int = 0,
    report: Report = silent,
) -> Hierarchy:
    """Even points on a mesh, ``counts`` of them on each level; the points of a level stay in all finer ones.

    Points repel their neighbours on the surface (Turk 1991), those of a boundary along it; sharp corners of boundaries
    keep theirs, and on a finer level only the new ones move. Distances are proportional to ``scale``, one number a
    vertex. The triangulation moves along and flips towards Delaunay; it keeps the mesh's topology, however near to each
    other two sheets come. A mesh that is not manifold is parted first. About 10 µs a point.

    Departures from the talk: points start in the middles of edges rather than at random, and repel neighbours in the
    triangulation rather than all within a radius.

    Raises: ParameterError, for counts that do not rise, or too few for the parts, holes and handles of the mesh;
    MeshError, for a mesh without area.
    """
    ground = _ground(mesh, _checked(mesh, counts, scale))
    levels: list[Level] = []
    tiling: Tiling | None = None
    for number, count in enumerate(counts):
        report("points", number / len(counts))
        tiling = lay(ground, count, seed=seed) if tiling is None else refined(tiling, count, seed=seed)
        levels.append(_level(tiling, count, levels[-1] if levels else None))
    report("points", 1.0)
    return Hierarchy(mesh, tuple(levels))


def _checked(
    mesh: Mesh, counts: Sequence[int], scale: Float[np.ndarray, "vertex"] | None
) -> Float64[np.ndarray, "vertex"]:
    """The scale at every vertex, after a look at all that was given."""
    if len(counts) == 0:
        raise ParameterError("no level was asked for: give the number of points of each, as in (4000, 16000)")
    if min(counts) < _FEWEST or max(counts) > _MOST:
        wrong = next(count for count in counts if not _FEWEST <= count <= _MOST)
        raise ParameterError(f"a level of {wrong} points: give from {_FEWEST} to {_MOST}")
    if any(finer <= coarser for coarser, finer in zip(counts, counts[1:], strict=False)):
        raise ParameterError(f"levels of {', '.join(map(str, counts))} points: give rising numbers, the coarsest first")
    if not mesh.face_areas.sum() > 0:
        raise MeshError(f"the mesh has {len(mesh.faces)} faces but no area: there is no room for points")
    if scale is None:
        return np.ones(len(mesh.vertices))
    if np.shape(scale) != (len(mesh.vertices),) or not (np.isfinite(scale) & (np.asarray(scale) > 0)).all():
        raise ParameterError(
            f"the scale must be {len(mesh.vertices)} positive numbers, one for each vertex of the mesh"
        )
    return np.asarray(scale, np.float64)


def _ground(mesh: Mesh, scale: Float64[np.ndarray, "vertex"]) -> Ground:
    """The mesh, made manifold where it is not: the triangulation of points is a surface. Its faces are the same."""
    parted = split(mesh)
    if np.array_equal(parted.faces, mesh.faces):
        return Ground(mesh, scale)
    return Ground(Mesh(mesh.vertices[parted.origin], parted.faces), scale[parted.origin])


def _level(tiling: Tiling, count: int, coarser: Level | None) -> Level:
    """What is kept of a triangulation."""
    places, mesh = tiling.places, tiling.mesh()
    return Level(
        face=places.face.copy(),
        barycentric=places.barycentric.copy(),
        normal=places.normal.copy(),
        scale=places.scale.copy(),
        spacing=tiling.ground.spacing(count),
        mesh=mesh,
        on_coarser=None if coarser is None else _places_on(coarser, mesh),
    )


def _places_on(coarser: Level, mesh: Mesh) -> tuple[Int32[np.ndarray, "point"], Float64[np.ndarray, "point 3"]]:
    """The nearest place on the coarser level's mesh, from the face of a coarse point that is near on the surface."""
    below = coarser.mesh
    near = _near(mesh, coarser.count)
    corner = np.empty(coarser.count, np.int32)
    corner[below.faces.reshape(-1)[::-1]] = np.arange(below.faces.size, dtype=np.int32)[::-1]
    face, barycentric = np.empty(len(near), np.int32), np.empty((len(near), 3))
    origin = below.vertices.mean(axis=0)
    bare = bare_ground(below.vertices - origin, below.faces, below.twins)
    inputs = [bare, mesh.vertices - origin, corner[near] // 3]
    launch(settle, len(near), inputs=inputs, outputs=[face, barycentric])
    face[: coarser.count] = corner // 3
    barycentric[: coarser.count] = np.eye(3)[corner % 3]
    return face, barycentric


def _near(mesh: Mesh, count: int) -> Int32[np.ndarray, "point"]:
    """For every vertex one of the first ``count``, few edges away: the nearest of those its neighbours have."""
    near = np.full(len(mesh.vertices), -1, np.int32)
    near[:count] = np.arange(count, dtype=np.int32)
    tails, heads = np.concatenate([mesh.edges, mesh.edges[:, ::-1]]).T
    while (near < 0).any():
        usable = (near[tails] >= 0) & (near[heads] < 0)
        if not usable.any():
            near[near < 0] = 0  # a part without coarse points
            break
        source, target = near[tails[usable]], heads[usable]
        apart = np.linalg.norm(mesh.vertices[source] - mesh.vertices[target], axis=1)
        order = np.lexsort((source, apart, target))
        target, source = target[order], source[order]
        first = np.append(True, target[1:] != target[:-1])
        near[target[first]] = source[first]
    return near
