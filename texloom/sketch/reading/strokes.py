"""Strokes to a cell graph: split where they cross, closed where they nearly meet, curves again at the end."""

import numpy as np
from jaxtyping import Bool

from texloom.errors import FileError
from texloom.io.svg import Strokes
from texloom.sketch.bezier import points_at, steps
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.fitting import curved
from texloom.sketch.reading.ink import cells_of_ink
from texloom.sketch.reading.lines import Lines, noded
from texloom.sketch.reading.mending import WELD, Draft, cells_of, mend, typical_cell
from texloom.sketch.reading.mends import Mend
from texloom.sketch.reading.overlap import refuse_overlap

_FLAT = 2e-3  # typical cells from a curve to the chords it is split by
_NEAR = 6e-3  # typical cells from the lines to the curves laid through them
_OUTLINES = 0.4  # share of cells with an outline of their own from which all are drawn apart
_FEWEST_OUTLINES = 3
_PAGE = 768  # texels of the page on which cells drawn apart are brought together
_BLUR = 0.8  # texels there that a border may be off
_MOST_CHORDS = 400_000


def graph_of(strokes: Strokes) -> tuple[CellGraph, list[Mend]]:
    """The planar graph of a drawing's cells, and what was mended on the way, with places.

    Tolerances are shares of the typical cell, which is told from the length drawn and the area covered: overshoots to
    0.2, gaps to 0.4, lines drawn double to 0.08 of it. Cells drawn as outlines beside each other share the middle
    between them. Open ends near the drawing's border stay. Curves come back within 0.006 of a cell.

    Raises: FileError, if nothing lies on the page, no cell is closed, or outlines overlap.
    """
    lines = _lines(strokes)
    low, high = lines.vertices.min(axis=0), lines.vertices.max(axis=0)
    if (high < -0.5).any() or (low > np.array(strokes.size) - 0.5).any():
        rows, columns = strokes.size
        raise FileError(f"nothing is drawn on the page of {columns:.0f}×{rows:.0f}: move what lies beside onto it")
    draft = Draft(noded(lines.vertices, lines.edges, weld=WELD * typical_cell(lines)), np.array(strokes.size))
    mend(draft)
    cells = cells_of(draft.lines)
    if not len(cells):
        raise FileError(
            f"the drawing closes no cell: gaps between the strokes are wider than {0.4 * draft.cell:.0f} texels"
        )
    refuse_overlap(draft.lines, len(cells))
    tolerance = _NEAR * draft.cell
    if _drawn_apart(draft.lines, len(cells)):
        together, notes, blur = _brought_together(draft)
        if 2 * len(cells_of(together)) >= len(cells):
            return curved(strokes.size, together, tolerance=max(tolerance, blur)), notes
    return curved(strokes.size, draft.lines, tolerance=tolerance), list(
        {str(note): note for note in draft.mends}.values()
    )


def _brought_together(draft: Draft) -> tuple[Lines, list[Mend], float]:
    """Cells drawn apart, the ground between them divided; what was mended, and the texels a border may be off."""
    scale = _PAGE / float(draft.size.max())
    page, notes = cells_of_ink(_inked(draft.lines, draft.size, scale))
    notes = [Mend(note.what, note.row / scale, note.column / scale) for note in notes]
    return Lines((page.vertices + 0.5) / scale - 0.5, page.edges), notes, _BLUR / scale


def _lines(strokes: Strokes) -> Lines:
    """All strokes as chords, still crossing."""
    curves = strokes.curves
    rough = np.abs(np.diff(curves, axis=1)).sum()
    cell = 2 * np.ptp(curves.reshape(-1, 2), axis=0).prod() / max(rough, 1e-12)
    count = steps(curves, max(_FLAT * cell, rough / _MOST_CHORDS, 1e-9))
    which = np.repeat(np.arange(len(curves)), count)
    place = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    start = points_at(curves[which], place / count[which])
    end = points_at(curves[which], (place + 1) / count[which])
    number = np.arange(len(which))
    return Lines(np.concatenate([start, end]), np.stack([number, number + len(which)], axis=1))


def _drawn_apart(lines: Lines, cells: int) -> bool:
    """Whether cells have outlines of their own instead of common sides."""
    ends = lines.chains.ends
    rings = int(((ends[:, 0] == ends[:, 1]) & (lines.degree[ends[:, 0]] == 2)).sum())
    return rings >= max(_FEWEST_OUTLINES, _OUTLINES * cells)


def _inked(lines: Lines, size: np.ndarray, scale: float) -> Bool[np.ndarray, "row column"]:
    """The lines drawn on a page ``scale`` times the drawing."""
    from PIL import Image, ImageDraw

    rows, columns = np.maximum(np.round(size * scale), 1).astype(int).tolist()
    page = Image.new("1", (columns, rows))
    pen = ImageDraw.Draw(page)
    for tail, head in ((lines.vertices[lines.edges] + 0.5) * scale - 0.5).tolist():
        pen.line([tail[1], tail[0], head[1], head[0]], fill=1, width=2)
    return np.asarray(page)
