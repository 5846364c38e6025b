"""Samples as the sketch method sees them: their cells, kinds of cells, and maps of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int32

from texloom.arrays import Image, in_fours
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.join import join
from texloom.sketch.cells import Cells, typical_area
from texloom.sketch.filling.kinds import Kinds, kinds_of
from texloom.sketch.filling.maps import FeatureMaps, feature_maps
from texloom.sketch.filling.shapes import CellShapes, cell_shapes
from texloom.sketch.filling.warp import best_inside
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.detect import detect


@dataclass(frozen=True, eq=False)
class SketchSample:
    """One or several samples, their cells drawn or detected, and the kind of every cell.

    Several samples lie side by side in one exemplar (``texloom.exemplar.join``) and their cells in one graph; the cells
    of each are of a kind of their own, in the order given.
    """

    exemplar: Exemplar
    graph: CellGraph
    cells: Cells
    maps: FeatureMaps
    kinds: Kinds
    owner: Int32[np.ndarray, "cell"]  # the number of the sample that each cell is of

    @staticmethod
    def of(
        exemplars: Sequence[Exemplar],
        graphs: Sequence[CellGraph | None] = (),
        *,
        colours: Float32[np.ndarray, "row column channel"] | None = None,
    ) -> "SketchSample":
        """``graphs`` are their cells, stretched over them; None, or left out: detected.

        ``colours`` (stored values in [0, 1], stretched over the one sample) tell kinds apart.

        Raises: ExemplarError, if no cells are found, or a mask leaves none whole; ParameterError, for colours over
        several samples, or graphs that are not as many or lie on a torus.
        """
        if graphs and len(graphs) != len(exemplars):
            raise ParameterError(f"{len(graphs)} cell meshes for {len(exemplars)} samples: give one each, or none")
        if colours is not None and len(exemplars) > 1:
            raise ParameterError(f"a map of kinds is for one sample, but {len(exemplars)} were given: each is a kind")
        drawn = [graph or detect(one) for one, graph in zip(exemplars, graphs or [None] * len(exemplars), strict=True)]
        joined = join(exemplars)
        size = (float(joined.exemplar.shape[0]), float(joined.exemplar.shape[1]))
        if any(graph.wrap for graph in drawn):
            raise ParameterError("a sample's cells lie in its picture, these go around a torus: cut them to it first")
        drawn = [one.resized((float(p.rows), float(p.columns))) for one, p in zip(drawn, joined.parts, strict=True)]
        graph, of_vertex = _together(drawn, [(part.row, part.column) for part in joined.parts], size)
        cells = graph.cells()
        maps = feature_maps(graph, cells)
        maps.closeness[~joined.exemplar.usable] = 0  # no texel is to begin there
        owner = of_vertex[graph.edges[cells.halfedge[cells.start[:-1]] // 2, 0]]
        known = Kinds(owner, _palette(len(exemplars)))
        if colours is not None:
            known = kinds_of(maps.cell, colours, len(cells))
        sample = SketchSample(joined.exemplar, graph, cells, maps, known, owner)
        if len(cells) and not joined.exemplar.usable.all() and not sample.unmasked.any():
            raise ExemplarError(
                f"masked texels lie in each of the sample's {len(cells)} cells: leave some of them whole"
            )
        return sample

    @cached_property
    def shapes(self) -> CellShapes:
        """Of its cells, each beside a typical one of its own sample."""
        shapes = cell_shapes(self.graph, self.cells)
        return replace(shapes, relative=shapes.area / self._typical[self.owner])

    @cached_property
    def image(self) -> Image:
        """What texels are compared by."""
        return in_fours(match_image(self.exemplar))

    @cached_property
    def inside(self) -> Literal["radial", "scale"]:
        """How its cells take being laid into others."""
        return best_inside(self.image, self.maps)

    @property
    def unmasked(self) -> Bool[np.ndarray, "cell"]:
        """Whether all of a cell may be used."""
        masked = self.maps.cell[~self.exemplar.usable]
        return np.bincount(masked[masked >= 0], minlength=len(self.cells)) == 0

    @property
    def cell_size(self) -> float:
        """Texels: the square root of a typical cell's area, of several samples with cells their geometric mean.

        Raises: ExemplarError, if there is no cell.
        """
        if not len(self.cells):
            raise ExemplarError("the sample has no cells: give it a sketch that closes some")
        return float(np.exp(np.log(self._typical[np.unique(self.owner)]).mean() / 2))

    @property
    def _typical(self) -> Float64[np.ndarray, "sample"]:
        """The area of a typical cell of each sample, up to the last that has any; 0 for one that has none."""
        areas = [self.cells.area[self.owner == number] for number in range(int(self.owner.max(initial=-1)) + 1)]
        return np.array([typical_area(area) if len(area) else 0.0 for area in areas])


def _together(
    graphs: Sequence[CellGraph], corners: Sequence[tuple[int, int]], size: tuple[float, float]
) -> tuple[CellGraph, Int32[np.ndarray, "vertex"]]:
    """The graphs side by side, each from its corner on, and which one every vertex is of."""
    first = np.cumsum([0, *(len(graph.vertices) for graph in graphs)])
    vertices = [graph.vertices + np.array(corner) for graph, corner in zip(graphs, corners, strict=True)]
    edges = [graph.edges + number for graph, number in zip(graphs, first, strict=False)]
    curve = np.concatenate([graph.curve for graph in graphs])
    owner = np.repeat(np.arange(len(graphs), dtype=np.int32), np.diff(first))
    return CellGraph(size, np.concatenate(vertices), np.concatenate(edges).astype(np.int32), curve), owner


def _palette(count: int) -> Float32[np.ndarray, "kind 3"]:
    """A colour a sample, as far from each other as eight corners of the cube and their middles allow."""
    corners = np.array([[(n >> bit) & 1 for bit in (2, 1, 0)] for n in (0, 4, 2, 1, 6, 5, 3, 7)], np.float32)
    darker = [corners[1:] * np.float32(0.5**level) for level in range(1, 2 + count // len(corners[1:]))]
    return np.concatenate([corners, *darker])[:count]
