"""A seamless patch laid side by side, to any size."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32

from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.patch import Patch
from texloom.sketch.mesh.strands import head_period


@dataclass(frozen=True, eq=False)
class Tiling:
    """A texture mesh before it is refined: on a torus with room for the texture, with what keeps it planar.

    Arrays are those of the patch's web, once for every tile.
    """

    graph: CellGraph
    patch: Patch
    scale: Float64[np.ndarray, "2"]  # texels of the texture in one of the sketch, along rows and columns
    loose: Bool[np.ndarray, "vertex"]
    carrier: Int32[np.ndarray, "point 2"]
    share: Float64[np.ndarray, "point"]
    corner: Int32[np.ndarray, "triangle 3"]

    def moved(self, by: Float64[np.ndarray, "vertex 2"]) -> CellGraph:
        """The graph with the ends of curves displaced and what lies between carried along."""
        count = len(self.patch.graph.vertices)  # the first of every tile's points
        tiles = len(by) // count
        first, second = self.carrier.reshape(tiles, -1, 2)[:, :count].reshape(-1, 2).T
        share = self.share.reshape(tiles, -1)[:, :count].reshape(-1, 1)
        return self.graph.moved(self.graph.vertices + (by[first] * (1 - share) + by[second] * share))


def tile(patch: Patch, size: tuple[int, int], *, scale: float, tileable: bool) -> Tiling:
    """The patch laid side by side over a texture of rows and columns, ``scale`` times as large as it was drawn.

    Where the texture is to tile, whole patches fill it, stretched along each side to do so.
    """
    graph, web = patch.graph, patch.web
    whole = np.array(graph.size) * scale
    repeats = np.maximum(np.rint(size / whole) if tileable else np.ceil(size / whole - 1e-9), 1).astype(np.int64)
    stretch = scale * (size / (repeats * whole) if tileable else np.ones(2))
    tiles = int(repeats.prod())
    at = np.stack(np.divmod(np.arange(tiles), repeats[1]), axis=1)

    def again(values: np.ndarray) -> np.ndarray:
        return np.tile(values, (tiles, *(1,) * (values.ndim - 1)))

    def named(part: np.ndarray, period: np.ndarray, count: int = len(graph.vertices)) -> np.ndarray:
        return _named(part, period, at, repeats, count)

    vertices = (graph.vertices + 0.5) * stretch - 0.5
    size_of_one = np.array(graph.size) * stretch
    rows, columns = (size_of_one * repeats).tolist()
    on_edges = np.stack([np.zeros((len(graph.edges), 2), np.int64), head_period(graph)], axis=1)
    places = (vertices + (at * size_of_one)[:, None]).reshape(-1, 2)
    return Tiling(
        CellGraph((rows, columns), places, named(graph.edges, on_edges), again(graph.curve * stretch), True),
        patch,
        stretch,
        loose=again(web.loose),
        carrier=named(web.carrier, web.carrier_period),
        share=again(web.share),
        corner=named(web.corner, web.corner_period, len(web.share)),
    )


def _named(
    part: Int[np.ndarray, "*shape"],
    period: Int[np.ndarray, "*shape 2"],
    at: Int[np.ndarray, "tile 2"],
    repeats: Int[np.ndarray, "2"],
    count: int,
) -> Int32[np.ndarray, "..."]:
    """For every tile the vertices, or other parts, meant by those of the patch's ``count``, ``period`` copies away."""
    own, beyond = part.ravel(), period.reshape(-1, 2)
    names = own.astype(np.int32) + (np.arange(len(at), dtype=np.int32) * count)[:, None]
    away = np.flatnonzero(beyond.any(axis=1))
    beside = (at[:, None] + beyond[away]) % repeats
    names[:, away] = own[away] + (beside @ np.array([repeats[1], 1])) * count
    return names.reshape(-1, *part.shape[1:])


def on_plane(graph: CellGraph, size: tuple[float, float], widest: float) -> CellGraph:
    """A torus cut open: all edges with an end in the texture or within ``widest`` texels of it.

    So cells no wider that reach into the texture are whole; beyond, edges may end anywhere.
    """
    period, count = np.array(graph.size), len(graph.vertices)
    along = graph.curve[:, 2]
    most = np.ceil((widest + np.abs(along).max(axis=0, initial=0)) / period).astype(np.int64)
    home = -np.floor((graph.vertices + 0.5) / period).astype(np.int64)
    tails, heads = graph.edges.T
    places = graph.vertices + home * period
    starts = places[tails]
    bounds = -0.5 - widest, np.array(size) - 0.5 + widest
    shifts = [np.arange(-copies, copies + 1) * side for copies, side in zip(most, period, strict=True)]
    copy, edge = np.divmod(np.flatnonzero(_reaching(starts, along, shifts, bounds)), max(len(along), 1))

    # Vertices by the copy they lie on: heads perhaps one further out
    beyond = np.rint((starts + along - places[heads]) / period).astype(np.int64)
    further = int(np.abs(beyond).max(initial=0))
    row, column = np.divmod(copy, 2 * most[1] + 1)
    wide = 2 * (most + further) + 1
    of_tail = (row + further) * wide[1] + column + further
    of_head = of_tail + (beyond @ np.array([wide[1], 1]))[edge]
    names = np.stack([of_tail, of_head], axis=1) * count + graph.edges[edge]
    kept, edges = _numbered(names, int(wide.prod()) * count)
    kept_copy, vertex = np.divmod(kept, count)
    shift = np.stack(np.divmod(kept_copy, wide[1]), axis=1) - most - further
    sides = float(size[0]), float(size[1])
    return CellGraph(sides, places[vertex] + shift * period, edges, graph.curve[edge])


def _reaching(
    start: Float64[np.ndarray, "edge 2"],
    along: Float64[np.ndarray, "edge 2"],
    shifts: list[np.ndarray],
    bounds: tuple[float, Float64[np.ndarray, "2"]],
) -> Bool[np.ndarray, "row_copy column_copy edge"]:
    """Which copies of edges have an end within bounds, shifted by so many texels along rows and columns."""
    inside = []
    for axis, by in enumerate(shifts):
        first = start[:, axis] + by[:, None]
        inside.append([(end > bounds[0]) & (end < bounds[1][axis]) for end in (first, first + along[:, axis])])
    rows, columns = inside
    return (rows[0][:, None] & columns[0]) | (rows[1][:, None] & columns[1])


def _numbered(names: Int[np.ndarray, "n 2"], count: int) -> tuple[Int[np.ndarray, "kept"], Int32[np.ndarray, "n 2"]]:
    """Those of so many names that occur, in order, and for every name its place among them."""
    used = np.zeros(count, bool)
    used[names] = True
    kept = np.flatnonzero(used)
    place = np.empty(count, np.int32)
    place[kept] = np.arange(len(kept))
    return kept, place[names]
