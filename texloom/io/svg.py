"""SVG drawings to strokes: whatever has an outline, as cubic Bézier curves."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float64, Int

from texloom.errors import FileError

_MOST_CURVES = 200_000  # a drawing of cells has thousands; a traced photograph would take minutes


@dataclass(frozen=True, eq=False)
class Strokes:
    """Lines of a drawing, each a run of cubic Bézier curves that join end to start; [row, column] in texels."""

    size: tuple[float, float]  # rows, columns of the drawing
    curves: Float64[np.ndarray, "curve 4 2"]
    start: Int[np.ndarray, "strokes_plus_one"]  # of each stroke's curves

    def __len__(self) -> int:
        return len(self.start) - 1

    @property
    def closed(self) -> Bool[np.ndarray, "stroke"]:
        """Whether each stroke ends where it started."""
        return (self.curves[self.start[1:] - 1, 3] == self.curves[self.start[:-1], 0]).all(axis=1)


def read_svg(path: str | Path) -> Strokes:
    """The strokes of an SVG file: paths, lines, polylines, polygons, rectangles, circles and ellipses, also in groups.

    A texel is a pixel of the file's width and height (of the viewBox, where they are left out). Shapes with a stroke
    count; where none has one, the outlines of all but a rectangle under the whole drawing. Text, pictures and hidden
    shapes are passed over.

    Raises: FileError, if it cannot be read or holds no strokes.
    """
    path = Path(path)
    drawing = _parse(path)
    try:
        runs = list(_runs(drawing))
    except Exception as error:  # of numbers that overflow: the library raises whatever its arithmetic raises
        raise FileError(f"{path.name} holds a shape that cannot be drawn ({_brief(error)})") from error
    if not runs:
        raise FileError(f"{path.name} holds no strokes: draw paths, lines or shapes with an outline")
    if sum(map(len, runs)) > _MOST_CURVES:
        raise FileError(f"{path.name} holds {sum(map(len, runs))} curves: simplify it to {_MOST_CURVES} or fewer")
    curves = np.concatenate(runs)
    if not np.isfinite(curves).all():
        raise FileError(f"{path.name} holds coordinates that are not finite")
    rows, columns = _extent(drawing, curves)
    return Strokes((rows, columns), curves - 0.5, np.cumsum([0, *map(len, runs)]))


def _parse(path: Path) -> Any:
    import logging

    from svgelements import SVG

    if not path.exists():
        raise FileError(f"{path}: no such file")
    if not path.is_file() or path.stat().st_size == 0:
        raise FileError(f"{path} is {'empty (0 bytes)' if path.is_file() else 'a folder'}: give an SVG drawing")
    logging.getLogger("svgelements").setLevel(logging.CRITICAL)  # what is wrong with a file, our error says
    try:
        drawing = SVG.parse(str(path), reify=True)
    except Exception as error:  # its parser raises whatever the file makes it trip over
        raise FileError(f"{path.name} is not an SVG drawing that can be read ({_brief(error)})") from error
    if not isinstance(drawing, SVG):
        raise FileError(f"{path.name} is not an SVG drawing: it has no svg element")
    return drawing


def _extent(drawing: Any, curves: np.ndarray) -> tuple[float, float]:
    """Rows and columns of the page, or of what is drawn where the file says neither size nor viewBox."""
    said = drawing.viewbox is not None or {"width", "height"} <= set(drawing.values.get("attributes", {}))
    if said and drawing.width and drawing.height:
        return float(drawing.height), float(drawing.width)
    rows, columns = curves.reshape(-1, 2).max(axis=0)
    return max(float(rows), 1.0), max(float(columns), 1.0)


def _runs(drawing: Any) -> Iterator[np.ndarray]:
    """The curves of each stroke, [y, x] as the file has them."""
    from svgelements import Path as Curves
    from svgelements import Rect, Shape

    shapes = [element for element in drawing.elements() if isinstance(element, Shape) and _shown(element)]
    stroked = [shape for shape in shapes if shape.stroke is not None and shape.stroke.value is not None]
    if not stroked:
        stroked = [shape for shape in shapes if not (isinstance(shape, Rect) and _is_page(shape, drawing))]
    for shape in stroked:
        for part in Curves(shape).as_subpaths():
            curves = [piece for segment in part for piece in _cubics(segment)]
            if curves:
                run = np.array(curves, np.float64)[..., ::-1]
                run = run[(run != run[:, :1]).any(axis=(1, 2))]
                if len(run):
                    yield run


def _shown(shape: Any) -> bool:
    return shape.values.get("display") != "none" and shape.values.get("visibility") not in ("hidden", "collapse")


def _is_page(shape: Any, drawing: Any) -> bool:
    """Whether a rectangle covers the whole drawing."""
    left, top, right, bottom = shape.bbox()
    return left <= 0 and top <= 0 and right >= (drawing.width or 0) and bottom >= (drawing.height or 0)


def _cubics(segment: Any) -> Iterator[list[tuple[float, float]]]:
    """A segment of a path as curves of four points each, [x, y]."""
    from svgelements import Arc, CubicBezier, Move, QuadraticBezier

    if isinstance(segment, Move) or segment.start is None or segment.end is None:
        return
    if isinstance(segment, Arc):
        for piece in segment.as_cubic_curves():
            yield from _cubics(piece)
        return
    a, d = np.array(segment.start), np.array(segment.end)
    if isinstance(segment, CubicBezier):
        b, c = np.array(segment.control1), np.array(segment.control2)
    elif isinstance(segment, QuadraticBezier):
        middle = np.array(segment.control)
        b, c = a + 2 / 3 * (middle - a), d + 2 / 3 * (middle - d)
    else:
        b, c = a + (d - a) / 3, a + 2 / 3 * (d - a)
    yield [tuple(a), tuple(b), tuple(c), tuple(d)]


def _brief(error: BaseException) -> str:
    """The first line of another library's complaint."""
    return str(error).strip().split("\n")[0][:120] or type(error).__name__
