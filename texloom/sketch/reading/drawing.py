"""A drawn or photographed picture to a cell graph: light made even, ink told from paper, cells found between."""

from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float32

from texloom.errors import FileError
from texloom.io.image import read_stored
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.fitting import curved
from texloom.sketch.reading.ink import cells_of_ink, connected
from texloom.sketch.reading.mending import cells_of
from texloom.sketch.reading.mends import Mend
from texloom.sketch.reading.overlap import refuse_inked_overlap, refuse_overlap

_BLOCK = 24  # texels a side of the blocks over which the paper's light is taken
_PAPER = 85  # percentile of a block that is paper
_GRAIN = 0.7  # texels: the blur that takes off the tooth of paper and pencil
_WEAK = 0.6  # of the threshold: ink as pale as that counts where it continues darker ink
_SPECK = 12  # texels: fewer are dust
_LEAST_CONTRAST = 0.08  # of the paper's light
_MOST_INK = 0.3  # share of the page; more is a photograph
_LEAST_APART = 0.84  # share of the variance of light that ink and paper explain
_FIT = 0.9  # texels from the middle of the ink to the curve
_MOST_TEXELS = 2048  # a side


def graph_of_drawing(grey: Float32[np.ndarray, "row column"]) -> tuple[CellGraph, list[Mend]]:
    """The cells between the lines of a picture, light in [0, 1], and what was mended.

    Raises: FileError, if it shows no lines, closes no cell, or its elements overlap.
    """
    ink = find_ink(grey)
    lines, notes = cells_of_ink(ink)
    count = len(cells_of(lines))
    if not count:
        raise FileError("the drawing closes no cell: draw lines that meet around cells")
    refuse_overlap(lines, count)
    refuse_inked_overlap(ink, count)
    rows, columns = grey.shape
    return curved((float(rows), float(columns)), lines, tolerance=_FIT), notes


def read_drawing(path: str | Path) -> Float32[np.ndarray, "row column"]:
    """The light of a picture as stored, on white where it is transparent.

    Raises: FileError, if it cannot be read or is over 2048 texels a side.
    """
    stored = read_stored(path)
    if max(stored.shape[:2]) > _MOST_TEXELS:
        rows, columns = stored.shape[:2]
        raise FileError(
            f"{Path(path).name} is {columns}x{rows}: scale the drawing to {_MOST_TEXELS} texels a side or less"
        )
    most = np.iinfo(stored.dtype).max if stored.dtype.kind == "u" else max(float(np.nanmax(stored)), 1e-6)
    values = np.nan_to_num(stored.astype(np.float32) / np.float32(most))
    colours = values.shape[2] - (values.shape[2] + 1) % 2
    grey = values[..., :colours].mean(axis=2)
    return grey if colours == values.shape[2] else 1 + (grey - 1) * values[..., -1]


def is_drawing(grey: Float32[np.ndarray, "row column"]) -> bool:
    """Whether a picture is lines on paper: little ink, well apart from an even ground."""
    contrast = _contrast(grey)
    level, apart = threshold(contrast)
    inked = float((contrast > level).mean())
    return level > _LEAST_CONTRAST and inked < _MOST_INK and apart > _LEAST_APART


def find_ink(grey: Float32[np.ndarray, "row column"]) -> Bool[np.ndarray, "row column"]:
    """Where lines are: darker than the paper around them, or lighter where the paper is dark.

    Raises: FileError, if nothing stands out.
    """
    contrast = _contrast(grey)
    level, _ = threshold(contrast)
    if level < _LEAST_CONTRAST:
        raise FileError(f"the picture shows no lines: its light varies by {100 * float(contrast.max()):.0f} % only")
    pieces, count = connected(contrast > _WEAK * level)
    texels = np.bincount(pieces.ravel(), minlength=count + 1)
    strong = np.bincount(pieces[contrast > level], minlength=count + 1)
    kept = (texels >= _SPECK) & (strong > 0)
    kept[0] = False
    return kept[pieces]


def _contrast(grey: np.ndarray) -> np.ndarray:
    """How much darker each texel is than the paper there, as a share of its light."""
    from scipy.ndimage import gaussian_filter

    if np.median(grey) < 0.5 * (float(grey.min()) + float(grey.max())):
        grey = grey.max() + grey.min() - grey  # chalk on a board
    light = _paper(grey)
    return gaussian_filter(np.clip(1 - grey / np.maximum(light, 1e-3), 0, 1), _GRAIN)


def _paper(grey: np.ndarray) -> np.ndarray:
    """The light of the paper, smooth: a high percentile of each block, interpolated."""
    from scipy.ndimage import gaussian_filter, map_coordinates

    rows, columns = grey.shape
    down, across = (max(1, round(side / _BLOCK)) for side in (rows, columns))
    row_edges = np.linspace(0, rows, down + 1).astype(int)
    column_edges = np.linspace(0, columns, across + 1).astype(int)
    blocks = [
        [np.percentile(grey[a:b, c:d], _PAPER) for c, d in zip(column_edges, column_edges[1:], strict=False)]
        for a, b in zip(row_edges, row_edges[1:], strict=False)
    ]
    light = gaussian_filter(np.array(blocks, np.float32), 1.0, mode="nearest")
    at = np.meshgrid(
        (np.arange(rows) + 0.5) / rows * down - 0.5, (np.arange(columns) + 0.5) / columns * across - 0.5, indexing="ij"
    )
    return np.asarray(map_coordinates(light, at, order=1, mode="nearest"))


def threshold(contrast: np.ndarray) -> tuple[float, float]:
    """Otsu's threshold between ink and paper, and the share of the variance that the two explain."""
    counts, edges = np.histogram(contrast, bins=256, range=(0.0, 1.0))
    middle = (edges[1:] + edges[:-1]) / 2
    below, total = np.cumsum(counts), counts.sum()
    light, whole = np.cumsum(counts * middle), (counts * middle).sum()
    with np.errstate(divide="ignore", invalid="ignore"):
        between = (whole * below - light * total) ** 2 / (below * (total - below))
    between = np.nan_to_num(between) / max(total, 1) ** 2
    best = int(between.argmax())
    variance = float((counts * (middle - whole / max(total, 1)) ** 2).sum() / max(total, 1))
    return float(edges[best + 1]), float(between[best]) / max(variance, 1e-12)
