"""Sketches and samples that the sketch benchmarks put together."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import UInt8

from benchmarks.data import SEED
from texloom.io.stack import read_exemplar
from texloom.output.gather import gather_images
from texloom.output.image import encoded_picture
from texloom.sketch.design import Design
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.reading.read import read_sketch
from texloom.sketch.sample import SketchSample

Picture = UInt8[np.ndarray, "row column channel"]
Rows = list[dict[str, Any]]

PAIRS = {  # sample: sketch
    "scales-green-cells-192": "jackfruit-hex-cells-512",
    "stones-brown-wall-128": "voronoi-cells-512",
    "bricks-red-128": "bricks-512",
    "beans-192": "open-cells-gaps-512",
    "bricks-brown-192": "bricks-512",
    "mud-cracked-400": "cracker-cracks-512",
}
SIDE = 256  # texels of a texture


def load_sample(data: Path, name: str) -> SketchSample:
    """A sample, its cells detected."""
    return SketchSample.of([read_exemplar(data / "exemplars" / f"{name}.png")])


def load_sketch(data: Path, name: str) -> CellGraph:
    """A drawing's cells."""
    return read_sketch(data / "sketches" / f"{name}.svg")[0]


def mesh_of(sketch: CellGraph, sample: SketchSample, side: int = SIDE) -> TextureMesh:
    """Cells as large as the sample's, refined as by default."""
    return TextureMesh.of(sketch, (side, side), cell=sample.cell_size)


def design_of(sketch: CellGraph, sample: SketchSample, side: int = SIDE) -> Design:
    """Ours, at its defaults."""
    return Design(sketch=sketch, sample=sample, mesh=mesh_of(sketch, sample, side), seed=SEED)


def shown(design: Design, *, copied: bool = False) -> Picture:
    """The leading map of a texture, as it is shown; or each texel ``copied`` from the sample's nearest."""
    rows, columns = design.mesh.size
    exemplar, sources = design.sample.exemplar, design.sources
    if copied:
        sources = replace(sources, position=np.rint(sources.position))
    maps = gather_images(sources, exemplar, rows=rows, columns=columns)
    return encoded_picture(next(iter(maps.values())).image)
