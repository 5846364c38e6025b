"""Planar graphs of cells: what a sketch becomes and a texture mesh is."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32

from texloom.sketch.bezier import lines, points_at, steps
from texloom.sketch.cells import Cells, find_cells, measure
from texloom.sketch.crossing import at_common_end, meetings

_FLAT = 0.02  # texels from a chord to its curve where crossings are sought


@dataclass(frozen=True, eq=False)
class Segments:
    """Edges as chords: each from one parameter of its edge to another. On a torus, with copies beyond the border."""

    start: Float64[np.ndarray, "segment 2"]
    end: Float64[np.ndarray, "segment 2"]
    edge: Int32[np.ndarray, "segment"]
    first: Float64[np.ndarray, "segment"]  # the edge's parameter at ``start``, in [0, 1]
    last: Float64[np.ndarray, "segment"]


@dataclass(frozen=True, eq=False)
class CellGraph:
    """A planar graph of vertices and curved edges; its faces are the cells of a texture.

    Places are [row, column] in texels, centres at integers: it covers [-0.5, rows - 0.5] × [-0.5, columns - 0.5].
    Edge e is the cubic Bézier curve from its tail v: v, v + curve[e, 0], v + curve[e, 1], v + curve[e, 2]; the last is
    its head, modulo ``size`` where ``wrap``. A long curve is several edges through vertices of two edges.
    """

    size: tuple[float, float]  # rows, columns of the drawing
    vertices: Float64[np.ndarray, "vertex 2"]
    edges: Int32[np.ndarray, "edge 2"]  # tail, head
    curve: Float64[np.ndarray, "edge 3 2"]  # from the tail: two control points and the end
    wrap: bool = False  # on a torus: an edge may leave at one border and come in at the other

    @property
    def curves(self) -> Float64[np.ndarray, "edge 4 2"]:
        """The four points of every edge where they are; on a torus from the tail on, perhaps beyond the border."""
        planes = np.empty((4, 2, len(self.edges)))  # in memory coordinate by coordinate, for speed
        planes[0] = self.vertices[self.edges[:, 0]].T
        planes[1:] = planes[0] + self.curve.transpose(1, 2, 0)
        return planes.transpose(2, 0, 1)

    @property
    def degree(self) -> Int[np.ndarray, "vertex"]:
        """Edge ends at every vertex."""
        return np.bincount(self.edges.ravel(), minlength=len(self.vertices))

    def cells(self) -> Cells:
        """The inner faces, counter-clockwise."""
        return find_cells(self.vertices, self.edges, self.curve)

    def flipped(self, cells: Cells) -> Bool[np.ndarray, "cell"]:
        """Whether cells found before vertices moved have lost their area or been turned over since."""
        area, _, closed = measure(self.vertices, self.edges, self.curve, start=cells.start, halfedge=cells.halfedge)
        return ~closed | (area <= 0)

    def moved(self, vertices: Float64[np.ndarray, "vertex 2"]) -> "CellGraph":
        """The graph with its vertices elsewhere: each edge is carried along as its two ends move."""
        by = vertices - self.vertices
        tail, head = by[self.edges[:, 0]], by[self.edges[:, 1]]
        share = np.array([1 / 3, 2 / 3, 1])[:, None]
        return replace(self, vertices=vertices, curve=self.curve + (head - tail)[:, None] * share)

    def moved_from(self, before: "CellGraph") -> Bool[np.ndarray, "edge"]:
        """The edges that lie elsewhere than in the same graph with its vertices where they were."""
        return (self.curves != before.curves).any(axis=(1, 2))

    def part(self, edges: Int[np.ndarray, "chosen"]) -> "CellGraph":
        """The graph with some of its edges, in that order, and all of its vertices."""
        return replace(self, edges=self.edges[edges], curve=self.curve[edges])

    def resized(self, size: tuple[float, float]) -> "CellGraph":
        """The graph stretched to a drawing of another size."""
        by = np.array(size) / np.array(self.size)
        return replace(self, size=size, vertices=(self.vertices + 0.5) * by - 0.5, curve=self.curve * by)

    def flattened(self, tolerance: float, *, margin: float = 0.0) -> Segments:
        """Every edge as chords within ``tolerance`` texels of it, in order along the edges.

        On a torus each chord comes once for every copy that reaches into the drawing or within ``margin`` texels of it.
        """
        segments = self._chords(tolerance)
        return self._copies(segments, margin) if self.wrap else segments

    def _chords(self, tolerance: float) -> Segments:
        curves = self.curves
        count = steps(curves, tolerance)
        if self.wrap:  # short enough for the nearest copy to be the one that is met
            reach = np.abs(np.diff(curves, axis=1)).sum(axis=1) / np.array(self.size)
            count = np.maximum(count, np.ceil(4 * reach.max(axis=1, initial=0)).astype(np.int64))
        edge = np.repeat(np.arange(len(curves), dtype=np.int32), count)
        place = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
        first, last = place / count[edge], (place + 1) / count[edge]
        start, end = points_at(curves[edge], first), points_at(curves[edge], last)
        end[last == 1] = curves[:, 3]  # ends are vertices, to the bit
        return Segments(start, end, edge, first, last)

    def _copies(self, segments: Segments, margin: float) -> Segments:
        """The copies of each chord that reach into the drawing."""
        size = np.array(self.size)
        low, high = np.minimum(segments.start, segments.end), np.maximum(segments.start, segments.end)
        fewest = np.ceil((-0.5 - margin - high) / size).astype(np.int64)
        most = np.floor((size - 0.5 + margin - low) / size).astype(np.int64)
        span = np.maximum(most - fewest + 1, 0)
        copies = span.prod(axis=1)
        which = np.repeat(np.arange(len(copies)), copies)
        place = np.arange(len(which)) - np.repeat(np.cumsum(copies) - copies, copies)
        by = fewest[which] + np.stack([place // span[which, 1], place % span[which, 1]], axis=1)
        shift = by * size
        return Segments(
            segments.start[which] + shift,
            segments.end[which] + shift,
            segments.edge[which],
            segments.first[which],
            segments.last[which],
        )

    def crossings(self, tolerance: float = _FLAT) -> Int32[np.ndarray, "pair 2"]:
        """Pairs of edges that cross or touch other than at a common end, in order; an edge with itself where it loops.

        Edges are taken as chords within ``tolerance`` of them: curves that come closer than that may be named.
        """
        chords = self._chords(tolerance)
        period = np.array(self.size, np.float64) if self.wrap else None
        met = meetings(chords.start, chords.end, period=period)
        a, b = chords.edge[met.first], chords.edge[met.second]
        on_a, on_b = (
            chords.first[chord] + share * (chords.last[chord] - chords.first[chord])
            for chord, share in ((met.first, met.on_first), (met.second, met.on_second))
        )
        apart = ~at_common_end(self.edges[a], self.edges[b], on_a, on_b, tolerance=1e-6)
        apart &= (a != b) | (np.abs(on_a - on_b) > 1e-6)
        pair = np.unique(a[apart].astype(np.int64) * len(self.edges) + b[apart])
        return np.stack([pair // max(len(self.edges), 1), pair % max(len(self.edges), 1)], axis=1).astype(np.int32)


def straight(
    size: tuple[float, float],
    vertices: Float64[np.ndarray, "vertex 2"],
    edges: Int[np.ndarray, "edge 2"],
    *,
    wrap: bool = False,
) -> CellGraph:
    """The graph of straight edges; on a torus each the shortest way."""
    along = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    if wrap:
        along = along - np.round(along / np.array(size)) * np.array(size)
    curve = lines(np.zeros_like(along), along)[:, 1:]
    return CellGraph(size, vertices, edges.astype(np.int32), np.ascontiguousarray(curve), wrap)
