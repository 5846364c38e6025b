"""Sketches, samples and their kinds of cells, from the options of ``texloom sketch`` and ``surface --sketch``."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float32, Int32

from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.io.image import read_image
from texloom.sketch.design import Design
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.scale import alike
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.random import random_cells
from texloom.sketch.reading.detect import detect
from texloom.sketch.reading.read import read_sketch
from texloom.sketch.sample import SketchSample
from texloom.sketch.surface import Designed

RANDOM = "random"
_MOST_RANDOM = 16  # cells across a random sketch at most: larger textures repeat it
_FEWEST_RANDOM = 2
_ACROSS = 10  # cells across a texture that is grown over a surface,
_SMALLEST, _LARGEST = 256, 512  # and its sides, texels


@dataclass(frozen=True, eq=False)
class Drawn:
    """Sketches with cells of one size, and what was mended in which."""

    graphs: tuple[CellGraph, ...]
    mends: list[str]


def read_sketches(words: Sequence[str], *, size: tuple[int, int], cell: float | None, seed: int) -> Drawn:
    """Files, and for ``random`` cells ``cell`` texels across, for a texture of rows and columns.

    Raises: ParameterError, for random cells whose size nothing tells; FileError or ExemplarError, for a bad file.
    """
    graphs, mends = [], []
    for word in words:
        if word == RANDOM:
            graphs.append(_random(size, cell, seed))
            continue
        graph, notes = read_sketch(word)
        graphs.append(graph)
        mends += [f"{Path(word).name}: {note}" for note in notes]
    return Drawn(alike(graphs), mends)


def _random(size: tuple[int, int], cell: float | None, seed: int) -> CellGraph:
    if cell is None:
        raise ParameterError(f"{RANDOM} cells are as large as a sample's: give a SAMPLE")
    sides = [float(np.clip(side, _FEWEST_RANDOM * cell, _MOST_RANDOM * cell)) for side in size]
    return random_cells((sides[0], sides[1]), cell=cell, seed=seed)


def read_cells(
    stacks: Sequence[Exemplar], names: Sequence[Path], *, drawings: Sequence[Path] = (), kinds: Path | None = None
) -> tuple[SketchSample, list[str]]:
    """Samples with their cells, detected or drawn (one drawing each), and what was mended in the drawings.

    Raises: FileError or ExemplarError, for a bad file or a sample without cells.
    """
    graphs, mends = [], []
    for number, (stack, name) in enumerate(zip(stacks, names, strict=True)):
        if not drawings:
            graphs.append(_detected(stack, name.name))
            continue
        graph, notes = read_sketch(drawings[number], size=(float(stack.shape[0]), float(stack.shape[1])))
        graphs.append(graph)
        mends += [f"{drawings[number].name}: {note}" for note in notes]
    return SketchSample.of(stacks, graphs, colours=None if kinds is None else picture(kinds)), mends


def _detected(stack: Exemplar, name: str) -> CellGraph:
    try:
        return detect(stack)
    except ExemplarError as error:
        raise ExemplarError(
            f"{name} shows no cells with lines between them: draw them, --sample-sketch FILE"
        ) from error


def designed(
    words: Sequence[str],
    stacks: Sequence[Exemplar],
    names: Sequence[Path],
    *,
    drawings: Sequence[Path] = (),
    radius: float | None = None,
    seed: int,
) -> tuple[Designed, list[str]]:
    """A texture of the sketches' cells to grow over a surface, and what was mended in drawings."""
    sample, mends = read_cells(stacks, names, drawings=drawings)
    cell = sample.cell_size
    side = int(np.clip(round(_ACROSS * cell), _SMALLEST, _LARGEST))
    drawn = read_sketches(words, size=(side, side), cell=cell, seed=seed)
    mesh = TextureMesh.of(drawn.graphs[0], (side, side), cell=cell, radius=radius)
    return Designed.of(Design(sketch=drawn.graphs, sample=sample, mesh=mesh, seed=seed)), drawn.mends + mends


def picture(path: Path) -> Float32[np.ndarray, "row column 3"]:
    """A picture as it is painted: stored values in [0, 1], grey as three equal channels, its opacity left out."""
    image = np.clip(read_image(path, kind="data").image, 0, 1)
    return np.ascontiguousarray(np.broadcast_to(image[..., :3], (*image.shape[:2], 3)), np.float32)


def told_kinds(sample: SketchSample, shown: Int32[np.ndarray, "cell"], names: Sequence[str]) -> list[Mapping]:
    """Every kind of cell: its sample where there are several, the colour that asks for it, its share of the cells."""
    palette, told = sample.kinds.palette, []
    share = np.bincount(shown, minlength=len(palette)) / max(len(shown), 1)
    for number, colour in enumerate(palette):
        of = {"sample": names[number]} if len(names) > 1 else {}
        code = "".join(f"{round(255 * float(part)):02x}" for part in np.clip(colour, 0, 1))
        told.append({**of, "colour": f"#{code}", "share": share[number]})
    return told
