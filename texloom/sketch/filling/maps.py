"""Maps of a cell graph, texel by texel: how close its edges are, where they lie, and which cell it is."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Float64, Int32

from texloom.kernels import sketch_maps as kernels
from texloom.kernels.launch import launch
from texloom.sketch.cells import Cells, typical_area
from texloom.sketch.filling.outlines import outlines
from texloom.sketch.graph import CellGraph

Window = tuple[slice, slice]
"""Rows and columns of a rectangle of texels."""

_BLUR = 0.06  # of a typical cell: δ of eq. 10
_LEAST_BLUR = 0.6  # texels
_MOST_BLUR = 1 / 16  # of the map's shorter side: of cells larger than the map no more is seen
_REACH = 2.5  # δ from the middle of a neighbourhood to its side
_ON_EDGE = 0.5  # texels from an edge: nearer, a texel is a part of it
_TOLERANCE = 0.25  # texels from a chord to its curve
_TILE = 32  # texels a side of what the kernel looks at together


@dataclass(frozen=True, eq=False)
class FeatureMaps:
    """What each texel knows of the cell graph around it (Wang et al. 2014, §3.2).

    ``closeness`` is the paper's distance feature D (eqs 9, 10): near 0.5 on edges, 0 where none is within ``reach``.
    ``toward`` is its orientation feature V (eqs 11, 12), [row, column] texels, 0 where no edge is within twice that.
    Ours are ``nearest``, the offset to the nearest point of an edge, and ``away``, its length: exact of straight edges,
    within a quarter of a texel for curves.
    ``cell`` is the cell a texel's centre lies in, of nested ones the inner, -1 where there is none.
    """

    closeness: Float32[np.ndarray, "row column"]
    toward: Float32[np.ndarray, "row column 2"]
    nearest: Float32[np.ndarray, "row column 2"]
    away: Float32[np.ndarray, "row column"]
    cell: Int32[np.ndarray, "row column"]
    blur: float  # texels: δ of eq. 10
    wrap: bool

    @property
    def reach(self) -> int:
        """Texels from the middle of a neighbourhood N(p) to its side."""
        return max(round(_REACH * self.blur), 1)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns = self.away.shape
        return rows, columns


def feature_maps(graph: CellGraph, cells: Cells, *, blur: float | None = None) -> FeatureMaps:
    """The maps of a graph at its own size.

    ``blur`` (texels) is 0.06 of a typical cell, the square root of a typical area, unless given. At a border that does
    not wrap, neighbourhoods of D end, and those of V see what a mirror would show, or V would lean inwards.
    """
    rows, columns = (max(int(round(side)), 1) for side in graph.size)
    if blur is None:
        typical = float(np.sqrt(typical_area(cells.area))) if len(cells) else 0.0
        blur = max(min(_BLUR * typical, _MOST_BLUR * min(rows, columns)), _LEAST_BLUR)
    maps = FeatureMaps(
        np.empty((rows, columns), np.float32),
        np.empty((rows, columns, 2), np.float32),
        np.empty((rows, columns, 2), np.float32),
        np.empty((rows, columns), np.float32),
        np.empty((rows, columns), np.int32),
        blur,
        graph.wrap,
    )
    redraw(maps, graph, cells, window=(slice(0, rows), slice(0, columns)))
    return maps


def redraw(maps: FeatureMaps, graph: CellGraph, cells: Cells, *, window: Window) -> None:
    """The maps made anew inside a window, in place; ``changed`` says which window does for vertices moved."""
    _measure(maps, graph, cells, window)
    _close(maps, window)
    _draw(maps, window)


def changed(maps: FeatureMaps, before: CellGraph, after: CellGraph, cells: Cells) -> Window:
    """The least rectangle in which maps differ when vertices have moved: around the cells that have, and their blur.

    All texels where an edge that moved borders on no cell, or where cells that moved lie across the border of a torus.
    """
    everything = slice(0, maps.shape[0]), slice(0, maps.shape[1])
    which = cells.beside(after.moved_from(before))
    if not len(which):
        return slice(0, 0), slice(0, 0)
    if which[0] < 0:
        return everything
    low, high = zip(*(outlines(graph, cells.some(which)).box() for graph in (before, after)), strict=True)
    low, high = np.minimum(*low), np.maximum(*high)
    if maps.wrap:  # all beside the first, and that in the drawing
        aside = np.floor((low[0] + high[0]) / 2 / maps.shape) + np.rint(
            (low + high - low[0] - high[0]) / 2 / maps.shape
        )
        low, high = low - aside * maps.shape, high - aside * maps.shape
    margin = 2 * maps.reach + 1
    first = np.floor(low.min(axis=0)).astype(int) - margin
    last = np.ceil(high.max(axis=0)).astype(int) + margin + 1
    if maps.wrap and ((first < 0) | (last > maps.shape)).any():
        return everything
    first, last = np.clip(first, 0, maps.shape), np.clip(last, 0, maps.shape)
    return slice(int(first[0]), int(last[0])), slice(int(first[1]), int(last[1]))


def _measure(maps: FeatureMaps, graph: CellGraph, cells: Cells, window: Window) -> None:
    """The nearest edge of every texel of the window, and the cell at its side that the texel lies in."""
    widest = float(np.sqrt(cells.area.max(initial=0) / np.pi)) + 1  # no larger circle in a cell is free of edges
    halfedge = _nearest(maps, graph, window, widest)
    if halfedge.min(initial=0) < 0 or maps.away[window].max(initial=0) > widest:
        halfedge = _nearest(maps, graph, window, float(np.hypot(*graph.size)))
    cell = np.append(cells.of_halfedge(len(graph.edges)), np.int32(-1))  # the last where there is no edge at all
    if (cell[halfedge] < 0).any():
        cell[:-1] = _around(graph, cells, cell[:-1])
    maps.cell[window] = cell[halfedge]


def _nearest(maps: FeatureMaps, graph: CellGraph, window: Window, widest: float) -> Int32[np.ndarray, "row column"]:
    """The nearest edge where none is further than ``widest``; returns the half-edge with the texel at its left."""
    first, last = (window[0].start, window[1].start), (window[0].stop, window[1].stop)
    bounds = np.array(first) - widest, np.array(last) + widest
    there = _edges_within(graph, bounds)
    chords = graph.part(there).flattened(_TOLERANCE, margin=widest)
    low, high = np.minimum(chords.start, chords.end), np.maximum(chords.start, chords.end)
    near = np.flatnonzero(np.all((high > bounds[0]) & (low < bounds[1]), axis=1))
    ends = [end[near].astype(np.float32) for end in (chords.start, chords.end)]
    down, across = (-(-(stop - start) // _TILE) for start, stop in zip(first, last, strict=True))
    radius = np.hypot(*(ends[1] - ends[0]).T) / 2 + np.float32(1e-3)  # more than what is lost to rounding
    disc = np.concatenate([(ends[0] + ends[1]) / 2, radius[:, None]], axis=1)
    lists = np.empty((1 + 3 * down * across) * len(near), np.int32)
    lists[: len(near)] = np.arange(len(near))
    halfedge = np.empty(maps.shape, np.int32)
    inputs = [first, last, across, *ends, disc, there[chords.edge[near]], lists]
    outputs = [maps.nearest, maps.away, halfedge]
    launch(kernels.nearest_edges, down * across, inputs=inputs, outputs=outputs, grain=1)
    return halfedge[window]


def _edges_within(
    graph: CellGraph, bounds: tuple[Float64[np.ndarray, "2"], Float64[np.ndarray, "2"]]
) -> Int32[np.ndarray, "near"]:
    """The edges that may reach into a rectangle; on a torus with any of their copies."""
    curves = graph.curves
    low, high = curves.min(axis=1), curves.max(axis=1)
    if graph.wrap:  # the first copy that is not before it
        size = np.array(graph.size)
        by = np.ceil((bounds[0] - high) / size) * size
        low, high = low + by, high + by
    return np.flatnonzero(np.all((high >= bounds[0]) & (low <= bounds[1]), axis=1)).astype(np.int32)


def _around(
    graph: CellGraph, cells: Cells, of_halfedge: Int32[np.ndarray, "halfedge"]
) -> Int32[np.ndarray, "halfedge"]:
    """The cell of every half-edge, that of an enclosing cell where it is at the rim of a piece that lies within one."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    tail, head = graph.edges.T
    links = coo_array((np.ones(len(tail), np.int8), (tail, head)), (len(graph.vertices),) * 2)
    piece = np.repeat(connected_components(links, directed=False)[1][tail], 2)
    cell_piece = piece[cells.halfedge[cells.start[:-1]]]
    outline, found = outlines(graph, cells), of_halfedge.copy()
    rim = of_halfedge < 0
    for each in np.unique(piece[rim]):
        edge = np.flatnonzero(piece == each)[0] // 2
        inside = outline.around(graph.vertices[tail[edge]], period=graph.size if graph.wrap else None)
        inside = inside[cell_piece[inside] != each]
        if len(inside):
            found[rim & (piece == each)] = inside[np.argmin(cells.area[inside])]
    return found


