"""What shows of a graph on its page: whole cells, and all edges that reach into it."""

import numpy as np
from jaxtyping import Bool, Float64

from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.tiling import on_plane


def shown_curves(graph: CellGraph) -> Float64[np.ndarray, "curve 4 2"]:
    """The edges that reach into the page and those around cells that do; of a torus in every copy that does."""
    if graph.wrap:
        graph = on_plane(graph, graph.size, max(graph.size))
    cells, curves = graph.cells(), graph.curves
    low, high = curves.min(axis=1), curves.max(axis=1)
    shown = _on_page(low, high, graph.size)
    if len(cells):
        edge, opens = cells.halfedge // 2, cells.start[:-1]
        reach = np.minimum.reduceat(low[edge], opens), np.maximum.reduceat(high[edge], opens)
        shown[edge[_on_page(*reach, graph.size)[cells.cell]]] = True
    return curves[shown]


def _on_page(
    low: Float64[np.ndarray, "box 2"], high: Float64[np.ndarray, "box 2"], size: tuple[float, float]
) -> Bool[np.ndarray, "box"]:
    within = (high > -0.5) & (low < np.array(size) - 0.5)
    return within[:, 0] & within[:, 1]
