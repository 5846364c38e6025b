"""Triangles between the lines of a graph on a torus: while none of them is turned over, nothing crosses."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float64, Int, Int32

from texloom import draws
from texloom.sketch.bezier import bend, points_at
from texloom.sketch.crossing import cross
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.strands import Strands, head_period, strands

_FLAT = 0.1  # texels from a chord to its curve
_MARGIN = 0.4  # of the torus: how far beyond its border copies lie, or twice, or twice again
_FARTHEST = 1000  # copies, from one end of a chord or side to the other, at most
_SPLITS = 16  # rounds in which chords become sides of triangles: six are many
_APART = 1e-4  # texels that points are set apart, for four on one circle would be joined in two ways
_THIN = 1e-6  # square texels under which a triangle says nothing


@dataclass(frozen=True, eq=False)
class Web:
    """A graph on a torus and a triangulation of all its chords, each point of which the ends of its curve carry along.

    A point is moved by (1 - share) times its first carrier's displacement plus share times the second's; vertices are
    the first of the points. A map of the torus that is linear on triangles and turns none over is one to one: then no
    edges cross, and no cell has flipped.
    """

    graph: CellGraph
    strands: Strands
    loose: Bool[np.ndarray, "vertex"]  # the ends of curves that may be displaced
    carrier: Int32[np.ndarray, "point 2"]  # vertices
    carrier_period: Int32[np.ndarray, "point 2 2"]  # the copy of each carrier
    share: Float64[np.ndarray, "point"]
    corner: Int32[np.ndarray, "triangle 3"]  # points
    corner_period: Int32[np.ndarray, "triangle 3 2"]  # the copy of each corner
    sides: Float64[np.ndarray, "triangle 2 2"]  # from the first corner to the others


@dataclass(frozen=True, eq=False)
class _Points:
    """Points on edges, vertices first, and the chords between them."""

    edge: Int[np.ndarray, "point"]
    on_edge: Float[np.ndarray, "point"]
    tail: Int[np.ndarray, "chord"]  # points
    head: Int[np.ndarray, "chord"]
    along: Int[np.ndarray, "chord"]  # edges
    first: Float[np.ndarray, "chord"]  # parameters
    last: Float[np.ndarray, "chord"]


def web(graph: CellGraph) -> Web:
    """The triangles of a graph that does not cross itself: Delaunay, chords split until each is a side of two.

    Where that does not end, as between curves that touch where they part, the curves' ends are to stay.
    """
    size = np.array(graph.size)
    points, splits = _on_edges(graph), 0
    while True:
        place = points_at(graph.curves[points.edge], points.on_edge)
        triangle, period = _triangles(place, size)
        missing = _missing(graph, points, place, triangle, period)
        if not len(missing) or splits == _SPLITS:
            break
        points, splits = _split(graph, points, missing), splits + 1

    runs = strands(graph)
    loose = runs.free.copy()
    loose[runs.ends[points.along[missing]]] = False
    return _carried(graph, runs, loose, points=points, triangle=triangle, period=period)


def _carried(
    graph: CellGraph,
    runs: Strands,
    loose: Bool[np.ndarray, "vertex"],
    *,
    points: _Points,
    triangle: Int[np.ndarray, "triangle 3"],
    period: Int[np.ndarray, "triangle 3 2"],
) -> Web:
    """The web of triangles between chords, with those between curves at a vertex."""
    wedge, beside = _wedges(graph)
    corner, period = np.concatenate([triangle, len(points.edge) + wedge]), np.concatenate([period, beside])
    edge = np.concatenate([points.edge, np.repeat(np.arange(len(graph.edges)), 4)])
    t = np.concatenate([points.on_edge, np.tile([0, 1 / 3, 2 / 3, 1], len(graph.edges))])
    curves, size, vertices = graph.curves, np.array(graph.size), len(graph.vertices)
    place = np.concatenate([points_at(curves[points.edge], points.on_edge), curves.reshape(-1, 2)])
    at = place[corner] + period * size
    sides = at[:, 1:] - at[:, :1]
    wide = cross(sides[:, 0], sides[:, 1]) > _THIN
    corner, period = corner[wide], period[wide]

    # On edges vertices may lie on another copy than the one they have their name from
    aside = np.zeros(place.shape, np.int64)
    aside[:vertices] = np.rint((place[:vertices] - graph.vertices) / size)
    used = np.union1d(np.arange(vertices), corner)
    edge, t = edge[used], t[used]
    return Web(
        graph,
        runs,
        loose,
        runs.ends[edge],
        (runs.period[edge] - aside[used, None]).astype(np.int32),
        runs.share[edge, 0] * (1 - t) + runs.share[edge, 1] * t,
        np.searchsorted(used, corner).astype(np.int32),
        (period + aside[corner]).astype(np.int32),
        sides[wide],
    )


def _wedges(graph: CellGraph) -> tuple[Int[np.ndarray, "wedge 3"], Int[np.ndarray, "wedge 3 2"]]:
    """Triangles from a vertex to the control points of curves at a sharp angle there, that their order may last.

    Their corners, of the four points of every curve, and the copy of each; the edge's ends carry a control point as
    what lies a third along.
    """
    halfedge = np.arange(2 * len(graph.edges))
    edge, back = halfedge // 2, halfedge % 2
    origin = graph.edges.ravel()
    way = np.where(back[:, None] == 0, graph.curve[edge, 0], graph.curve[edge, 1] - graph.curve[edge, 2])
    order = np.lexsort((np.arctan2(way[:, 1], way[:, 0]), origin))
    following = np.roll(order, -1)
    closes = np.flatnonzero(np.diff(origin[order], append=-1))
    following[closes] = order[np.concatenate([[0], closes[:-1] + 1])]
    sharp = (way[order] * way[following]).sum(axis=1) > 0
    curved = (bend(graph.curves) > _FLAT)[edge]
    one, two = (half[sharp & (curved[order] | curved[following])] for half in (order, following))
    copy = -back[:, None] * head_period(graph)[edge]
    return (
        np.stack([4 * edge[one] + 3 * back[one], 4 * edge[one] + 1 + back[one], 4 * edge[two] + 1 + back[two]], axis=1),
        np.stack([copy[one], copy[one], copy[two]], axis=1),
    )


def _on_edges(graph: CellGraph) -> _Points:
    """The ends of all chords of a graph."""
    chords = graph._chords(_FLAT)
    edge = chords.edge.astype(np.int64)
    opens, closes = chords.first == 0, chords.last == 1
    count = len(graph.vertices)
    of_vertex, at = np.zeros(count, np.int64), np.zeros(count)
    of_vertex[graph.edges.T] = np.arange(len(graph.edges))
    at[graph.edges[:, 1]] = 1
    at[graph.edges[of_vertex, 0] == np.arange(count)] = 0
    inner = np.flatnonzero(~opens)
    name = count + np.cumsum(~opens) - 1  # of the chord's start, where it is no vertex
    tail = np.where(opens, graph.edges[edge, 0], name)
    head = np.where(closes, graph.edges[edge, 1], name + 1)
    return _Points(
        np.concatenate([of_vertex, edge[inner]]),
        np.concatenate([at, chords.first[inner]]),
        tail,
        head,
        edge,
        chords.first,
        chords.last,
    )


def _triangles(
    place: Float[np.ndarray, "point 2"], size: Float[np.ndarray, "2"]
) -> tuple[Int[np.ndarray, "triangle 3"], Int[np.ndarray, "triangle 3 2"]]:
    """The Delaunay triangles of points on a torus, in one turning sense, and the copy of each corner."""
    from scipy.spatial import Delaunay

    index = np.arange(len(place))
    noise = np.stack([draws.uniform(0, axis, index=index) for axis in (0, 1)], axis=1)
    home = -np.floor((place + 0.5) / size).astype(np.int64)
    margin = _MARGIN * size.min()
    while True:
        copy, point = _copies(place + home * size, size, margin)
        at = (place + home * size + _APART * noise)[point] + copy * size
        corner = Delaunay(at).simplices
        turned = cross(at[corner[:, 1]] - at[corner[:, 0]], at[corner[:, 2]] - at[corner[:, 0]]) < 0
        corner[turned] = corner[turned][:, [0, 2, 1]]

        # Of all copies of a triangle the one whose lowest corner is at home, copies of one point in their order
        lowest = (point * len(copy) + np.arange(len(copy)))[corner].argmin(axis=1)
        corner = corner[np.arange(len(corner))[:, None], (lowest[:, None] + [0, 1, 2]) % 3]
        corner = corner[(copy[corner[:, 0]] == 0).all(axis=1)]
        if _reach(at[corner]) <= margin:
            return point[corner], (copy + home[point])[corner]
        margin *= 2


def _copies(
    base: Float[np.ndarray, "point 2"], size: Float[np.ndarray, "2"], margin: float
) -> tuple[Int[np.ndarray, "copy 2"], Int[np.ndarray, "copy"]]:
    """The copies of points that lie on a torus or within a margin of it, and whose they are."""
    most = np.ceil(margin / size).astype(np.int64)
    spans = 2 * most + 1
    steps = np.stack(np.divmod(np.arange(spans.prod()), spans[1]), axis=1) - most
    copies = base + steps[:, None] * size
    step, point = np.nonzero(((copies >= -0.5 - margin) & (copies < size - 0.5 + margin)).all(axis=2))
    return steps[step], point


def _reach(corner: Float[np.ndarray, "triangle 3 2"]) -> float:
    """The largest diameter of the circles through the corners of triangles."""
    a, b, c = (corner[:, (k + 1) % 3] - corner[:, k] for k in range(3))
    sides = np.hypot(*a.T) * np.hypot(*b.T) * np.hypot(*c.T)
    return float((sides / np.maximum(np.abs(cross(a, b)), 1e-12)).max())


def _missing(
    graph: CellGraph,
    points: _Points,
    place: Float[np.ndarray, "point 2"],
    triangle: Int[np.ndarray, "triangle 3"],
    period: Int[np.ndarray, "triangle 3 2"],
) -> Int[np.ndarray, "missing"]:
    """The chords that are not a side of any triangle."""
    size = np.array(graph.size)
    start, end = (points_at(graph.curves[points.along], t) for t in (points.first, points.last))
    copy = np.rint((end - place[points.head] - start + place[points.tail]) / size).astype(np.int64)
    wanted = _keys(points.tail, points.head, copy, len(place))
    following = [1, 2, 0]
    turn = (period[:, following] - period).reshape(-1, 2)
    there = _keys(triangle.ravel(), triangle[:, following].ravel(), turn, len(place))
    return np.flatnonzero(~np.isin(wanted, there))


def _keys(tail: np.ndarray, head: np.ndarray, copy: np.ndarray, count: int) -> Int[np.ndarray, "n"]:
    """One number for a side of a triangle, whichever way it is run."""
    back = (tail > head) | ((tail == head) & ((copy[:, 0] < 0) | ((copy[:, 0] == 0) & (copy[:, 1] < 0))))
    low, high = np.where(back, head, tail), np.where(back, tail, head)
    step = np.where(back[:, None], -copy, copy) + _FARTHEST
    wide = 2 * _FARTHEST + 1
    return ((low * count + high) * wide + step[:, 0]) * wide + step[:, 1]


def _split(graph: CellGraph, points: _Points, chord: Int[np.ndarray, "split"]) -> _Points:
    """Chords in two: near the middle, at a power of two texels from an end that is a vertex, so that those of two

    edges at a sharp angle come to lie at the same distance, and are no longer in each other's way.
    """
    curves = graph.curves[points.along[chord]]
    first, last = points.first[chord], points.last[chord]
    length = np.hypot(*(points_at(curves, last) - points_at(curves, first)).T)
    power = 2 ** np.rint(np.log2(length / 2)) / length
    share = np.where(first == 0, power, np.where(last == 1, 1 - power, 0.5))
    share = np.where((first == 0) & (last == 1), 0.5, share)
    middle = first + (last - first) * share
    new = len(points.edge) + np.arange(len(chord))
    head, ends = points.head.copy(), points.last.copy()
    head[chord], ends[chord] = new, middle
    return _Points(
        np.concatenate([points.edge, points.along[chord]]),
        np.concatenate([points.on_edge, middle]),
        np.concatenate([points.tail, new]),
        np.concatenate([head, points.head[chord]]),
        np.concatenate([points.along, points.along[chord]]),
        np.concatenate([points.first, middle]),
        np.concatenate([ends, last]),
    )
