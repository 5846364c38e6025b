"""The seamless patch: the piece of a sketch, or of several, that continues itself best, bent so that it does.

Wang et al. 2014, §3.1.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float64

from texloom import draws
from texloom.errors import ParameterError
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.cutting import Cut, cut, reaching_border
from texloom.sketch.mesh.matching import match_crops
from texloom.sketch.mesh.seam import mirrored, seamless
from texloom.sketch.mesh.strands import Strands, edge_lengths, strands
from texloom.sketch.mesh.web import Web, web

_CROPS = 2048
_SMALLEST = 0.5  # side of a crop, of the sketch's
_TRIED = 12  # crops in order of their cost, until one can be bent without anything crossing
_WHOLE = 1.5  # texels by which edges at opposite borders of a sketch that tiles may miss each other
_INSETS = (1.5, 2.5, 4.0)  # texels of its border that a mirrored drawing loses
_BORDER = 1.5  # texels beside it where a line's end is no vertex: it was cut off
_MOST_LONG = 0.1  # share of the edges
_COVERED = 1e-6
_THINNER = 0.6  # of the least round cell of the sketch, the least round of a patch
_BLOCKS = 4  # a crop is judged by so many blocks along each side: none may be empty
_BINS = 64

Sketches = CellGraph | tuple[CellGraph, ...]
"""One sketch, or several used together."""

Seamless = tuple[CellGraph, Float64[np.ndarray, "4"], float]
"""A torus, the crop it was and the crop's cost."""


@dataclass(frozen=True, eq=False)
class Patch:
    """A piece of a sketch on a torus, and what later stages need of all sketches, laid side by side on one page."""

    graph: CellGraph
    sketch: int  # which of them it was cut from
    crop: Float64[np.ndarray, "4"]  # top, left, bottom, right in that sketch
    cost: float  # of matching itself, eq. 3; 0 for a sketch that tiles, infinite for a mirrored one
    mirrored: bool  # no piece matches itself: this one comes with its mirror images
    note: str | None  # what the user should know
    sheets: Float64[np.ndarray, "sketch 4"]  # top, left, bottom, right of every sketch on the page
    joints: Float64[np.ndarray, "joint 2"]  # where curves end on it, by row

    @cached_property
    def web(self) -> Web:
        """The triangles that keep it planar."""
        return web(self.graph)

    @cached_property
    def widest(self) -> float:
        """Texels that no cell exceeds, up and down or across."""
        cells = self.graph.cells()
        if not len(cells):
            return max(self.graph.size) / 4
        ends = np.stack([self.graph.curve[:, 2], -self.graph.curve[:, 2]], axis=1).reshape(-1, 2)[cells.halfedge]
        walk = np.cumsum(ends, axis=0)
        opens = cells.start[:-1]
        return float((np.maximum.reduceat(walk, opens) - np.minimum.reduceat(walk, opens)).max())


def seamless_patch(sketches: Sketches, seed: int) -> Patch:
    """The best of many crops, seamless: eqs 4-6. A sketch that tiles is taken whole.

    Of several sketches the one whose crop costs least, of those that cells cover.

    Crops have at least half the sketch's sides. Where different numbers of edges cross opposite sides of all of them,
    or none can be bent without edges that cross, the patch is the whole sketch with its three mirror images.

    Raises: ParameterError, if a sketch has no edges, no cells, or lines so close that no patch comes of it.
    """
    every = (sketches,) if isinstance(sketches, CellGraph) else sketches
    if not every or not all(len(sketch.edges) for sketch in every):
        raise ParameterError("the sketch has no edges: draw the borders of at least one cell")
    found = [_of_one(sketch, seed) for sketch in every]
    number = min(range(len(found)), key=lambda n: (not _covered(found[n][0]), found[n][2]))
    graph, crop, cost = found[number]
    if not len(graph.cells()):
        raise ParameterError("no piece of the sketch goes on as closed cells: draw cells side by side, over all of it")
    runs = [strands(sketch) for sketch in every]
    note = _long_edges(every[number], runs[number]) if cost > 0 else None
    return Patch(graph, number, crop, cost, bool(np.isinf(cost)), note, *_page(every, runs))


