"""A surface in several resolutions: even points, each level twice as dense a row as the one before, and the ways up."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int32

from texloom.domain.neighbourhoods import Beside
from texloom.domain.surface import Surface
from texloom.errors import ParameterError
from texloom.field.direction import from_vectors
from texloom.kernels.launch import launch
from texloom.kernels.neighbourhoods import find_beside
from texloom.mesh.mesh import Mesh
from texloom.points.hierarchy import Hierarchy, Level, hierarchy
from texloom.progress import Report, silent

_DENSITY = 2 / np.sqrt(3)  # points a square texel, in a triangular lattice one texel apart
_FEWEST = 64  # points of the coarsest level


@dataclass(frozen=True, eq=False)
class Levels:
    """Domains of even points, the coarsest first; texels of each are twice as long as those of the next.

    ``onto[i]`` tells how the sites of the next finer domain lie beside those of ``domains[i]``; after the last come the
    sites of the surface itself, whose texels are as long.
    """

    domains: tuple[Surface, ...]
    onto: tuple[Beside, ...]


def lay_levels(surface: Surface, count: int, *, seed: int = 0, report: Report = silent) -> Levels:
    """``count`` levels or, on a surface that is small or has many parts, as many as have room. About 15 µs a site.

    Raises: ParameterError, unless ``count`` is 1 or more, or if even the finest has no room.
    """
    if count < 1:
        raise ParameterError(f"{count} levels: give 1 or more")
    finest = max(round(_DENSITY * float(surface.area.sum(dtype=np.float64))), _FEWEST)
    counts = [finest // 4**level for level in reversed(range(count)) if level == 0 or finest // 4**level >= _FEWEST]
    points = _points(surface, counts, seed=seed, report=report)
    counts = counts[-len(points.levels) :]
    laid = [_Laid.of(surface, level, 2.0 ** (len(counts) - 1 - number)) for number, level in enumerate(points.levels)]
    onto = [
        _beside(coarse.domain, fine.domain, coarse.site[_nearest_corner(coarser, level)][fine.point])
        for coarse, fine, coarser, level in zip(laid, laid[1:], points.levels, points.levels[1:], strict=False)
    ]
    home = _beside(laid[-1].domain, surface, laid[-1].site[_near_points(surface, points.levels[-1])])
    return Levels(tuple(each.domain for each in laid), (*onto, home))


def _points(surface: Surface, counts: list[int], *, seed: int, report: Report) -> Hierarchy:
    """Levels of so many points, without the coarsest where the mesh has too many parts, holes and handles for them."""
    try:
        scale = surface.scale.astype(np.float64)
        return hierarchy(surface.refined.mesh, counts, scale=scale, seed=seed, report=report)
    except ParameterError:
        if len(counts) == 1:
            raise
        return _points(surface, counts[1:], seed=seed, report=report)


@dataclass(frozen=True, eq=False)
class _Laid:
    """The points of a level as sites, numbered so that neighbours mostly lie near each other in memory."""

    domain: Surface
    point: Int32[np.ndarray, "site"]
    site: Int32[np.ndarray, "point"]

    @staticmethod
    def of(surface: Surface, level: Level, texels: float) -> "_Laid":
        """Sites ``texels`` texels of the surface apart, with its field."""
        mesh, field = surface.refined.mesh, surface.field
        point = _along_curve(level.position)
        site = np.empty_like(point)
        site[point] = np.arange(len(point), dtype=np.int32)
        faces = site[level.mesh.faces]
        own = Mesh(level.position[point], faces[np.argsort(faces.min(axis=1), kind="stable")])
        face, place = level.face[point], level.barycentric[point]
        power = np.einsum("pc,pc->p", place, field.power[face])
        axes, angle = mesh.face_frames[face], np.angle(power) / field.order
        along = np.cos(angle)[:, None] * axes[:, 0] + np.sin(angle)[:, None] * axes[:, 1]
        ours = from_vectors(own, field.order, along)
        scale = level.scale[point]
        return _Laid(Surface.build(own, ours, texel=surface.texel * texels, scale=scale, spacing=np.inf), point, site)


def _along_curve(places: Float64[np.ndarray, "point 3"]) -> Int32[np.ndarray, "point"]:
    """Points in the order of a Z-curve through space (Morton 1966), 1024 cells a side."""
    low = places.min(axis=0)
    cell = ((places - low) / max(float(np.ptp(places, axis=0).max()), 1e-300) * 1023).astype(np.int64)
    key = np.zeros(len(places), np.int64)
    for bit in range(10):
        for axis in range(3):
            key |= (cell[:, axis] >> bit & 1) << (3 * bit + axis)
    return np.argsort(key, kind="stable").astype(np.int32)


def _beside(domain: Surface, places: Surface, near: Int32[np.ndarray, "n"]) -> Beside:
    """How the sites of ``places`` lie beside those of ``domain``, found from sites that are near."""
    count = places.count
    site, offset, turn = np.empty(count, np.int32), np.empty((count, 2), np.float32), np.empty(count, np.float32)
    origin = domain.refined.mesh.vertices.mean(axis=0)
    there = [*domain.neighbours, domain.refined.mesh.vertices - origin, domain.direction, domain.normal]
    here = [places.refined.mesh.vertices - origin, places.direction, places.normal]
    launch(
        find_beside,
        count,
        inputs=[near, *(_floats(part) for part in (*there, domain.texel_length, *here))],
        outputs=[site, offset, turn],
    )
    order = domain.field.order
    branch = np.float32(2 * np.pi / order)
    return Beside(site, offset, np.zeros_like(turn) if order == 1 else np.rint(turn / branch) * branch)


def _floats(values: np.ndarray) -> np.ndarray:
    return values.astype(np.float32) if values.dtype == np.float64 else values


def _nearest_corner(coarser: Level, level: Level) -> Int32[np.ndarray, "point"]:
    """Of the coarse face that each point lies in, the nearest corner."""
    assert level.on_coarser is not None
    face, place = level.on_coarser
    return coarser.mesh.faces[face, place.argmax(axis=1)]


def _near_points(surface: Surface, level: Level) -> Int32[np.ndarray, "site"]:
    """For every site a point few edges away on the surface."""
    mesh, near = surface.refined.mesh, np.full(surface.count, -1, np.int32)
    near[mesh.faces[level.face]] = np.arange(level.count, dtype=np.int32)[:, None]
    tails, heads = np.concatenate([mesh.edges, mesh.edges[:, ::-1]]).T
    while (near < 0).any():
        usable = (near[tails] >= 0) & (near[heads] < 0)
        if not usable.any():
            near[near < 0] = 0  # a vertex without faces
        near[heads[usable]] = near[tails[usable]]
    return near
