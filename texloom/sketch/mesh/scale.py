"""How large the cells of a drawing are, and drawings brought to one size of cells."""

from collections.abc import Sequence

import numpy as np

from texloom.errors import ParameterError
from texloom.sketch.cells import typical_area
from texloom.sketch.graph import CellGraph


def cell_size(graph: CellGraph) -> float:
    """Texels: the square root of a typical cell's area.

    Raises: ParameterError, if it has no cells.
    """
    area = graph.cells().area
    if not len(area):
        raise ParameterError("the sketch has no cells: close the borders of at least one")
    return float(np.sqrt(typical_area(area)))


def alike(sketches: Sequence[CellGraph]) -> tuple[CellGraph, ...]:
    """The sketches, each enlarged until its typical cell is as large as the first's.

    Raises: ParameterError, if one has no cells.
    """
    sizes = [cell_size(sketch) for sketch in sketches]
    return tuple(_enlarged(sketch, sizes[0] / size) for sketch, size in zip(sketches, sizes, strict=True))


def _enlarged(graph: CellGraph, by: float) -> CellGraph:
    return graph if by == 1 else graph.resized((graph.size[0] * by, graph.size[1] * by))
