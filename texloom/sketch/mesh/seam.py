"""A cut bent until its opposite sides fit, and joined to a torus."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float64, Int

from texloom.sketch.bezier import bend, lines
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.cutting import Cut, Sides
from texloom.sketch.mesh.facets import faceted
from texloom.sketch.mesh.strands import carry, head_of, strands

_HALVINGS = 6
_FINE = 0.004  # texels from a chord to its curve where crossings are sought: the patch may be enlarged
_STRAIGHT = 1e-6  # texels of bend


def seamless(sketch: CellGraph, piece: Cut, *, inner: bool = True) -> CellGraph | None:
    """The torus of a cut whose sides match: vertices on either side of the seam meet half-way, the others follow.

    Eq. 5-6, with the crossings themselves among the vertices that lead. Where something would cross or flip, the
    vertices involved go half as far, and half again; None if that does not help, or nothing is there. With ``inner``
    False only crossings lead: for a drawing whose edges end at its border, beyond which no vertices are known.
    """
    if not len(piece.graph.edges):
        return None
    runs = strands(piece.graph)
    held, by = _half_way(sketch, piece, runs.free & inner)
    by = _follow(piece.graph.vertices, held, by)
    border = np.concatenate([side.vertex for pair in piece.sides for side in pair])
    by[border] = _meet(piece)[border]
    cells = piece.graph.cells()
    for _ in range(_HALVINGS):
        carried = carry(by, free=runs.free, edges=piece.graph.edges, ends=runs.ends, share=runs.share)
        bent = piece.graph.moved(piece.graph.vertices + carried)
        torus, seam = _joined(bent, piece.sides)
        wrong = np.concatenate([torus.crossings(), torus.crossings(_FINE)]).ravel()
        flipped = np.repeat(bent.flipped(cells), np.diff(cells.start))
        if not len(wrong) and not flipped.any():
            return faceted(_unbroken(torus, seam))
        edges = np.unique(np.concatenate([wrong, cells.halfedge[flipped] // 2]))
        damped = np.setdiff1d(runs.ends[edges].ravel(), border)
        if not len(damped):
            return None
        by[damped] /= 2
    return None


def mirrored(piece: Cut) -> CellGraph:
    """The torus of a cut and its three mirror images: always seamless, whatever crosses its sides."""
    graph, (rows, columns) = piece.graph, piece.graph.size
    images, vertices, edges, curves = [], [], [], []
    for flip in (0, 1, 2, 3):
        name = flip * len(graph.vertices) + np.arange(len(graph.vertices))
        for axis in (0, 1):
            if flip >> axis & 1:  # what lies on the mirror, and on the border opposite, is there once
                for side in piece.sides[axis]:
                    name[side.vertex] = images[flip ^ (1 << axis)][side.vertex]
        images.append(name)
        sign = np.array([1 - 2 * (flip & 1), 1 - 2 * (flip >> 1)])
        vertices.append(np.where(sign < 0, 2 * np.array([rows, columns]) - 1 - graph.vertices, graph.vertices))
        edges.append(name[graph.edges].astype(np.int32))
        curves.append(graph.curve * sign)
    whole = CellGraph(
        (2 * rows, 2 * columns), np.concatenate(vertices), np.concatenate(edges), np.concatenate(curves), True
    )
    return faceted(_compact(whole))


def _meet(piece: Cut) -> Float64[np.ndarray, "vertex 2"]:
    """What brings opposite crossings to the middle between their places along the sides."""
    by = np.zeros_like(piece.graph.vertices)
    for axis, (low, high) in enumerate(piece.sides):
        gap = piece.graph.vertices[high.vertex, 1 - axis] - piece.graph.vertices[low.vertex, 1 - axis]
        by[low.vertex, 1 - axis] = gap / 2
        by[high.vertex, 1 - axis] = -gap / 2
    return by


def _half_way(
    sketch: CellGraph, piece: Cut, free: Bool[np.ndarray, "vertex"]
) -> tuple[Int[np.ndarray, "held"], Float64[np.ndarray, "vertex 2"]]:
    """The vertices that lead, and half the way of each to its counterpart beyond the opposite side (their mean)."""
    by = _meet(piece)
    times = np.zeros(len(by))
    place = np.full(len(sketch.vertices), -1)
    place[piece.origin[piece.origin >= 0]] = np.flatnonzero(piece.origin >= 0)
    joint = sketch.degree != 1
    for axis, (low, high) in enumerate(piece.sides):
        times[np.concatenate([low.vertex, high.vertex])] = 1
        for side, other, shift in ((low, high, -1), (high, low, 1)):
            vertex = place[side.inner]
            known = (vertex >= 0) & joint[other.outer]
            known[known] = free[vertex[known]]
            target = sketch.vertices[other.outer[known]].copy()
            target[:, axis] += shift * piece.graph.size[axis]
            np.add.at(by, vertex[known], (target - sketch.vertices[side.inner[known]]) / 2)
            np.add.at(times, vertex[known], 1)
    return np.flatnonzero(times), by / np.maximum(times, 1)[:, None]


def _follow(
    vertices: Float64[np.ndarray, "vertex 2"], held: Int[np.ndarray, "held"], by: Float64[np.ndarray, "vertex 2"]
) -> Float64[np.ndarray, "vertex 2"]:
    """The displacements of all vertices: of those held their own, else the mean of these by inverse distance."""
    if not len(held):
        return by
    apart = vertices[:, None] - vertices[held]
    weight = 1 / np.maximum(np.hypot(apart[..., 0], apart[..., 1]), 1e-9)
    followed = weight @ by[held] / weight.sum(axis=1, keepdims=True)
    followed[held] = by[held]
    return followed


def _joined(graph: CellGraph, sides: Sides) -> tuple[CellGraph, Int[np.ndarray, "seam"]]:
    """The torus in which opposite crossings are one vertex, and those vertices."""
    name = np.arange(len(graph.vertices))
    for low, high in sides:
        name[high.vertex] = low.vertex
    torus = replace(graph, edges=name[graph.edges].astype(np.int32), wrap=True)
    seam = np.concatenate([low.vertex for low, _ in sides])
    return _compact(torus), np.searchsorted(np.unique(torus.edges), seam)


def _compact(graph: CellGraph) -> CellGraph:
    """The graph without vertices that no edge ends at."""
    used, edges = np.unique(graph.edges, return_inverse=True)
    return replace(graph, vertices=graph.vertices[used], edges=edges.reshape(-1, 2).astype(np.int32))


def _unbroken(torus: CellGraph, seam: Int[np.ndarray, "seam"]) -> CellGraph:
    """The torus with straight edges in one piece again across the seam, unless something would cross them."""
    across = np.argsort(torus.edges.ravel(), kind="stable")
    first = np.searchsorted(torus.edges.ravel()[across], seam)
    one, two = across[first], across[first + 1]  # half-edges from each vertex
    on_seam = np.zeros(len(torus.vertices), bool)
    on_seam[seam] = True
    heads = head_of(torus)
    plain = bend(torus.curves) < _STRAIGHT
    whole = plain[one // 2] & plain[two // 2] & ~on_seam[heads[one]] & ~on_seam[heads[two]]
    one, two = one[whole], two[whole]

    ends = np.stack([torus.curve[:, 2], -torus.curve[:, 2]], axis=1).reshape(-1, 2)
    along = ends[two] - ends[one]
    kept = np.ones(len(torus.edges), bool)
    kept[one // 2] = kept[two // 2] = False
    edges = np.concatenate([torus.edges[kept], np.stack([heads[one], heads[two]], axis=1)])
    curve = np.concatenate([torus.curve[kept], lines(np.zeros_like(along), along)[:, 1:]])
    mended = _compact(replace(torus, edges=edges, curve=curve))
    return torus if len(mended.crossings()) or len(mended.crossings(_FINE)) else mended
