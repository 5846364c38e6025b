"""The mesh itself as a triangulation of points, fine enough to choose from; points that must stay are put into it."""

import numpy as np
from jaxtyping import Float64, Int32

from texloom.kernels.launch import launch
from texloom.kernels.points import settle
from texloom.mesh.refine import Refined, refine
from texloom.points.ground import Ground, bare_ground
from texloom.points.places import Places
from texloom.points.tiling import Tiling, any_halfedge


def start(ground: Ground, length: float, *, bend: float, kept: Places) -> Tiling:
    """The ground with edges no longer than ``length`` (times the scale); the points that are kept come first in it.

    Each of those takes the place of a corner of the face it lies in, so ``length`` should be less than they are apart.
    """
    refined = refine(ground.mesh, length * ground.scale)
    mesh, places = refined.mesh, _places(ground, refined)
    rim = mesh.boundary_vertices.astype(np.int32)
    taken = _stand_ins(refined, kept, places.at)
    places.overwrite(taken, kept)
    rest = np.ones(len(rim), bool)
    rest[taken] = False
    order = np.concatenate([taken, np.flatnonzero(rest)])
    number = np.empty(len(rim), np.int32)
    number[order] = np.arange(len(rim), dtype=np.int32)
    faces, frozen = number[mesh.faces], len(taken)
    return Tiling(
        ground, places[order], faces, mesh.twins.copy(), any_halfedge(faces, len(rim)), rim[order], bend, frozen
    )


def _places(ground: Ground, refined: Refined) -> Places:
    """Where the refined mesh's vertices lie on the ground; those of a boundary on an edge of the boundary."""
    mesh = refined.mesh
    face, barycentric = refined.vertex_parent_face.copy(), refined.vertex_barycentric.astype(np.float64)
    side = np.full(len(face), -1, np.int32)
    outer = np.flatnonzero(mesh.twins < 0)
    child, corner = np.divmod(outer, 3)
    tails = mesh.faces.reshape(-1)[outer]
    ends = refined.corner_barycentric[child, corner] + refined.corner_barycentric[child, (corner + 1) % 3]
    face[tails], barycentric[tails] = refined.parent[child], refined.corner_barycentric[child, corner]
    side[tails] = (np.argmin(ends, axis=1) + 1) % 3  # opposite the corner that neither end has a part of
    scale = np.einsum("pc,pc->p", barycentric, ground.scale[ground.mesh.faces[face]])
    normal = ground.normals(face, barycentric)
    return Places(mesh.vertices - ground.origin, scale, normal, face, barycentric, side)


def _stand_ins(refined: Refined, kept: Places, at: Float64[np.ndarray, "vertex 3"]) -> Int32[np.ndarray, "point"]:
    """For every point a vertex of its own: a corner of the refined face it lies in, the nearest that is free.

    Points of a boundary take its vertices, others none of them, unless nothing else is left.
    """
    count = len(kept.face)
    corners, share = _containing(refined, kept, at)
    alike = refined.mesh.boundary_vertices[corners] == (kept.side >= 0)[:, None]
    wish = np.argsort(np.where(alike, -share, 2 - share), axis=1, kind="stable")
    taken = np.full(count, -1, np.int32)
    free = np.ones(len(refined.mesh.vertices), bool)
    for turn in range(3):
        waiting = np.flatnonzero(taken < 0)
        vertex = corners[waiting, wish[waiting, turn]]
        waiting, vertex = waiting[free[vertex]], vertex[free[vertex]]
        chosen, first = np.unique(vertex, return_index=True)
        taken[waiting[first]] = chosen
        free[chosen] = False
    rest = np.flatnonzero(taken < 0)
    taken[rest] = np.flatnonzero(free)[: len(rest)]
    return taken


def _containing(
    refined: Refined, kept: Places, at: Float64[np.ndarray, "vertex 3"]
) -> tuple[Int32[np.ndarray, "point 3"], Float64[np.ndarray, "point 3"]]:
    """Corners of the refined face that each point lies in, and its barycentric coordinates there."""
    children = np.searchsorted(refined.parent, kept.face).astype(np.int32)  # a face in the same plane to go from
    face, share = np.empty(len(kept.face), np.int32), np.empty((len(kept.face), 3))
    mesh = refined.mesh
    parent = np.repeat(refined.parent, 3)
    inside = np.where(parent == parent[mesh.twins], mesh.twins, -1).astype(np.int32)
    inputs = [bare_ground(at, mesh.faces, inside), kept.at, children]
    launch(settle, len(face), inputs=inputs, outputs=[face, share])
    return mesh.faces[face], share