def _of_one(sketch: CellGraph, seed: int) -> Seamless:
    return (sketch, _all_of(sketch), 0.0) if sketch.wrap else _best(reaching_border(sketch), seed)


def _best(sketch: CellGraph, seed: int) -> Seamless:
    """The first patch that cells cover, none much thinner than the sketch's; else the least thin, else the mirrored.

    That may not be covered either, as where lines meet no others: then the first patch that there was.
    """
    first, best, roundest = None, None, 0.0
    enough = _THINNER * _roundness(sketch)
    for patch in _bent(sketch, seed):
        first = first or patch
        round_ = _roundness(patch[0]) if _covered(patch[0]) else 0.0
        if round_ > roundest:
            best, roundest = patch, round_
        if round_ > enough:
            break
    if best is not None:
        return best
    image = _image(sketch)
    if image is not None and (first is None or _covered(image[0])):
        return image
    if first is None:
        raise ParameterError("lines of the sketch all but touch, and no piece fits itself: draw them further apart")
    return first


def _image(sketch: CellGraph) -> Seamless | None:
    """Nearly all of the sketch with its mirror images, unless cutting it makes lines cross that came too close."""
    for inset in _INSETS:
        crop = _all_of(sketch) + np.array([1, 1, -1, -1]) * inset
        graph = mirrored(cut(sketch, crop))
        if len(graph.edges) and not len(graph.crossings()):
            return graph, crop, np.inf
    return None


def _bent(sketch: CellGraph, seed: int) -> Iterator[Seamless]:
    """The whole of a sketch that tiles, then crops, the cheapest first: those that can be bent."""
    whole = cut(sketch, _all_of(sketch))
    if _tiles(whole):
        graph = seamless(sketch, whole, inner=False)
        if graph is not None:
            yield graph, _all_of(sketch), 0.0
    crops = np.concatenate([random_crops(sketch.size, seed), _all_of(sketch)[None]])
    for crop, cost in _by_cost(sketch, crops):
        piece = cut(sketch, crop)
        graph = seamless(sketch, piece) if piece.matches else None
        if graph is not None:
            yield graph, crop, cost


def _covered(graph: CellGraph) -> bool:
    """Whether cells cover a torus: none of its faces closes around it or has others within."""
    return bool(abs(graph.cells().area.sum() / np.prod(graph.size) - 1) < _COVERED)


