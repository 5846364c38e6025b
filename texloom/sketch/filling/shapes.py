"""What a cell's shape is to its texture: a centre, how far it reaches on all sides, and what is compared of it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int, Int32

from texloom.kernels import sketch_cells as kernels
from texloom.kernels.launch import launch
from texloom.sketch.cells import Cells, some_rows, typical_area
from texloom.sketch.filling.outlines import Outlines, outlines
from texloom.sketch.graph import CellGraph

_SEEN = 0.9  # of its area that a centre should see
_LEAST_BINS, _MOST_BINS = 128, 2048
_PROBES = 10  # a side: places tried for a centre
_BORDER = 0.6  # texels: a cell that comes nearer to the border is cut by it


@dataclass(frozen=True, eq=False)
class CellShapes:
    """The shapes of a graph's cells, in texels.

    ``rim[i, j]`` is how far cell i reaches from its centre in direction j (numbered along |row| + |column| = 1, from
    columns to rows) and the cosine between that ray and the outline's normal. The centre is the centroid, or the
    deepest place of the cell where that sees more of it. Where none sees most of it, ``depth`` is how deep the deepest
    texel lies, else 0.
    """

    centre: Float32[np.ndarray, "cell 2"]
    rim: Float32[np.ndarray, "cell bin 2"]
    depth: Float32[np.ndarray, "cell"]
    area: Float64[np.ndarray, "cell"]
    relative: Float64[np.ndarray, "cell"]  # area by that of a typical cell
    spread: Float64[np.ndarray, "cell 2 2"]  # covariance of its texels
    corners: Int32[np.ndarray, "cell"]  # vertices where other cells meet it
    whole: Bool[np.ndarray, "cell"]  # not cut by the drawing's border

    def __len__(self) -> int:
        return len(self.area)

    @property
    def inner(self) -> Float32[np.ndarray, "cell"]:
        """Radius of the largest circle about the centre within the cell."""
        return self.rim[:, :, 0].min(axis=1)

    @property
    def outer(self) -> Float32[np.ndarray, "cell"]:
        """Radius of the least circle about the centre around the cell."""
        return self.rim[:, :, 0].max(axis=1)

    @property
    def elongation(self) -> Float64[np.ndarray, "cell"]:
        """Logarithm of length by width: 0 for a circle or a square."""
        return np.log(np.sqrt((1 + self._lean) / (1 - self._lean)))

    @property
    def axis(self) -> Float64[np.ndarray, "cell"]:
        """The direction of its length, radians from columns to rows."""
        spread = self.spread
        return 0.5 * np.arctan2(2 * spread[:, 0, 1], spread[:, 1, 1] - spread[:, 0, 0])

    @property
    def _lean(self) -> Float64[np.ndarray, "cell"]:
        """Difference of the principal variances by their sum."""
        spread = self.spread
        apart = np.hypot(2 * spread[:, 0, 1], spread[:, 0, 0] - spread[:, 1, 1])
        return np.clip(apart / (spread[:, 0, 0] + spread[:, 1, 1]), 0, 1 - 1e-9)


def cell_shapes(graph: CellGraph, cells: Cells) -> CellShapes:
    """The shapes of a graph's cells."""
    outline = outlines(graph, cells)
    return _shapes(graph, cells, outline, _bins(outline))


def moved_shapes(shapes: CellShapes, graph: CellGraph, cells: Cells, which: Int[np.ndarray, "moved"]) -> CellShapes:
    """The same where only some cells have moved, the others' kept."""
    some = cells.some(which)
    outline, bins = outlines(graph, some), shapes.rim.shape[1]
    if _bins(outline) > bins:
        return cell_shapes(graph, cells)
    made = vars(shapes) | {"relative": cells.area / typical_area(cells.area)}
    for name, values in vars(_shapes(graph, some, outline, bins)).items():
        if name != "relative":
            made[name] = made[name].copy()
            made[name][which] = values
    return CellShapes(**made)


def _bins(outline: Outlines) -> int:
    """Directions in which rims are told: a few for each texel of the widest cell's outline."""
    low, high = outline.box()
    around = 4 * float((high - low).max(initial=0))
    return int(np.clip(2 ** np.ceil(np.log2(max(around, 1))), _LEAST_BINS, _MOST_BINS))


def _shapes(graph: CellGraph, cells: Cells, outline: Outlines, bins: int) -> CellShapes:
    if not len(cells):
        none = np.zeros(0)
        spread, rim = np.zeros((0, 2, 2)), np.zeros((0, bins, 2), np.float32)
        return CellShapes(rim[:, 0], rim, rim[:, 0, 0], none, none, spread, np.zeros(0, np.int32), np.zeros(0, bool))
    low, high = outline.box()
    centre, rim, depth = _centred(outline, cells, bins)
    inside = (low > -0.5 + _BORDER).all(axis=1) & (high < np.array(graph.size) - 0.5 - _BORDER).all(axis=1)
    joint = graph.degree[graph.edges.ravel()[cells.halfedge]] > 2
    return CellShapes(
        centre,
        rim,
        depth,
        cells.area,
        cells.area / typical_area(cells.area),
        outline.spread(cells.centroid),
        np.add.reduceat(joint, cells.start[:-1], dtype=np.int32),
        inside | np.full(len(cells), graph.wrap),
    )


def _centred(
    outline: Outlines, cells: Cells, bins: int
) -> tuple[Float32[np.ndarray, "cell 2"], Float32[np.ndarray, "cell bin 2"], Float32[np.ndarray, "cell"]]:
    """Centres, rims around them and depths."""
    centre, depth = cells.centroid.astype(np.float32), np.zeros(len(cells), np.float32)
    rim = _rims(outline.start, outline.point.astype(np.float32), centre, bins)
    hidden = np.flatnonzero(_area(rim) < _SEEN * cells.area)
    if len(hidden):
        start, entry = some_rows(outline.start, hidden)
        point = outline.point[entry].astype(np.float32)
        place, deep = np.empty((len(hidden), 2), np.float32), np.empty(len(hidden), np.float32)
        launch(kernels.deepest, len(hidden), inputs=[start, point, _PROBES], outputs=[place, deep], grain=4)
        there = _rims(start, point, place, bins)
        better = _area(there) > _area(rim[hidden])
        centre[hidden[better]], rim[hidden[better]] = place[better], there[better]
        depth[hidden] = np.where(_area(rim[hidden]) < _SEEN * cells.area[hidden], deep, 0)
    return centre, rim, depth


def _rims(
    start: Int32[np.ndarray, "cells_plus_one"],
    point: Float32[np.ndarray, "point 2"],
    centre: Float32[np.ndarray, "cell 2"],
    bins: int,
) -> Float32[np.ndarray, "cell bin 2"]:
    """How far outlines lie from a place in each."""
    rim = np.empty((len(centre), bins, 2), np.float32)
    launch(kernels.rims, len(centre), inputs=[start, point, centre], outputs=[rim], grain=8)
    return rim


def _area(rim: Float32[np.ndarray, "n bin 2"]) -> Float32[np.ndarray, "n"]:
    """The area that is seen: triangles between rays."""
    t = np.arange(rim.shape[1]) * (4 / rim.shape[1])
    angle = np.arctan2(1 - np.abs((t + 1) % 4 - 2), np.abs(t - 2) - 1)
    length = rim[:, :, 0]
    between = np.sin(np.diff(angle, append=angle[0])).astype(np.float32)
    return np.abs((length * np.roll(length, -1, axis=1) * between).sum(axis=1)) / 2
