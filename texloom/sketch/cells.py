"""The cells of a planar graph: which half-edges bound each face, walked by their order around the vertices."""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32

from texloom.sketch.bezier import points_at
from texloom.sketch.crossing import cross

_LEAST_AREA = 1e-6  # square texels: a walk around a tree has none, to rounding
_SAME_ANGLE = 1e-7  # radians under which two edges leave a vertex side by side
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

    def of_halfedge(self, edges: int) -> Int32[np.ndarray, "halfedge"]:
        """The cell at the left of every half-edge of so many edges; -1 where there is none."""
        cell = np.full(2 * edges, -1, np.int32)
        cell[self.halfedge] = self.cell
        return cell


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
    curves = _from_origin(curve)[halfedge]
    step = curves[:, 3]
    sums = np.cumsum(step, axis=0) - step
    curves = curves + (sums - np.repeat(sums[opens], sizes, axis=0))[:, None]  # relative to the walk's first vertex
    closed = np.abs(np.add.reduceat(step, opens)).max(axis=1) < 1e-6 * (1 + np.abs(vertices).max())

    area, moment = np.zeros(len(halfedge)), np.zeros((len(halfedge), 2))
    velocity = 3 * np.diff(curves, axis=1)
    for node, weight in zip((_NODES + 1) / 2, _WEIGHTS / 2, strict=True):
        point = points_at(curves, np.full(len(curves), node))
        run = velocity[:, 0] * (1 - node) ** 2 + velocity[:, 1] * 2 * node * (1 - node) + velocity[:, 2] * node**2
        swept = cross(point, run)
        area += weight / 2 * swept
        moment += (weight / 3 * swept)[:, None] * point
    area, moment = np.add.reduceat(area, opens), np.add.reduceat(moment, opens)
    safe = np.where(np.abs(area) > 1e-12, area, np.inf)
    return area, vertices[edges.ravel()[halfedge[opens]]] + moment / safe[:, None], closed


def _from_origin(curve: Float64[np.ndarray, "edge 3 2"]) -> Float64[np.ndarray, "halfedge 4 2"]:
    """Four points of every half-edge, the first at 0."""
    forth = np.concatenate([np.zeros((len(curve), 1, 2)), curve], axis=1)
    back = forth[:, ::-1] - forth[:, 3:]
    return np.stack([forth, back], axis=1).reshape(-1, 4, 2)


def _next(count: int, edges: np.ndarray, curve: np.ndarray) -> Int[np.ndarray, "halfedge"]:
    """The half-edge that follows each one around the face at its left: the next clockwise from its twin."""
    return clockwise(edges.ravel(), _from_origin(curve))[np.arange(edges.size) ^ 1]


def clockwise(
    origin: Int[np.ndarray, "halfedge"], points: Float64[np.ndarray, "halfedge 4 2"]
) -> Int[np.ndarray, "halfedge"]:
    """The next half-edge clockwise around each one's origin, itself where it is alone; curves begin at 0."""
    angle, turn = _leaving(points)
    order = np.lexsort((turn, angle, origin))
    opens = np.flatnonzero(np.diff(origin[order], prepend=-1))
    before = np.roll(order, 1)
    before[opens] = order[np.append(opens, len(order))[1:] - 1]
    following = np.empty(len(order), np.int64)
    following[order] = before
    return following


def _leaving(points: Float64[np.ndarray, "halfedge 4 2"]) -> tuple[np.ndarray, np.ndarray]:
    """The angle at which each half-edge leaves, and how it turns from there: what orders those side by side."""
    length = np.hypot(points[..., 0], points[..., 1])
    far = length > 1e-9 * np.maximum(length.max(axis=1), 1e-300)[:, None]
    tangent = points[np.arange(len(points)), far.argmax(axis=1)]
    angle = np.round(np.arctan2(tangent[:, 1], tangent[:, 0]) / _SAME_ANGLE)
    angle[angle <= -np.round(np.pi / _SAME_ANGLE)] *= -1
    on = points_at(points, np.full(len(points), 0.25))
    return angle, np.arctan2(cross(tangent, on), (tangent * on).sum(axis=1))


def _walks(following: Int[np.ndarray, "halfedge"]) -> tuple[Int32[np.ndarray, "walks_plus_one"], np.ndarray]:
    """The cycles of a permutation in compressed rows, each from its lowest member."""
    after, seen = following.tolist(), [False] * len(following)
    start, walk = [0], []
    for first in range(len(after)):
        if seen[first]:
            continue
        at = first
        while not seen[at]:
            seen[at] = True
            walk.append(at)
            at = after[at]
        start.append(len(walk))
    return np.array(start, np.int32), np.array(walk, np.int32)