def _roundness(graph: CellGraph) -> float:
    """The least of the cells' areas over their outlines squared."""
    cells = graph.cells()
    if not len(cells):
        return 0.0
    outline = np.add.reduceat(edge_lengths(graph)[cells.halfedge // 2], cells.start[:-1])
    return float((cells.area / outline**2).min())


def random_crops(size: tuple[float, float], seed: int) -> Float64[np.ndarray, "crop 4"]:
    """Rectangles (top, left, bottom, right) in a drawing, from half its sides to the whole of them."""
    index = np.arange(_CROPS)
    sides = []
    for axis in (0, 1):
        share = _SMALLEST + (1 - _SMALLEST) * draws.uniform(seed, axis, 0, index=index).astype(np.float64)
        low = draws.uniform(seed, axis, 1, index=index) * (1 - share)
        sides.append(np.stack([low, low + share]) * size[axis] - 0.5)
    return np.stack([sides[0][0], sides[1][0], sides[0][1], sides[1][1]], axis=1)


def _by_cost(sketch: CellGraph, crops: Float64[np.ndarray, "crop 4"]) -> list[tuple[np.ndarray, float]]:
    """The crops worth trying, the cheapest first; those that nothing crosses one way or both last.

    A crop half as evenly filled as another is left out: an empty corner costs nothing, but would come again and again.
    """
    match = match_crops(sketch, crops)
    kept = np.flatnonzero(np.isfinite(match.cost))
    if not len(kept):
        return []
    even = _evenness(sketch, crops[kept])
    kept = kept[even >= max(even.max() / 2, 0)]
    bare = (match.crossings[kept] == 0).sum(axis=1)
    kept = kept[np.lexsort((match.cost[kept], bare))][:_TRIED]
    return [(crops[crop], float(match.cost[crop])) for crop in kept]


def _evenness(sketch: CellGraph, crops: Float64[np.ndarray, "crop 4"]) -> Float64[np.ndarray, "crop"]:
    """The least length of edges in a block of each crop, of the mean; -1 for a crop without any."""
    chords = sketch.flattened(1.0)
    middle, along = (chords.start + chords.end) / 2, chords.end - chords.start
    bounds = [np.linspace(-0.5, side - 0.5, _BINS + 1) for side in sketch.size]
    length = np.histogram2d(*middle.T, bins=bounds, weights=np.hypot(*along.T))[0]
    sums = np.pad(length, ((1, 0), (1, 0))).cumsum(axis=0).cumsum(axis=1)
    share = np.linspace(0, 1, _BLOCKS + 1)
    rows, columns = (
        np.rint((crops[:, axis, None] * (1 - share) + crops[:, axis + 2, None] * share + 0.5) / side * _BINS)
        for axis, side in enumerate(sketch.size)
    )
    corners = sums[rows.astype(int)[:, :, None], columns.astype(int)[:, None]]
    blocks = np.diff(np.diff(corners, axis=1), axis=2).reshape(len(crops), -1)
    mean = blocks.mean(axis=1)
    return np.where(mean > 0, blocks.min(axis=1) / np.maximum(mean, 1e-12), -1)


def _tiles(whole: Cut) -> bool:
    """Whether a whole sketch continues itself: what reaches a border goes on at the opposite one."""
    if not whole.matches or not any(len(low.vertex) for low, _ in whole.sides):
        return False
    gaps = [
        whole.graph.vertices[high.vertex, 1 - axis] - whole.graph.vertices[low.vertex, 1 - axis]
        for axis, (low, high) in enumerate(whole.sides)
    ]
    return bool(np.abs(np.concatenate(gaps)).max() <= _WHOLE)


def _all_of(sketch: CellGraph) -> Float64[np.ndarray, "4"]:
    return np.array([-0.5, -0.5, sketch.size[0] - 0.5, sketch.size[1] - 0.5])


def _page(
    sketches: Sequence[CellGraph], runs: Sequence[Strands]
) -> tuple[Float64[np.ndarray, "sketch 4"], Float64[np.ndarray, "joint 2"]]:
    """Sketches from left to right: where each lies, and the joints of all."""
    left = np.cumsum([0.0, *(sketch.size[1] for sketch in sketches)])[:-1]
    sheets = [_all_of(sketch) + [0, at, 0, at] for sketch, at in zip(sketches, left, strict=True)]
    joints = [_joints(sketch, run) + [0, at] for sketch, run, at in zip(sketches, runs, left, strict=True)]
    page = np.concatenate(joints)
    return np.stack(sheets), page[np.argsort(page[:, 0], kind="stable")]


def _joints(sketch: CellGraph, runs: Strands) -> Float64[np.ndarray, "joint 2"]:
    """The ends of curves, but where the drawing's border cuts them off."""
    size = np.array(sketch.size)
    beside = ((sketch.vertices < _BORDER) | (sketch.vertices > size - 1 - _BORDER)).any(axis=1)
    return sketch.vertices[runs.free & ~(beside & (sketch.degree == 1))]


def _long_edges(sketch: CellGraph, runs: Strands) -> str | None:
    """What to say of a sketch with edges longer than a third of it, §4.1: a crop has little room for them.

    Departure: one in ten may be so long, as the odd line along a border is.
    """
    most = min(sketch.size) / 3
    curve = np.unique(np.sort(runs.ends, axis=1), axis=0, return_index=True)[1]
    long = int((runs.length[curve] > most).sum())
    if long <= _MOST_LONG * len(curve):
        return None
    many = f"{long} of {len(curve)} edges are longer than a third of the sketch ({most:.0f} texels)"
    return f"{many}: draw more, smaller cells"
