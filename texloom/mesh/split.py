"""Which faces stay joined at an edge, and the vertices that follow: the mesh made manifold."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Int32

from texloom.mesh.mesh import Mesh, edge_runs

_MOST_AROUND_AN_EDGE = 16  # faces; beyond, they are all parted


@dataclass(frozen=True, eq=False)
class Split:
    """Faces over new vertices, each new vertex one fan of corners; ``origin`` is the old vertex of each new one."""

    faces: Int32[np.ndarray, "face 3"]
    origin: Int32[np.ndarray, "vertex"]
    edges: int  # edges of three faces or more that were parted
    cuts: int  # edges whose two faces run the same way, parted too (one-sided parts)
    vertices: int  # vertices of several fans that lay on no such edge


def split(mesh: Mesh) -> Split:
    """Part faces where more than two meet, and give every fan of corners its own vertex.

    Of the faces around a crowded edge the flattest pairs that run opposite ways stay joined, ties to the lowest faces.
    """
    faces = mesh.faces
    if mesh.agrees and _one_fan_each(mesh):
        used = mesh.first_halfedges >= 0
        numbers = (np.cumsum(used) - 1).astype(np.int32)
        return Split(numbers[faces], np.flatnonzero(used).astype(np.int32), 0, 0, 0)
    twins, crowded, cut = _joined(mesh)
    fans = _fans(twins, faces)
    while crowded or cut:  # parted faces may still hang together at both ends of their edge
        doubled = _doubled_edges(fans, twins)
        if len(doubled) == 0:
            break
        _detach(twins, doubled)
        fans = _fans(twins, faces)
    origin = np.empty(fans.max() + 1, np.int32)
    origin[fans] = faces.reshape(-1)
    return Split(fans.reshape(-1, 3), origin, len(crowded), len(cut), _bowties(faces, origin, [*crowded, *cut]))


def _one_fan_each(mesh: Mesh) -> bool:
    """Whether walking around every vertex once meets all corners."""
    starts = int((mesh.first_halfedges >= 0).sum())
    return starts + sum(len(following) for _, following in mesh.fan_steps) == mesh.faces.size


def _joined(mesh: Mesh) -> tuple[np.ndarray, list[int], list[int]]:
    """Twin of every halfedge (-1: none), and a halfedge of each crowded edge and of each edge run the same way."""
    order, starts, counts = mesh.edge_runs
    twins = mesh.twins.copy()
    crowded = np.flatnonzero(counts > 2)
    for edge in crowded:
        around = np.sort(order[starts[edge] : starts[edge] + counts[edge]])
        if len(around) <= _MOST_AROUND_AN_EDGE:
            _join_flattest(twins, mesh.vertices, mesh.faces, around)
    first, _, opposite = mesh.edge_pairs
    return twins, [int(h) for h in order[starts[crowded]]], [int(h) for h in first[~opposite]]


def _join_flattest(twins: np.ndarray, vertices: np.ndarray, faces: np.ndarray, around: np.ndarray) -> None:
    """Join the halfedges of one edge two by two, the flattest pair first."""
    corners = vertices[faces[around // 3]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(np.float64).tiny)
    flatness = np.round(normals @ normals.T, 9)  # so that rounding does not decide a tie
    tails = faces.reshape(-1)[around]
    one, other = np.nonzero(np.triu(tails[:, None] != tails[None, :]))
    for pair in np.argsort(-flatness[one, other], kind="stable"):
        a, b = around[one[pair]], around[other[pair]]
        if twins[a] < 0 and twins[b] < 0:
            twins[a], twins[b] = b, a


def _fans(twins: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Number of the fan each corner belongs to, fans counted in the order of their old vertex, then corner."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    halfedge = np.flatnonzero(twins >= 0)  # its tail corner is the head corner of its twin
    rows, columns = halfedge, _next(twins[halfedge])
    graph = coo_array((np.ones(len(rows), bool), (rows, columns)), shape=(len(twins), len(twins)))
    count, labels = connected_components(graph, directed=False)
    first_corner = np.empty(count, np.int64)
    first_corner[labels[::-1]] = np.arange(len(twins))[::-1]  # the last written, the lowest, stays
    order = np.lexsort([first_corner, faces.reshape(-1)[first_corner]])
    rank = np.empty(count, np.int32)
    rank[order] = np.arange(count, dtype=np.int32)
    return rank[labels]


def _doubled_edges(fans: np.ndarray, twins: np.ndarray) -> np.ndarray:
    """Halfedges to detach: those that share both vertices with another they are not joined to, the lowest excepted."""
    order, starts, counts = edge_runs(fans.reshape(-1, 3))
    pair = np.flatnonzero(counts == 2)
    unjoined = pair[twins[order[starts[pair]]] != order[starts[pair] + 1]]
    surplus = []
    for edge in np.concatenate([np.flatnonzero(counts > 2), unjoined]):
        around = np.sort(order[starts[edge] : starts[edge] + counts[edge]])
        kept = {int(around[0]), int(twins[around[0]])}
        surplus += [h for h in around if int(h) not in kept and (twins[h] < 0 or h < twins[h])]
    return np.array(surplus, np.int64)


def _detach(twins: np.ndarray, halfedges: np.ndarray) -> None:
    """Cut the corner at the tail of each halfedge free from its fan, with its twin's side if it has one."""
    for halfedge in halfedges:
        before = int(_next(_next(halfedge)))  # the other halfedge at the same corner
        _cut(twins, before)
        if twins[halfedge] >= 0:
            _cut(twins, int(_next(twins[halfedge])))


def _cut(twins: np.ndarray, halfedge: int) -> None:
    """Part one halfedge from its twin."""
    if twins[halfedge] >= 0:
        twins[twins[halfedge]] = -1
        twins[halfedge] = -1


def _bowties(faces: np.ndarray, origin: np.ndarray, parted: list[int]) -> int:
    """Old vertices that became several, other than the ends of parted edges."""
    copies = np.bincount(origin, minlength=int(faces.max()) + 1)
    ends = np.array(parted, np.int64)
    copies[faces.reshape(-1)[ends]] = 1
    copies[faces.reshape(-1)[_next(ends)]] = 1
    return int((copies > 1).sum())


def _next(halfedge: Any) -> Any:
    """The next halfedge of the same face, of one or of an array of them."""
    return halfedge - halfedge % 3 + (halfedge + 1) % 3
