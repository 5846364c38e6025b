"""Curves in chords where they leave a vertex side by side, for there the order of curves is less than certain."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float64

from texloom.sketch.bezier import bend, lines
from texloom.sketch.graph import CellGraph

_FLAT = 0.02  # texels from a chord to its curve, as where crossings are sought: chords do not cross
_SHARP = np.pi / 6


def faceted(graph: CellGraph) -> CellGraph:
    """The graph with each curve in chords that leaves a vertex within 30° of another edge, by its tangent or chord."""
    chords = graph._chords(_FLAT)
    first = graph.curve[:, 0], graph.curve[:, 1] - graph.curve[:, 2]
    opens, closes = chords.first == 0, chords.last == 1
    along = chords.end - chords.start
    risky = _side_by_side(graph, *first) | _side_by_side(graph, along[opens], -along[closes])
    cut = risky & (bend(graph.curves) > 1e-9)
    if not cut.any():
        return graph

    part = np.flatnonzero(cut[chords.edge])
    inner = part[~opens[part]]
    name = np.full(len(chords.edge) + 1, -1)
    name[inner] = len(graph.vertices) + np.arange(len(inner))
    edge = chords.edge[part]
    tail = np.where(opens[part], graph.edges[edge, 0], name[part])
    head = np.where(closes[part], graph.edges[edge, 1], name[part + 1])
    pieces = lines(np.zeros((len(part), 2)), along[part])[:, 1:]
    return replace(
        graph,
        vertices=np.concatenate([graph.vertices, chords.start[inner]]),
        edges=np.concatenate([graph.edges[~cut], np.stack([tail, head], axis=1)]).astype(np.int32),
        curve=np.concatenate([graph.curve[~cut], pieces]),
    )


def _side_by_side(
    graph: CellGraph, from_tail: Float64[np.ndarray, "edge 2"], from_head: Float64[np.ndarray, "edge 2"]
) -> Bool[np.ndarray, "edge"]:
    """Which edges leave either end at a sharp angle to another that does, given the directions."""
    way = np.stack([from_tail, from_head], axis=1).reshape(-1, 2)
    origin, angle = graph.edges.ravel(), np.arctan2(way[:, 1], way[:, 0])
    order = np.lexsort((angle, origin))
    closes = np.flatnonzero(np.diff(origin[order], append=-1))
    following = np.roll(order, -1)
    following[closes] = order[np.concatenate([[0], closes[:-1] + 1])]
    gap = (angle[following] - angle[order]) % (2 * np.pi)
    sharp = (gap < _SHARP) & (following != order)
    risky = np.zeros(len(graph.edges), bool)
    risky[order[sharp] // 2] = risky[following[sharp] // 2] = True
    return risky
