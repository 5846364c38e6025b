"""Splitting edges until none is longer than wanted; the surface stays what it was."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int32

from texloom.errors import MeshError
from texloom.mesh.mesh import Mesh, edge_runs

_SHORTEST_SPLIT = 0.6  # of the longest side of its faces: a side is split only when it is among the long ones
_MOST_PASSES = 64  # a double cannot be halved more often and still change
_MOST_VERTICES = 50_000_000  # beyond, the length was surely meant otherwise


@dataclass(frozen=True, eq=False)
class Refined:
    """A finer mesh of the same surface, and where it lies on the coarse one (the parent)."""

    mesh: Mesh
    parent: Int32[np.ndarray, "face"]  # face of the coarse mesh, increasing
    corner_barycentric: Float32[np.ndarray, "face 3 3"]  # of each corner in its parent face; exact binary fractions
    vertex_parent_face: Int32[np.ndarray, "vertex"]  # one of the coarse faces a vertex lies in, the lowest
    vertex_barycentric: Float32[np.ndarray, "vertex 3"]


@dataclass(frozen=True, eq=False)
class _Faces:
    """Faces in the making."""

    vertices: np.ndarray  # (face, 3)
    barycentric: np.ndarray  # (face, 3, 3)
    parent: np.ndarray  # (face,)

    def __getitem__(self, chosen: np.ndarray) -> "_Faces":
        return _Faces(*(np.take(part, chosen, axis=0) for part in (self.vertices, self.barycentric, self.parent)))


def refine(mesh: Mesh, length: float | Float[np.ndarray, "vertex"]) -> Refined:
    """Split edges longer than ``length`` (world units; one for all, or one a vertex) until none is.

    Every pass halves the edges that are too long and not much shorter than the longest of their faces, so that
    thin faces are first cut across. A face between split edges becomes two, three or four; neighbours share the middle
    of their edge, so no crack opens. The first vertices are those of ``mesh``; faces keep the order of their parents.

    Raises: MeshError, if the result would be beyond any memory.
    """
    target = np.asarray(length, np.float64)
    expected = estimate_sites(mesh, length)
    if expected > _MOST_VERTICES:
        raise MeshError(
            f"refining edges to {float(target.min()):.3g} would need about {expected:.3g} vertices "
            f"(the mesh measures {mesh.diagonal:.3g}): choose a larger texel or fewer repeats"
        )
    count = len(mesh.faces)
    corners = np.broadcast_to(np.eye(3, dtype=np.float32), (count, 3, 3))
    active = _Faces(mesh.faces, corners, np.arange(count, dtype=np.int32))
    vertices = mesh.vertices
    done: list[_Faces] = []
    for _ in range(_MOST_PASSES):
        squared = _squared_sides(vertices, active.vertices)
        too_long = squared > _side_targets(target, active.vertices) ** 2
        is_busy = np.any(too_long, axis=1)
        busy = np.flatnonzero(is_busy)
        if len(busy) == 0:
            break
        if len(busy) < len(active.parent):
            done.append(active[np.flatnonzero(~is_busy)])
            active, too_long, squared = active[busy], too_long[busy], squared[busy]
        active, vertices, target = _split_pass(active, too_long, squared, vertices, target)
    if len(vertices) == len(mesh.vertices):
        return _refined(mesh, active)
    faces = _together([*done, active])
    faces = faces[np.argsort(faces.parent, kind="stable")]
    return _refined(Mesh(vertices, faces.vertices), faces)


def estimate_sites(mesh: Mesh, length: float | Float[np.ndarray, "vertex"]) -> int:
    """About how many vertices ``refine`` would return, without doing it; within a third, more on thin faces."""
    target = np.asarray(length, np.float64)
    if not (target > 0).all():
        raise MeshError(f"edges cannot be refined to a length of {float(target.min()):g}")
    ratio = np.sqrt(_squared_sides(mesh.vertices, mesh.faces)) / _side_targets(target, mesh.faces)
    ratio = np.sort(ratio, axis=1)
    parts = 2.0 ** np.ceil(np.log2(np.maximum(ratio, 1.0)))  # each edge is halved until short enough
    children = parts[:, 1] * (parts[:, 0] + parts[:, 2]) / 2
    return int(len(mesh.vertices) + (children.sum() - len(mesh.faces)) / 2)


def _refined(mesh: Mesh, faces: _Faces) -> Refined:
    """With the parent of every vertex: that of its lowest corner (written last, so it stays)."""
    vertex_parent = np.zeros(len(mesh.vertices), np.int32)
    barycentric = np.zeros((len(mesh.vertices), 3), np.float32)
    corners = faces.vertices.reshape(-1)[::-1]
    vertex_parent[corners] = np.repeat(faces.parent, 3)[::-1]
    barycentric[corners] = faces.barycentric.reshape(-1, 3)[::-1]
    return Refined(mesh, faces.parent, faces.barycentric, vertex_parent, barycentric)


def _squared_sides(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Squared length of the side from each corner to the next; both faces of an edge find the same."""
    squared = np.zeros(faces.shape)
    for axis in range(3):
        corners = np.take(np.ascontiguousarray(vertices[:, axis]), faces)
        for side in range(3):
            squared[:, side] += (corners[:, (side + 1) % 3] - corners[:, side]) ** 2
    return squared


