"""From a sketch and a sample to a texture, stage by stage; a change makes anew only what depends on it."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float32, Float64, Int32

from texloom.errors import ParameterError
from texloom.sketch.cells import Cells, again
from texloom.sketch.filling.kinds import Assignment, Deal, neighbours, painted
from texloom.sketch.filling.maps import FeatureMaps, changed, feature_maps, redraw
from texloom.sketch.filling.pixels import PixelSynthesis
from texloom.sketch.filling.shapes import CellShapes, cell_shapes, moved_shapes
from texloom.sketch.filling.warp import Initialization, Start
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.patch import Patch, Sketches
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.mesh.tiling import Tiling
from texloom.sketch.sample import SketchSample
from texloom.sources import SourceMap
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.visits import Guide

_READS = {  # each stage, in order, and what it is made from: inputs of the design, and stages before it
    "patch": ("sketch", "seed"),
    "tiling": ("patch", "size", "scale", "tileable"),
    "graph": ("tiling", "radius", "iterations", "strength", "seed"),
    "cells": ("graph",),
    "maps": ("graph", "cells"),
    "shapes": ("graph", "cells"),
    "assignment": ("graph", "cells", "maps", "shapes", "sample", "pattern", "deal", "seed"),
    "guide": ("sample", "pixels"),
    "start": ("maps", "shapes", "assignment", "sample", "initialization", "seed"),
    "canvas": ("guide", "maps", "start", "assignment", "pixels"),
}


@dataclass(frozen=True, eq=False, kw_only=True)
class Design:
    """A texture designed by a sketch (Wang et al. 2014): sketch → texture mesh → maps → first image → texture.

    Every stage is a property, made when first asked for. ``changed(...)`` is the design with other inputs; it keeps all
    stages that do not depend on them. ``moved`` moves vertices of the texture mesh and makes anew only the texels
    around. ``pattern`` (stored values in [0, 1], stretched over the texture) says which kind of cell goes where.

    Raises: ParameterError, for a pattern of another shape than the kinds' colours; and the stages what they do.
    """

    sketch: Sketches
    sample: SketchSample
    mesh: TextureMesh
    pattern: Float32[np.ndarray, "row column channel"] | None = None
    deal: Deal = field(default_factory=Deal)
    initialization: Initialization | None = None  # None: ours, as what is inside the sample's cells takes it
    pixels: PixelSynthesis = field(default_factory=PixelSynthesis)
    seed: int = 0

    def __post_init__(self) -> None:
        if self.pattern is not None:
            channels = self.sample.kinds.palette.shape[1]
            if self.pattern.ndim != 3 or self.pattern.shape[2] != channels or not self.pattern.size:
                shape = "×".join(map(str, self.pattern.shape))
                raise ParameterError(f"a pattern is rows × columns × {channels} colours in [0, 1], not {shape}")

    @cached_property
    def patch(self) -> Patch:
        """The seamless patch of the sketch (eqs 1 to 6)."""
        return self.mesh.patch(self.sketch, self.seed)

    @cached_property
    def tiling(self) -> Tiling:
        """The patch laid side by side."""
        return self.mesh.tiled(self.patch)

    @cached_property
    def graph(self) -> CellGraph:
        """The texture mesh (eqs 7, 8)."""
        return self.mesh.refined(self.tiling, self.seed)

    @cached_property
    def cells(self) -> Cells:
        """Of the texture mesh.

        Raises: ParameterError, if it has none.
        """
        cells = self.graph.cells()
        if not len(cells):
            raise ParameterError("no cell of the sketch fits into the texture: raise its size, or lower its scale")
        return cells

    @cached_property
    def maps(self) -> FeatureMaps:
        """Distance and orientation of every texel (eqs 9 to 12)."""
        return feature_maps(self.graph, self.cells)

    @cached_property
    def shapes(self) -> CellShapes:
        """Of the cells of the texture mesh."""
        return cell_shapes(self.graph, self.cells)

    @cached_property
    def assignment(self) -> Assignment:
        """The cell of the sample that each cell shows: of the kind that the pattern has there, or of any."""
        known, kinds = self.sample.kinds, None
        if self.pattern is not None:
            wanted = painted(self.maps.cell, self.pattern, palette=known.palette, count=len(self.cells))
            kinds = known.of_cell, wanted
        beside = neighbours(self.graph, self.cells)
        given = {"kinds": kinds, "owner": self.sample.owner, "usable": self.sample.unmasked}
        return self.deal.run(self.sample.shapes, self.shapes, beside, **given, seed=self.seed)

    @property
    def kinds(self) -> Int32[np.ndarray, "cell"]:
        """The kind of every cell."""
        return self.sample.kinds.of_cell[self.assignment.source]

    @cached_property
    def guide(self) -> Guide:
        """What pixel synthesis learns from the sample."""
        sample = self.sample
        return self.pixels.guide(sample.exemplar, sample.image, sample.maps, sample.kinds.of_cell)

    @cached_property
    def start(self) -> Start:
        """The first image (eq. 13, figs 9 to 11)."""
        sample = (self.sample.maps, self.sample.shapes)
        return self._laying.run(sample, (self.maps, self.shapes), self.assignment, seed=self.seed)

    @property
    def _laying(self) -> Initialization:
        return self.initialization or Initialization(inside=self.sample.inside)

    @cached_property
    def canvas(self) -> Canvas:
        """The texture (fig. 13)."""
        return self.pixels.run(self.guide, self.maps, self.start, self.kinds)

    @property
    def sources(self) -> SourceMap:
        """The texture, in the order of its rows: one source a texel."""
        sources = self.canvas.sources()
        kept = (self.canvas.position == self.start.position.reshape(-1, 2)).all(axis=1)
        scale = np.where(kept, self.start.scale.ravel(), np.float32(1))
        return replace(sources, scale=scale[:, None])

    def changed(self, **inputs: Any) -> "Design":
        """The design with other inputs, and what of this one still holds."""
        stale = set(inputs)
        if "mesh" in inputs:
            settings = vars(self.mesh)
            stale |= {name for name, value in vars(inputs["mesh"]).items() if value != settings[name]}
        design = replace(self, **inputs)
        for stage, reads in _READS.items():
            if stale.intersection(reads):
                stale.add(stage)
            elif stage in self.__dict__:
                design.__dict__[stage] = self.__dict__[stage]
        return design

    def moved(self, vertices: Float64[np.ndarray, "vertex 2"]) -> "Design":
        """The design with the vertices of its texture mesh elsewhere; cells keep what they show.

        Texels around are chosen beside what others show already, so they may differ from those of a design made anew.

        Raises: ParameterError, if they are not as many, not finite, if edges would cross or a cell turn over.
        """
        vertices = np.asarray(vertices, np.float64)
        if vertices.shape != self.graph.vertices.shape or not np.isfinite(vertices).all():
            count = len(self.graph.vertices)
            raise ParameterError(f"a move takes {count} places of 2 finite numbers, not an array of {vertices.shape}")
        graph = self.graph.moved(vertices)
        cells = again(graph, self.cells)
        flipped = np.count_nonzero(cells.area <= 0)
        if flipped:
            raise ParameterError(f"{flipped} cells would turn over: move their vertices less far")
        crossed = _newly_crossed(self.graph, graph)
        if crossed:
            raise ParameterError(f"{crossed} pairs of edges would cross: move their vertices less far")
        window = changed(self.maps, self.graph, graph, self.cells)
        maps, start, canvas = _copy(self.maps), _copy(self.start), _copy(self.canvas)
        redraw(maps, graph, cells, window=window)
        beside = cells.beside(graph.moved_from(self.graph))
        shapes = moved_shapes(self.shapes, graph, cells, beside[beside >= 0])
        sample = (self.sample.maps, self.sample.shapes)
        self._laying.again(start, sample, (maps, shapes), self.assignment, window=window, seed=self.seed)
        self.pixels.again(canvas, self.guide, maps, start, self.kinds, window=window)
        design = replace(self)
        made = {"graph": graph, "cells": cells, "maps": maps, "shapes": shapes, "start": start, "canvas": canvas}
        design.__dict__.update({stage: made.get(stage, getattr(self, stage)) for stage in _READS})
        return design


def _newly_crossed(before: CellGraph, after: CellGraph) -> int:
    """Pairs of edges that cross only after a move; of those around what moved, for no others can."""
    moved = after.moved_from(before)
    if not moved.any():
        return 0
    low, high = after.curves.min(axis=1), after.curves.max(axis=1)
    first, last = low[moved].min(axis=0), high[moved].max(axis=0)
    near = np.flatnonzero(((high >= first) & (low <= last)).all(axis=1))
    if after.wrap and ((first < 0) | (last > after.size)).any():
        near = np.arange(len(moved))
    met = [{tuple(pair) for pair in graph.part(near).crossings().tolist()} for graph in (before, after)]
    return len(met[1] - met[0])


def _copy(arrays: Any) -> Any:
    """A dataclass of arrays with its own copies of them."""
    own = {name: value.copy() for name, value in vars(arrays).items() if isinstance(value, np.ndarray)}
    return replace(arrays, **own)
