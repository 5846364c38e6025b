"""Turning faces over until neighbours agree."""

import numpy as np
from jaxtyping import Bool

from texloom.mesh.mesh import Mesh


def orient(mesh: Mesh) -> Bool[np.ndarray, "face"]:
    """Which faces to turn over so that faces agree across every edge of two faces.

    A part that already agrees is left as it is. One that does not keeps the side most of its faces show, or shows
    its outside if it is closed. Edges of three faces and more tie nothing together.
    """
    first, second, opposite = mesh.edge_pairs
    if opposite.all():
        return np.zeros(len(mesh.faces), bool)
    first, second, disagree = first // 3, second // 3, ~opposite
    side, twin_side = _sides(len(mesh.faces), first, second, disagree)
    one_sided = side == twin_side
    flip = ~_kept_side(mesh.vertices, mesh.faces, first, second, side, twin_side)
    flip[one_sided] = _spread(len(mesh.faces), first, second, disagree, np.flatnonzero(one_sided))
    return flip


def _sides(count: int, first: np.ndarray, second: np.ndarray, disagree: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Part of each face as it is, and turned over, in the two-sheeted cover: nodes ``f`` and ``f + count``.

    Faces that agree are joined on the same sheet, others across; a one-sided part is joined to its own other side.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    across = np.where(disagree, count, 0)
    rows = np.concatenate([first, first + count])
    columns = np.concatenate([second + across, second + count - across])
    cover = coo_array((np.ones(len(rows), bool), (rows, columns)), shape=(2 * count, 2 * count))
    labels = connected_components(cover, directed=False)[1]
    return labels[:count], labels[count:]


def _kept_side(
    vertices: np.ndarray,
    faces: np.ndarray,
    first: np.ndarray,
    second: np.ndarray,
    side: np.ndarray,
    twin_side: np.ndarray,
) -> np.ndarray:
    """Whether each face, as it is, lies on the sheet its part keeps; ties keep the part's lowest face as it is."""
    sheets = int(max(side.max(), twin_side.max())) + 1
    shown = np.bincount(side, minlength=sheets)
    hidden = np.bincount(twin_side, minlength=sheets)  # faces of the part that would have to be turned over
    gain = (shown - hidden).astype(np.float64)

    # Closed parts that disagree with themselves: outside out
    sides_met = np.bincount(np.concatenate([first, second]), minlength=len(faces))
    is_open = np.bincount(side, weights=sides_met < 3, minlength=sheets)
    is_open += np.bincount(twin_side, weights=sides_met < 3, minlength=sheets)
    corners = vertices[faces] - vertices[faces].mean(axis=(0, 1))
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    volume = np.bincount(side, weights=volumes, minlength=sheets)
    volume -= np.bincount(twin_side, weights=volumes, minlength=sheets)
    mixed = (shown > 0) & (hidden > 0) & (is_open == 0)
    gain = np.where(mixed, volume, gain)

    lower = side < twin_side  # components are numbered by their lowest node, the lowest face as it is
    return (gain[side] > 0) | ((gain[side] == 0) & lower)


def _spread(count: int, first: np.ndarray, second: np.ndarray, disagree: np.ndarray, members: np.ndarray) -> np.ndarray:
    """Flips for one-sided parts, passed on breadth-first from the lowest face of each: few edges are left to cut."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    signs = np.where(disagree, 2.0, 1.0)
    graph = coo_array((signs, (first, second)), shape=(count, count)).tocsr()
    graph = graph.maximum(graph.T).tocsr()
    flip = np.zeros(count, bool)
    reached = np.zeros(count, bool)
    for root in members:
        if reached[root]:
            continue
        order, parents = breadth_first_order(graph, root, directed=False)
        reached[order] = True
        tied = graph[parents[order[1:]], order[1:]] == 2.0
        for face, parent, turned in zip(order[1:], parents[order[1:]], np.asarray(tied).ravel(), strict=True):
            flip[face] = flip[parent] ^ turned
    return flip[members]