def _side_targets(target: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Wanted length of each side, the mean of its ends; one number where all are wanted alike."""
    if target.ndim == 0:
        return target
    corners = target[faces]
    return 0.5 * (corners + corners[:, [1, 2, 0]])


def _together(parts: list[_Faces]) -> _Faces:
    """One after the other."""
    return _Faces(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.barycentric for part in parts]),
        np.concatenate([part.parent for part in parts]),
    )


def _split_pass(
    faces: _Faces, too_long: np.ndarray, squared: np.ndarray, vertices: np.ndarray, target: np.ndarray
) -> tuple[_Faces, np.ndarray, np.ndarray]:
    """Halve the long sides of some faces once; returns their children and all vertices with their targets."""
    order, starts, counts = edge_runs(faces.vertices)
    split = _long_among_neighbours(too_long, squared, order, starts)
    leads = order[starts[split]]
    tails = faces.vertices.reshape(-1)[leads]
    heads = faces.vertices.reshape(-1)[_next(leads)]
    number = np.full(len(starts), -1, np.int32)
    number[split] = np.arange(len(vertices), len(vertices) + len(leads), dtype=np.int32)
    middles = np.empty(faces.vertices.size, np.int32)
    middles[order] = np.repeat(number, counts)
    vertices = np.concatenate([vertices, 0.5 * (vertices[tails] + vertices[heads])])
    if target.ndim:
        target = np.concatenate([target, 0.5 * (target[tails] + target[heads])])
    return _children(faces, middles.reshape(-1, 3), vertices), vertices, target


def _long_among_neighbours(
    too_long: np.ndarray, squared: np.ndarray, order: np.ndarray, starts: np.ndarray
) -> np.ndarray:
    """Edges to split: too long, and among the longest sides of each of their faces."""
    reach = np.repeat(squared.max(axis=1), 3)
    longest = np.maximum.reduceat(reach[order], starts)
    lead = order[starts]
    return too_long.reshape(-1)[lead] & (squared.reshape(-1)[lead] >= _SHORTEST_SPLIT**2 * longest)


def _children(faces: _Faces, middles: np.ndarray, vertices: np.ndarray) -> _Faces:
    """Cut each face at the middles of its split sides (-1: not split)."""
    split = middles >= 0
    number = split.sum(axis=1)
    parts = [faces[np.flatnonzero(number == 0)]]  # their long sides wait for a longer one next door
    for count, cut in ((1, _into_two), (2, _into_three), (3, _into_four)):
        chosen = np.flatnonzero(number == count)
        if len(chosen):
            parts.append(cut(faces[chosen], middles[chosen], vertices))
    return _together(parts)


def _into_two(faces: _Faces, middles: np.ndarray, vertices: np.ndarray) -> _Faces:
    """Bisect: turned so that the split side comes first, ``a m c`` and ``m b c``."""
    points, places = _turned(faces, middles, np.argmax(middles >= 0, axis=1))
    return _cut(points, places, faces.parent, [[0, 3, 2], [3, 1, 2]])


def _into_three(faces: _Faces, middles: np.ndarray, vertices: np.ndarray) -> _Faces:
    """Cut off the corner between the two split sides, and the rest along its shorter diagonal."""
    whole_side = np.argmin(middles >= 0, axis=1)
    points, places = _turned(faces, middles, (whole_side + 1) % 3)  # split: a-b (m = 3) and b-c (n = 4)
    ends = np.take(vertices, points, axis=0)
    to_c = ((ends[:, 3] - ends[:, 2]) ** 2).sum(axis=1)
    to_a = ((ends[:, 4] - ends[:, 0]) ** 2).sum(axis=1)
    through_c = to_c <= to_a
    halves = [
        _cut(points[through_c], places[through_c], faces.parent[through_c], [[3, 1, 4], [0, 3, 2], [3, 4, 2]]),
        _cut(points[~through_c], places[~through_c], faces.parent[~through_c], [[3, 1, 4], [0, 3, 4], [0, 4, 2]]),
    ]
    return _together(halves)


def _into_four(faces: _Faces, middles: np.ndarray, vertices: np.ndarray) -> _Faces:
    """Three corners and the middle."""
    points = np.concatenate([faces.vertices, middles], axis=1)
    places = _with_middles(faces.barycentric)
    return _cut(points, places, faces.parent, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])


def _turned(faces: _Faces, middles: np.ndarray, first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Six points of each face, from corner ``first`` on: corners 0 1 2, then the middles 3 4 5 of their sides."""
    turn = (first[:, None] + np.arange(3)) % 3
    corners = np.take_along_axis(faces.barycentric, turn[:, :, None], axis=1)
    points = np.concatenate(
        [np.take_along_axis(faces.vertices, turn, axis=1), np.take_along_axis(middles, turn, axis=1)], axis=1
    )
    return points, _with_middles(corners)


def _with_middles(corners: np.ndarray) -> np.ndarray:
    """Three corners and the middles of their sides."""
    places = np.empty((len(corners), 6, 3), corners.dtype)
    places[:, :3] = corners
    for side in range(3):
        places[:, 3 + side] = 0.5 * (corners[:, side] + corners[:, (side + 1) % 3])
    return places


def _cut(points: np.ndarray, places: np.ndarray, parent: np.ndarray, pattern: list[list[int]]) -> _Faces:
    """Children by a pattern of the six points; the children of a face stay together."""
    chosen = np.ravel(pattern)
    return _Faces(
        np.take(points, chosen, axis=1).reshape(-1, 3),
        np.take(places, chosen, axis=1).reshape(-1, 3, 3),
        np.repeat(parent, len(pattern)),
    )


def _next(halfedge: np.ndarray) -> np.ndarray:
    return halfedge - halfedge % 3 + (halfedge + 1) % 3
