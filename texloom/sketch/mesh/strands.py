"""Curves of several edges: from one junction to the next, through vertices of two edges."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float64, Int, Int32

from texloom.sketch.bezier import points_at
from texloom.sketch.graph import CellGraph


@dataclass(frozen=True, eq=False)
class Strands:
    """The curve each edge is part of: what moves a curve's two ends carries all between them along.

    A vertex of any but two edges is an end; so is one vertex of every closed curve that has no other.
    """

    ends: Int32[np.ndarray, "edge 2"]  # vertices: behind the edge's tail, and ahead of its head
    period: Int32[np.ndarray, "edge 2 2"]  # where each end lies as seen along the curve from the tail: on which copy
    share: Float64[np.ndarray, "edge 2"]  # of the curve's length, from the first end, at the edge's tail and head
    length: Float64[np.ndarray, "edge"]  # texels, of the whole curve
    free: Bool[np.ndarray, "vertex"]  # the ends


def carry(
    by: Float64[np.ndarray, "vertex 2"],
    *,
    free: Bool[np.ndarray, "vertex"],
    edges: Int32[np.ndarray, "edge 2"],
    ends: Int32[np.ndarray, "edge 2"],
    share: Float64[np.ndarray, "edge 2"],
) -> Float64[np.ndarray, "vertex 2"]:
    """The displacements of all vertices, from those of the ends of their curves."""
    carried = by.copy()
    for side in (0, 1):
        held = np.flatnonzero(~free[edges[:, side]])
        part = share[held, side, None]
        carried[edges[held, side]] = by[ends[held, 0]] * (1 - part) + by[ends[held, 1]] * part
    return carried


def strands(graph: CellGraph) -> Strands:
    """The curves of a graph."""
    free = graph.degree != 2
    free[_of_closed(graph, free)] = True
    length = edge_lengths(graph)
    last, run, way = walk(graph, ~free, length)
    ends = head_of(graph)[last].reshape(-1, 2)[:, ::-1]
    ahead, behind = run[0::2], run[1::2]
    whole = np.maximum(behind + length + ahead, 1e-12)
    share = np.stack([behind / whole, (behind + length) / whole], axis=1)

    tail = graph.vertices[graph.edges[:, 0]]
    reached = np.stack([tail + way[1::2], tail + graph.curve[:, 2] + way[0::2]], axis=1)
    period = np.rint((reached - graph.vertices[ends]) / np.array(graph.size)).astype(np.int32)
    return Strands(ends, period, share, whole, free)


def edge_lengths(graph: CellGraph) -> Float64[np.ndarray, "edge"]:
    """The length of every edge, over chords at its quarters."""
    curves = graph.curves
    points = np.stack([points_at(curves, np.full(len(curves), t)) for t in np.linspace(0, 1, 5)], axis=1)
    return np.hypot(*np.diff(points, axis=1).transpose(2, 0, 1)).sum(axis=1)


def head_of(graph: CellGraph) -> Int32[np.ndarray, "halfedge"]:
    """The vertex each half-edge leads to."""
    return graph.edges[:, ::-1].ravel()


def head_period(graph: CellGraph) -> Int[np.ndarray, "edge 2"]:
    """On which copy of the torus each edge ends, as seen from its tail."""
    tail, head = graph.vertices[graph.edges[:, 0]], graph.vertices[graph.edges[:, 1]]
    return np.rint((tail + graph.curve[:, 2] - head) / np.array(graph.size)).astype(np.int64)


def walk(
    graph: CellGraph, through: Bool[np.ndarray, "vertex"], length: Float64[np.ndarray, "edge"], *, doublings: int = 32
) -> tuple[Int[np.ndarray, "halfedge"], Float64[np.ndarray, "halfedge"], Float[np.ndarray, "halfedge 2"]]:
    """The half-edge reached from each by going on while its head, of two edges, may be gone ``through``.

    With it the length gone after the half-edge itself, and the way. Each doubling of the reach goes twice as many edges
    on, from one: three reach eight edges beyond.
    """
    tail, head = graph.edges.ravel(), head_of(graph)
    halfedge = np.arange(len(tail))
    # Of the two half-edges from a vertex of two edges, one is the twin of the one that came in
    both = np.bincount(tail, weights=halfedge, minlength=len(graph.vertices)).astype(np.int64)
    on = np.where(through[head], both[head] - (halfedge ^ 1), halfedge)
    step = np.stack([graph.curve[:, 2], -graph.curve[:, 2]], axis=1).reshape(-1, 2)
    gone = np.where((on != halfedge)[:, None], np.concatenate([length[on // 2, None], step[on]], axis=1), 0.0)
    for _ in range(doublings):
        further = on[on]
        if (further == on).all():
            break
        on, gone = further, gone + gone[on]
    return on, gone[:, 0], gone[:, 1:]


def _of_closed(graph: CellGraph, free: Bool[np.ndarray, "vertex"]) -> Int[np.ndarray, "closed"]:
    """The first vertex of each closed curve that no end lies on."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    tail, head = graph.edges.T
    within = ~free[tail] & ~free[head]
    joins = coo_array((np.ones(within.sum()), (tail[within], head[within])), shape=(len(free),) * 2)
    count, piece = connected_components(joins, directed=False)
    reached = np.zeros(count, bool)
    for side, other in ((tail, head), (head, tail)):
        reached[piece[side[free[other]]]] = True
    first = np.full(count, len(free))
    np.minimum.at(first, piece, np.arange(len(free)))
    return first[~reached & ~free[first]]
