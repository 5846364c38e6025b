"""A sketch from whatever file holds it: an SVG drawing, a drawn picture, or an example whose cells are detected."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from texloom.errors import ParameterError, TexloomError
from texloom.io.stack import read_exemplar
from texloom.io.svg import read_svg
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.detect import detect
from texloom.sketch.reading.drawing import graph_of_drawing, is_drawing, read_drawing
from texloom.sketch.reading.mends import Mend
from texloom.sketch.reading.strokes import graph_of

_Sketch = tuple[CellGraph, list[Mend]]


def read_sketch(path: str | Path, *, size: tuple[float, float] | None = None) -> tuple[CellGraph, list[Mend]]:
    """The cell graph of a file, stretched to ``size`` (rows, columns) where given, and what was mended.

    ``.svg`` is read as strokes, a picture of thin lines on even paper as a drawing, any other picture or folder of maps
    as an example texture.

    Raises: FileError or ExemplarError, if it cannot be read, closes no cell, or its elements overlap.
    """
    path = Path(path)
    if size is not None and not min(size) > 0:
        raise ParameterError(f"a sketch of {size[1]:g}×{size[0]:g} texels: both must be above 0")
    graph, notes = _read(path)
    if size is None:
        return graph, notes
    across = size[0] / graph.size[0], size[1] / graph.size[1]
    return graph.resized(size), [
        replace(note, row=(note.row + 0.5) * across[0] - 0.5, column=(note.column + 0.5) * across[1] - 0.5)
        for note in notes
    ]


def _read(path: Path) -> _Sketch:
    if path.suffix.lower() == ".svg":
        strokes = read_svg(path)
        return _named(path, lambda: graph_of(strokes))
    if path.is_dir():
        return _named(path, lambda: (detect(read_exemplar(path)), []))
    grey = read_drawing(path)
    if is_drawing(grey):
        return _named(path, lambda: graph_of_drawing(grey))
    return _named(path, lambda: (detect(read_exemplar(path)), []))


def _named(path: Path, read: Callable[[], _Sketch]) -> _Sketch:
    """What ``read`` gives; its complaints begin with the file's name."""
    try:
        return read()
    except TexloomError as error:
        if path.name in str(error):
            raise
        raise type(error)(f"{path.name}: {error}") from error
