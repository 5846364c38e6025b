"""The cells of a planar graph: which half-edges bound each face, walked by their order around the vertices."""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32

from texloom.kernels.cycles import list_cycles
from texloom.kernels.launch import launch
from texloom.sketch.crossing import cross

_LEAST_AREA = 1e-6  # square texels: a walk around a tree has none, to rounding
_SAME_ANGLE = 1e-7  # radians under which two edges leave a vertex side by side
_BITS = 26  # of such an angle
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)  # exact to degree 9: moments of a cubic's area have degree 8


@dataclass(frozen=True, eq=False)
class Cells:
    """The inner faces of a graph, each a closed walk of half-edges in compressed rows.

    Half-edge 2 e runs along edge e, 2 e + 1 against it. Walks are counter-clockwise as seen on the screen (row 0 at the
    top), the cell at their left, and start at their lowest half-edge. The face around a connected piece is none of
    them; a cell that holds such a piece reaches under it, so of two cells at a place the smaller counts. On a torus a
    face that closes around it is none either.
    """

    start: Int32[np.ndarray, "cells_plus_one"]
    halfedge: Int32[np.ndarray, "entry"]
    area: Float64[np.ndarray, "cell"]  # square texels
    centroid: Float64[np.ndarray, "cell 2"]  # on a torus beside the walk's first vertex, perhaps beyond the border

    def __len__(self) -> int:
        return len(self.area)

    @property
    def cell(self) -> Int32[np.ndarray, "entry"]:
        """The cell of every entry of ``halfedge``."""
        return np.repeat(np.arange(len(self), dtype=np.int32), np.diff(self.start))

    def some(self, which: Int[np.ndarray, "chosen"]) -> "Cells":
        """Some of them, in that order."""
        start, entry = some_rows(self.start, which)
        return Cells(start, self.halfedge[entry], self.area[which], self.centroid[which])

    def beside(self, edges: Bool[np.ndarray, "edge"]) -> Int[np.ndarray, "n"]:
        """The cells on either side of some edges, in order; -1 first if there is none on some side."""
        return np.unique(self.of_halfedge(len(edges)).reshape(-1, 2)[edges])

    def of_halfedge(self, edges: int) -> Int32[np.ndarray, "halfedge"]:
        """The cell at the left of every half-edge of so many edges; -1 where there is none."""
        cell = np.full(2 * edges, -1, np.int32)
        cell[self.halfedge] = self.cell
        return cell


def typical_area(area: Float64[np.ndarray, "cell"]) -> float:
    """Square texels: half of all that cells cover is in larger ones, so slivers, many as they are, hardly count."""
    rising = np.sort(area)
    covered = np.cumsum(rising)
    return float(rising[np.searchsorted(covered, covered[-1] / 2)])


def some_rows(
    start: Int32[np.ndarray, "rows_plus_one"], which: Int[np.ndarray, "chosen"]
) -> tuple[Int32[np.ndarray, "chosen_plus_one"], Int[np.ndarray, "entry"]]:
    """Some of compressed rows: where each begins anew, and the entries they have."""
    size = np.diff(start)[which]
    begin = np.concatenate([[0], np.cumsum(size)]).astype(np.int32)
    return begin, np.arange(begin[-1]) + np.repeat(start[which] - begin[:-1], size)


class Graph(Protocol):
    """What cells are measured on (``texloom.sketch.graph``)."""

    @property
    def vertices(self) -> Float64[np.ndarray, "vertex 2"]: ...
    @property
    def edges(self) -> Int32[np.ndarray, "edge 2"]: ...
    @property
    def curve(self) -> Float64[np.ndarray, "edge 3 2"]: ...


def find_cells(
    vertices: Float64[np.ndarray, "vertex 2"],
    edges: Int32[np.ndarray, "edge 2"],
    curve: Float64[np.ndarray, "edge 3 2"],
) -> Cells:
    """The cells of a planar graph; of one that crosses itself, whatever the walks give."""
    start, halfedge = _walks(_next(len(vertices), edges, curve))
    area, centroid, closed = measure(vertices, edges, curve, start=start, halfedge=halfedge)
    kept = closed & (area > _LEAST_AREA)
    sizes = np.diff(start)
    return Cells(
        np.concatenate([[0], np.cumsum(sizes[kept])]).astype(np.int32),
        halfedge[np.repeat(kept, sizes)],
        area[kept],
        centroid[kept],
    )


def again(graph: "Graph", cells: Cells) -> Cells:
    """The same cells where vertices have moved."""
    area, centroid, _ = measure(graph.vertices, graph.edges, graph.curve, start=cells.start, halfedge=cells.halfedge)
    return replace(cells, area=area, centroid=centroid)


