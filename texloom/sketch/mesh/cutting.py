"""A rectangle cut out of a sketch: edges end where they cross its border."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from texloom.sketch.bezier import pieces, points_at
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.matching import Crossed, cross_lines

_MOST_SHORT = 2.0  # texels that a line may end before the border and be meant to reach it
_FLATTEST = 0.05  # sine of the angle to the border under which it is drawn on straight out
_BEYOND = 0.5  # texels beyond the border that such a line is drawn on


@dataclass(frozen=True, eq=False)
class Cut:
    """A piece of a sketch, its corner at (-0.5, -0.5), and its border: for rows (axis 0) and columns the two sides."""

    graph: CellGraph
    sides: "Sides"
    origin: Int[np.ndarray, "vertex"]  # of the sketch; -1 on the border

    @property
    def matches(self) -> bool:
        """Whether as many edges cross each side as the opposite one."""
        return all(len(low.vertex) == len(high.vertex) for low, high in self.sides)


@dataclass(frozen=True, eq=False)
class Side:
    """Where edges cross one side of a cut, in order along it, and the sketch's vertices they come from and lead to."""

    vertex: Int[np.ndarray, "crossing"]  # of the cut
    inner: Int[np.ndarray, "crossing"]  # of the sketch
    outer: Int[np.ndarray, "crossing"]


Sides = tuple[tuple[Side, Side], tuple[Side, Side]]
"""[axis][low, high]."""


def cut(graph: CellGraph, crop: Float[np.ndarray, "4"]) -> Cut:
    """The part of a sketch in a rectangle (top, left, bottom, right)."""
    lines = [_exactly(graph, axis, crop[[axis, axis + 2]]) for axis in (0, 1)]
    ends = np.arange(len(graph.edges))
    edge = np.concatenate([ends, ends, *(line.edge for line in lines)])
    t = np.concatenate([0.0 * ends, 0.0 * ends + 1, *(line.on_edge for line in lines)])
    name = np.concatenate([*graph.edges.T, len(graph.vertices) + np.arange(sum(len(line.edge) for line in lines))])
    order = np.lexsort((t, edge))
    edge, t, name = edge[order], t[order], name[order]

    # What lies inside, between one end or crossing of an edge and the next
    part = np.flatnonzero((edge[1:] == edge[:-1]) & (t[1:] > t[:-1]))
    middle = points_at(graph.curves[edge[part]], (t[part] + t[part + 1]) / 2)
    part = part[((middle > crop[:2]) & (middle < crop[2:])).all(axis=1)]
    curve = pieces(graph.curves[edge[part]], t[part], t[part + 1])
    kept, edges = np.unique(np.stack([name[part], name[part + 1]], axis=1), return_inverse=True)
    edges = edges.reshape(-1, 2)
    new = np.full(len(graph.vertices) + sum(len(line.edge) for line in lines), -1)
    new[kept] = np.arange(len(kept))
    sides = _sides(lines, new, len(graph.vertices))

    places = np.zeros((len(kept), 2))
    places[edges[:, 0]], places[edges[:, 1]] = curve[:, 0], curve[:, 3]
    for axis in (0, 1):
        for side, at in zip(sides[axis], crop[[axis, axis + 2]], strict=True):
            places[side.vertex, axis] = at
    curve = curve[:, 1:] - places[edges[:, 0], None]
    curve[:, 2] = places[edges[:, 1]] - places[edges[:, 0]]
    size = (float(crop[2] - crop[0]), float(crop[3] - crop[1]))
    piece = CellGraph(size, places - crop[:2] - 0.5, edges.astype(np.int32), curve)
    return Cut(piece, sides, np.where(kept < len(graph.vertices), kept, -1))


def _exactly(graph: CellGraph, axis: int, at: Float[np.ndarray, "2"]) -> Crossed:
    """The crossings of two lines, on the curves instead of their chords (Newton)."""
    crossed = cross_lines(graph, axis, at)
    line = at[np.repeat([0, 1], np.diff(crossed.start))]
    curves, t = graph.curves[crossed.edge], crossed.on_edge
    slope = 3 * np.diff(curves[..., axis], axis=1)
    for _ in range(3):
        run = slope[:, 0] * (1 - t) ** 2 + 2 * slope[:, 1] * t * (1 - t) + slope[:, 2] * t**2
        step = (points_at(curves, t)[:, axis] - line) / np.where(np.abs(run) > 1e-9, run, np.inf)
        t = np.clip(t - np.clip(step, -0.05, 0.05), 1e-9, 1 - 1e-9)
    return Crossed(crossed.start, points_at(curves, t)[:, 1 - axis], crossed.edge, t, crossed.below, crossed.above)


def _sides(lines: list[Crossed], new: Int[np.ndarray, "name"], first: int) -> Sides:
    """The crossings of each side that an edge of the cut ends at."""
    sides = []
    for line in lines:
        name = new[first : first + len(line.edge)]
        first += len(line.edge)
        sides.append((_side(line, name, 0), _side(line, name, 1)))
    return sides[0], sides[1]


def _side(line: Crossed, name: Int[np.ndarray, "crossing"], high: int) -> Side:
    rows = np.arange(line.start[high], line.start[high + 1])
    rows = rows[name[rows] >= 0]
    rows = rows[np.argsort(line.place[rows], kind="stable")]
    inner, outer = (line.below, line.above) if high else (line.above, line.below)
    return Side(name[rows], inner[rows], outer[rows])


def reaching_border(graph: CellGraph) -> CellGraph:
    """A drawing with lines that end at its border, or just before, drawn on beyond it."""
    end = np.flatnonzero(graph.degree == 1)
    side = np.isin(graph.edges, end)
    edge, head = np.nonzero(side)
    curves = graph.curves[edge]
    curves[head == 0] = curves[head == 0, ::-1]
    along = curves[:, 3] - curves[:, 2]
    along = np.where(np.hypot(*along.T)[:, None] > 1e-9, along, curves[:, 3] - curves[:, 0])
    along /= np.maximum(np.hypot(*along.T), 1e-12)[:, None]

    moved = graph.vertices.copy()
    size = np.array(graph.size)
    for axis in (0, 1):
        for at, out in ((-0.5, -1), (size[axis] - 0.5, 1)):
            short = (at - curves[:, 3, axis]) * out
            near = (short > -_BEYOND) & (short < _MOST_SHORT)
            steep = np.maximum(along[:, axis] * out, _FLATTEST)
            on = curves[:, 3] + along * ((short + _BEYOND) / steep)[:, None]
            on[:, axis] = at + out * _BEYOND
            moved[graph.edges[edge[near], head[near]]] = on[near]
    return graph.moved(moved)
