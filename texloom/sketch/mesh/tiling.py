"""A seamless patch laid side by side, to any size."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float64, Int, Int32

from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.patch import Patch
from texloom.sketch.mesh.strands import carry, head_period


@dataclass(frozen=True, eq=False)
class Tiling:
    """A texture mesh before it is refined: on a torus with room for the texture, with what keeps it planar.

    Arrays are those of the patch's strands and web, once for every tile.
    """

    graph: CellGraph
    patch: Patch
    scale: Float64[np.ndarray, "2"]  # texels of the texture in one of the sketch, along rows and columns
    free: Bool[np.ndarray, "vertex"]
    loose: Bool[np.ndarray, "vertex"]
    ends: Int32[np.ndarray, "edge 2"]
    share: Float64[np.ndarray, "edge 2"]
    corner: Float64[np.ndarray, "triangle 3 2"]
    carrier: Int32[np.ndarray, "triangle 3 2"]
    corner_share: Float64[np.ndarray, "triangle 3"]

    def moved(self, by: Float64[np.ndarray, "vertex 2"]) -> CellGraph:
        """The graph with the ends of curves displaced and what lies between carried along."""
        carried = carry(by, free=self.free, edges=self.graph.edges, ends=self.ends, share=self.share)
        return self.graph.moved(self.graph.vertices + carried)


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

    def named(vertex: np.ndarray, period: np.ndarray) -> np.ndarray:
        return _named(vertex, period, at, repeats, len(graph.vertices))

    vertices = (graph.vertices + 0.5) * stretch - 0.5
    size_of_one = np.array(graph.size) * stretch
    rows, columns = (size_of_one * repeats).tolist()
    on_edges = np.stack([np.zeros((len(graph.edges), 2), np.int64), head_period(graph)], axis=1)
    places = (vertices + (at * size_of_one)[:, None]).reshape(-1, 2)
    return Tiling(
        CellGraph((rows, columns), places, named(graph.edges, on_edges), again(graph.curve * stretch), True),
        patch,
        stretch,
        free=again(web.strands.free),
        loose=again(web.loose),
        ends=named(web.strands.ends, web.strands.period),
        share=again(web.strands.share),
        corner=again((web.corner + 0.5) * stretch - 0.5),
        carrier=named(web.carrier, web.period),
        corner_share=again(web.share),
    )


def _named(
    vertex: Int[np.ndarray, "*shape"],
    period: Int[np.ndarray, "*shape 2"],
    at: Int[np.ndarray, "tile 2"],
    repeats: Int[np.ndarray, "2"],
    count: int,
) -> Int32[np.ndarray, "..."]:
    """For every tile the vertices meant by those of the patch, ``period`` copies away."""
    vertex_of = vertex.ravel()
    names = vertex_of + (np.arange(len(at)) * count)[:, None]
    away = np.flatnonzero(period.reshape(-1, 2).any(axis=1))
    beside = (at[:, None] + period.reshape(-1, 2)[away]) % repeats
    names[:, away] = vertex_of[away] + (beside @ np.array([repeats[1], 1])) * count
    return names.reshape(-1, *vertex.shape[1:]).astype(np.int32)


def on_plane(graph: CellGraph, size: tuple[float, float], widest: float) -> CellGraph:
    """A torus cut open: all edges with an end in the texture or within ``widest`` texels of it.

    So cells no wider that reach into the texture are whole; beyond, edges may end anywhere.
    """
    period, count = np.array(graph.size), len(graph.vertices)
    low, high = -0.5 - widest, np.array(size) - 0.5 + widest
    along = graph.curve[:, 2]
    most = np.ceil((widest + np.abs(along).max(axis=0, initial=0)) / period).astype(np.int64)
    spans = 2 * most + 1
    copies = np.stack(np.divmod(np.arange(spans.prod()), spans[1]), axis=1) - most
    home = -np.floor((graph.vertices + 0.5) / period).astype(np.int64)
    tails, heads = graph.edges.T
    places = graph.vertices + home * period
    starts = places[tails] + (copies * period)[:, None]
    copy, edge = np.nonzero(_within(starts, low, high) | _within(starts + along, low, high))

    # Vertices by the copy they lie on: heads perhaps one further out
    beyond = home[tails] + head_period(graph) - home[heads]
    further = int(np.abs(beyond).max(initial=0))
    wide = spans + 2 * further
    on_copy = np.stack([copies[copy], copies[copy] + beyond[edge]], axis=1) + most + further
    names = (on_copy @ np.array([wide[1], 1])) * count + graph.edges[edge]
    used = np.zeros(int(wide.prod()) * count, bool)
    used[names] = True
    kept = np.flatnonzero(used)
    shift = np.stack(np.divmod(kept // count, wide[1]), axis=1) - most - further
    edges = (np.cumsum(used) - 1)[names].astype(np.int32)
    return CellGraph((float(size[0]), float(size[1])), places[kept % count] + shift * period, edges, graph.curve[edge])


def _within(
    places: Float64[np.ndarray, "copy edge 2"], low: float, high: Float64[np.ndarray, "2"]
) -> Bool[np.ndarray, "copy edge"]:
    rows, columns = places[..., 0], places[..., 1]
    return (rows > low) & (rows < high[0]) & (columns > low) & (columns < high[1])
