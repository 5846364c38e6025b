"""Drawings of cells as SVG, for any drawing program and for ``texloom.sketch.reading.read`` to read again."""

from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from jaxtyping import Float64

from texloom.output.atomic import atomic

_PEN = 1.0  # texels
_STRAIGHT = 1e-6  # texels from a third of the way: no curve


def write_sketch_svg(
    path: str | Path,
    size: tuple[float, float],
    curves: Float64[np.ndarray, "curve 4 2"],
    *,
    settings: Mapping[str, str] | None = None,
) -> Path:
    """Cubic Bézier curves, [row, column] in texels, as one path each on a page of ``size`` (rows, columns).

    What reaches beyond the page is kept; viewers cut it off. ``settings`` are stored as the drawing's description.
    """
    rows, columns = (f"{side:.10g}" for side in size)
    about = "; ".join(f"{name}: {value}" for name, value in (settings or {}).items())
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{columns}" height="{rows}" viewBox="0 0 {columns} {rows}">',
        f"<desc>{escape(about)}</desc>",
        f'<g fill="none" stroke="black" stroke-width="{_PEN:g}" stroke-linecap="round">',
        *(f'<path d="{_words(curve)}"/>' for curve in curves[..., ::-1] + 0.5),
        "</g>",
        "</svg>",
    ]
    path = Path(path)
    with atomic(path) as beside:
        beside.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return path


def _words(curve: Float64[np.ndarray, "4 2"]) -> str:
    """A path's data: a line where the curve is straight."""
    a, b, c, d = (f"{x:.4f} {y:.4f}" for x, y in curve)
    thirds = curve[0] + np.array([[1 / 3], [2 / 3]]) * (curve[3] - curve[0])
    return f"M{a} L{d}" if np.abs(curve[1:3] - thirds).max() < _STRAIGHT else f"M{a} C{b} {c} {d}"