def measure(
    vertices: Float64[np.ndarray, "vertex 2"],
    edges: Int32[np.ndarray, "edge 2"],
    curve: Float64[np.ndarray, "edge 3 2"],
    *,
    start: Int[np.ndarray, "cells_plus_one"],
    halfedge: Int[np.ndarray, "entry"],
) -> tuple[Float64[np.ndarray, "cell"], Float64[np.ndarray, "cell 2"], Bool[np.ndarray, "cell"]]:
    """Signed area (positive counter-clockwise), centroid, and whether each walk closes (not around a torus)."""
    if not len(halfedge):
        return np.zeros(0), np.zeros((0, 2)), np.zeros(0, bool)
    opens, sizes = start[:-1], np.diff(start)
    points = _planes(curve).take(halfedge, axis=2)
    step = points[3].copy()
    sums = np.cumsum(step, axis=1) - step
    points += sums - np.repeat(sums[:, opens], sizes, axis=1)  # relative to the walk's first vertex
    closed = np.abs(np.add.reduceat(step, opens, axis=1)).max(axis=0) < 1e-6 * (1 + np.abs(vertices).max())

    area, moment = np.zeros(len(halfedge)), np.zeros((2, len(halfedge)))
    velocity = 3 * np.diff(points, axis=0)
    for node, weight in zip((_NODES + 1) / 2, _WEIGHTS / 2, strict=True):
        point = _at(points, node)
        run = velocity[0] * (1 - node) ** 2 + velocity[1] * 2 * node * (1 - node) + velocity[2] * node**2
        swept = cross(point.T, run.T)
        area += weight / 2 * swept
        moment += weight / 3 * swept * point
    area, moment = np.add.reduceat(area, opens), np.add.reduceat(moment, opens, axis=1)
    safe = np.where(np.abs(area) > 1e-12, area, np.inf)
    return area, vertices[edges.ravel()[halfedge[opens]]] + (moment / safe).T, closed


def _planes(curve: Float64[np.ndarray, "edge 3 2"]) -> Float64[np.ndarray, "4 2 halfedge"]:
    """Four points of every half-edge, the first at 0: all rows, then all columns, of one point after the other."""
    planes = np.zeros((4, 2, len(curve), 2))
    planes[1:, :, :, 0] = curve.transpose(1, 2, 0)
    planes[:, :, :, 1] = planes[::-1, :, :, 0] - planes[3:, :, :, 0]
    return planes.reshape(4, 2, -1)


def _at(points: Float64[np.ndarray, "4 2 n"], t: float) -> Float64[np.ndarray, "2 n"]:
    """The point of every curve at one parameter."""
    a, b, c, d = points
    s = 1 - t
    return s**3 * a + 3 * s**2 * t * b + 3 * s * t**2 * c + t**3 * d


def _next(count: int, edges: np.ndarray, curve: np.ndarray) -> Int[np.ndarray, "halfedge"]:
    """The half-edge that follows each one around the face at its left: the next clockwise from its twin."""
    return clockwise(edges.ravel(), _planes(curve).transpose(2, 0, 1))[np.arange(edges.size) ^ 1]


def clockwise(
    origin: Int[np.ndarray, "halfedge"], points: Float64[np.ndarray, "halfedge 4 2"]
) -> Int[np.ndarray, "halfedge"]:
    """The next half-edge clockwise around each one's origin, itself where it is alone; curves begin at 0."""
    tangent, angle = _leaving(points)
    around = origin * 2.0**_BITS + angle
    order = np.argsort(around, kind="stable")
    if (np.diff(around[order]) == 0).any():  # side by side: those that turn less come first
        on = _at(points.transpose(1, 2, 0), 0.25).T
        order = np.lexsort((np.arctan2(cross(tangent, on), (tangent * on).sum(axis=1)), around))
    opens = np.flatnonzero(np.diff(origin[order], prepend=-1))
    before = np.roll(order, 1)
    before[opens] = order[np.append(opens, len(order))[1:] - 1]
    following = np.empty(len(order), np.int64)
    following[order] = before
    return following


def _leaving(
    points: Float64[np.ndarray, "halfedge 4 2"],
) -> tuple[Float64[np.ndarray, "halfedge 2"], Float64[np.ndarray, "halfedge"]]:
    """Where each half-edge leads to at first, and at which angle, a whole number of what counts as the same."""
    length = np.hypot(points[..., 0], points[..., 1])
    far = length > 1e-9 * np.maximum(length.max(axis=1), 1e-300)[:, None]
    tangent = points[np.arange(len(points)), far.argmax(axis=1)]
    angle = np.round(np.arctan2(tangent[:, 1], tangent[:, 0]) / _SAME_ANGLE)
    angle[angle <= -np.round(np.pi / _SAME_ANGLE)] *= -1
    return tangent, angle


def _walks(following: Int[np.ndarray, "halfedge"]) -> tuple[Int32[np.ndarray, "walks_plus_one"], np.ndarray]:
    """The cycles of a permutation in compressed rows, each from its lowest member."""
    member, seen, opens = np.zeros((3, len(following)), np.int32)
    launch(list_cycles, 1, inputs=[following.astype(np.int32)], outputs=[seen, opens, member])
    return np.append(np.flatnonzero(opens), len(following)).astype(np.int32), member
