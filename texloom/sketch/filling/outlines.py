"""Cells as polygons, and what is measured on them."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int, Int32

from texloom.sketch.bezier import points_at, steps
from texloom.sketch.cells import Cells
from texloom.sketch.crossing import cross
from texloom.sketch.graph import CellGraph

_TOLERANCE = 0.1  # texels from a chord to its curve
_GRID = 2.0**20  # places a texel: points that are one come out as one, whichever cell they are reached from


@dataclass(frozen=True, eq=False)
class Outlines:
    """The cells of a graph as closed polygons in compressed rows, [row, column] in texels.

    Cells side by side share their points to the bit. On a torus each outline is in one piece, from the first vertex of
    its walk, perhaps beyond the border: then points are shared modulo the size of the drawing.
    """

    start: Int32[np.ndarray, "cells_plus_one"]
    point: Float64[np.ndarray, "point 2"]

    @property
    def cell(self) -> Int32[np.ndarray, "point"]:
        """The cell of every point."""
        return np.repeat(np.arange(len(self.start) - 1, dtype=np.int32), np.diff(self.start))

    @property
    def following(self) -> Int[np.ndarray, "point"]:
        """The next point of the same outline."""
        following = np.arange(1, len(self.point) + 1)
        following[self.start[1:] - 1] = self.start[:-1]
        return following

    def spread(self, middle: Float64[np.ndarray, "cell 2"]) -> Float64[np.ndarray, "cell 2 2"]:
        """The mean of x xᵀ over every cell, x from a place of its own: at the centroid, the covariance."""
        a = (self.point - middle[self.cell]).T
        b = a[:, self.following]
        swept, opens = cross(a.T, b.T), self.start[:-1]
        area = np.add.reduceat(swept, opens) / 2
        spread = np.empty((len(opens), 2, 2))
        for i, j in ((0, 0), (0, 1), (1, 1)):
            moment = (a[i] + b[i]) * (a[j] + b[j]) + a[i] * a[j] + b[i] * b[j]
            spread[:, i, j] = spread[:, j, i] = np.add.reduceat(swept * moment, opens) / 24 / area
        return spread

    def box(self) -> tuple[Float64[np.ndarray, "cell 2"], Float64[np.ndarray, "cell 2"]]:
        """The lowest and highest row and column of every cell."""
        opens = self.start[:-1]
        return np.minimum.reduceat(self.point, opens), np.maximum.reduceat(self.point, opens)

    def around(
        self, place: Float64[np.ndarray, "2"], *, period: tuple[float, float] | None = None
    ) -> Int[np.ndarray, "n"]:
        """The cells that a place lies in; with ``period``, any of its copies on a torus of that size."""
        a, b, copies = self.point, self.point[self.following], np.zeros((1, 2))
        if period is not None:
            copies = (np.stack(np.divmod(np.arange(25), 5), axis=1) - 2) * np.array(period)
        inside = np.zeros(len(self.start) - 1, bool)
        for p in place + copies:
            crosses = (a[:, 0] > p[0]) != (b[:, 0] > p[0])
            left = (cross(b - a, p - a) > 0) == (b[:, 0] > a[:, 0])
            inside |= np.add.reduceat(crosses & left, self.start[:-1], dtype=np.int64) % 2 == 1
        return np.flatnonzero(inside)


def outlines(graph: CellGraph, cells: Cells) -> Outlines:
    """The outlines of a graph's cells, within a tenth of a texel of its curves."""
    if not len(cells):
        return Outlines(np.zeros(1, np.int32), np.zeros((0, 2)))
    curves, edge = graph.curves, cells.halfedge // 2
    chords = steps(curves, _TOLERANCE)
    count = chords[edge]
    entry = np.repeat(np.arange(len(edge)), count)
    place = np.arange(len(entry)) - np.repeat(np.cumsum(count) - count, count)
    on = edge[entry]
    back = cells.halfedge[entry] % 2
    t = np.where(back, chords[on] - place, place) / chords[on]
    by_coordinate = curves.transpose(1, 2, 0).take(on, axis=2)  # points_at is twice as fast that way
    point = points_at(by_coordinate.transpose(2, 0, 1), t) + _shifts(graph, cells)[entry]
    start = np.concatenate([[0], np.cumsum(np.add.reduceat(count, cells.start[:-1]))])
    return Outlines(start.astype(np.int32), np.ascontiguousarray(np.rint(point * _GRID) / _GRID))


def _shifts(graph: CellGraph, cells: Cells) -> Float64[np.ndarray, "entry 2"]:
    """How far each edge of a walk is carried, whole drawings, to follow on the one before; 0 but on a torus."""
    entries = len(cells.halfedge)
    if not graph.wrap:
        return np.zeros((entries, 2))
    edge, back = np.divmod(cells.halfedge, 2)
    along = graph.curve[edge, 2]
    step = np.where(back[:, None] == 1, -along, along)
    sums = np.cumsum(step, axis=0) - step
    opens = np.repeat(cells.start[:-1], np.diff(cells.start))
    origin = graph.vertices[graph.edges.ravel()[cells.halfedge]]
    tail = origin[opens] + sums - sums[opens] + np.where(back[:, None] == 1, step, 0)
    size = np.array(graph.size)
    return np.rint((tail - graph.vertices[graph.edges[edge, 0]]) / size) * size