def _close(maps: FeatureMaps, window: Window) -> None:
    """Eqs 9 and 10: the share of edges in a square, each texel weighed by its distance."""
    offset = np.arange(-maps.reach, maps.reach + 1)
    weight = np.exp(-(offset**2) / (2 * maps.blur**2)).astype(np.float32)
    blurred = _with_surroundings(maps, maps.away, window, np.inf) <= _ON_EDGE
    within = _with_surroundings(maps, np.ones(maps.shape, np.float32), window, 0)
    for axis in (0, 1):
        length = blurred.shape[axis] - 2 * maps.reach
        blurred, within = (_weighed(values, weight, axis, length) for values in (blurred, within))
    maps.closeness[window] = blurred / within


def _weighed(
    values: np.ndarray, weight: Float32[np.ndarray, "offset"], axis: int, length: int
) -> Float32[np.ndarray, "row column"]:
    """Running sums along an axis."""
    total = weight[0] * values.take(range(length), axis)
    for k in range(1, len(weight)):
        total += weight[k] * values.take(range(k, k + length), axis)
    return total


def _draw(maps: FeatureMaps, window: Window) -> None:
    """Eqs 11 and 12."""
    offset = np.arange(-maps.reach, maps.reach + 1, dtype=np.float32)
    distance = np.hypot(offset[:, None], offset)
    weight = np.divide(1, distance, out=np.zeros_like(distance), where=distance > 0)
    closeness = np.ascontiguousarray(_with_surroundings(maps, maps.closeness, window, None))
    shape = maps.closeness[window].shape
    toward = np.empty((*shape, 2), np.float32)
    inputs = [shape[1], len(offset), weight.ravel(), closeness.ravel()]
    launch(kernels.toward_edges, shape[0] * shape[1], inputs=inputs, outputs=[toward])
    maps.toward[window] = toward


def _with_surroundings(
    maps: FeatureMaps, values: Float32[np.ndarray, "row column"], window: Window, beyond: float | None
) -> Float32[np.ndarray, "more_rows more_columns"]:
    """The values of a window and of half a neighbourhood around it.

    Beyond a border those across it or, where nothing wraps, ``beyond``; None: a mirror's.
    """
    for axis, (span, side) in enumerate(zip(window, values.shape, strict=True)):
        index = np.arange(span.start - maps.reach, span.stop + maps.reach)
        outside = (index < 0) | (index >= side)
        mirrored = np.minimum(index % (2 * side), 2 * side - 1 - index % (2 * side))
        values = values.take(index % side if maps.wrap else mirrored, axis)
        if not maps.wrap and beyond is not None:
            values[(slice(None),) * axis + (outside,)] = beyond
    return values
