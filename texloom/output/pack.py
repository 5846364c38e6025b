"""Charts packed into a square: tallest first, each dropped onto the skyline where it ends up lowest.

Charts keep their outline (the lowest and highest cell of every column), so they nest (Lévy et al. 2002, §4.2).
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float64, Int, Int32
from numpy.lib.stride_tricks import sliding_window_view

from texloom.kernels.launch import launch
from texloom.kernels.pack import drop_charts

_CELLS = 1024.0  # about a side of the square: fine enough for narrow gutters, coarse enough to be quick
_FULL = 1.25  # the square may turn out this much larger
_ANGLES = 24  # turns tried to find a chart's smallest box
_TRIALS = 6


@dataclass(frozen=True, eq=False)
class _Outline:
    """Columns of a chart: its lowest and highest cell in each, in cells above the chart's own lowest corner."""

    bottom: Int32[np.ndarray, "column"]
    top: Int32[np.ndarray, "column"]


def pack_charts(
    flat: Float[np.ndarray, "face 3 2"], chart: Int[np.ndarray, "face"], *, size: int, gutter: int
) -> Float64[np.ndarray, "face 3 2"]:
    """UVs (v up) in the unit square with one scale for all charts, at least ``gutter`` texels apart."""
    flat = _boxed(_uprighted(flat, chart), chart)
    area = _areas(flat).sum()
    cells = flat * (0.75 * _CELLS / np.sqrt(max(area, 1e-300)))
    pad = int(np.ceil(gutter * _FULL * _CELLS / size / 2))
    outlines = _outlines(cells, chart, pad)
    places, width, height = _best_packing(outlines, float(_areas(cells).sum()))
    side = max(width, height)
    return (cells + (places + pad)[chart][:, None, :]) / side


def _areas(flat: Float[np.ndarray, "face 3 2"]) -> Float64[np.ndarray, "face"]:
    first, second = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    return 0.5 * np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])


def _uprighted(flat: Float[np.ndarray, "face 3 2"], chart: Int[np.ndarray, "face"]) -> Float64[np.ndarray, "face 3 2"]:
    """Every chart turned to its smallest box, standing upright; a turn changes neither lengths nor handedness."""
    order = np.argsort(chart, kind="stable")
    starts = 3 * np.flatnonzero(np.diff(chart[order], prepend=-1))
    across, along = (np.ascontiguousarray(flat[order, :, axis]).reshape(-1) for axis in (0, 1))
    best, angle = np.full(len(starts), np.inf), np.zeros(len(starts))
    for trial in np.arange(_ANGLES) * (np.pi / 2 / _ANGLES):
        wide = _spread(np.cos(trial) * across - np.sin(trial) * along, starts)
        tall = _spread(np.sin(trial) * across + np.cos(trial) * along, starts)
        better = wide * tall < best * (1 - 1e-9)
        best = np.where(better, wide * tall, best)
        angle = np.where(better, trial + np.where(tall >= wide, 0.0, np.pi / 2), angle)
    cosine, sine = np.cos(angle)[chart][:, None], np.sin(angle)[chart][:, None]
    x, y = flat[..., 0], flat[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=2)


def _spread(values: Float64[np.ndarray, "corner"], starts: Int[np.ndarray, "chart"]) -> Float64[np.ndarray, "chart"]:
    """Greatest less least value in each run."""
    return np.maximum.reduceat(values, starts) - np.minimum.reduceat(values, starts)


def _boxed(flat: Float[np.ndarray, "face 3 2"], chart: Int[np.ndarray, "face"]) -> Float64[np.ndarray, "face 3 2"]:
    """Every chart moved so that its least coordinates are 0."""
    low = np.full((int(chart.max()) + 1, 2), np.inf)
    np.minimum.at(low, chart, flat.min(axis=1))
    return flat - low[chart][:, None, :]


def _outlines(cells: Float[np.ndarray, "face 3 2"], chart: Int[np.ndarray, "face"], pad: int) -> list[_Outline]:
    """Outline of every chart, widened by ``pad`` cells to all sides; a face counts whole in every column it touches."""
    low, high = np.floor(cells.min(axis=1)).astype(np.int32), np.floor(cells.max(axis=1)).astype(np.int32)
    widths = np.zeros(int(chart.max()) + 1, np.int32)
    np.maximum.at(widths, chart, high[:, 0] + 1)
    starts = np.concatenate([[0], np.cumsum(widths)])
    bottom, top = np.full(starts[-1], 1 << 20, np.int32), np.full(starts[-1], -1, np.int32)
    span = high[:, 0] - low[:, 0] + 1
    face = np.repeat(np.arange(len(cells)), span)
    column = np.arange(len(face)) - np.repeat(np.cumsum(span) - span, span) + low[face, 0] + starts[chart[face]]
    np.minimum.at(bottom, column, low[face, 1])
    np.maximum.at(top, column, high[face, 1])
    return [_widened(bottom[a:b], top[a:b] + 1, pad) for a, b in zip(starts[:-1], starts[1:], strict=True)]


def _widened(bottom: Int32[np.ndarray, "column"], top: Int32[np.ndarray, "column"], pad: int) -> _Outline:
    """``pad`` more cells all around; the outline's own corner moves with it."""
    around = np.pad(bottom, 2 * pad, mode="edge"), np.pad(top, 2 * pad, mode="edge")
    lowest = sliding_window_view(around[0], 2 * pad + 1).min(axis=1)
    highest = sliding_window_view(around[1], 2 * pad + 1).max(axis=1)
    return _Outline(lowest, highest + 2 * pad)


def _best_packing(outlines: list[_Outline], area: float) -> tuple[Float64[np.ndarray, "chart 2"], int, int]:
    """Place, width and height of the squarest packing over a few widths."""
    widest = max(len(outline.bottom) for outline in outlines)
    width = max(int(np.sqrt(area) * 1.25), widest)
    best: tuple[Float64[np.ndarray, "chart 2"], int, int] | None = None
    for _ in range(_TRIALS):
        places, height = _drop(outlines, width)
        if best is None or max(width, height) < max(best[1:]):
            best = places, width, height
        following = max(int(round((width + height) / 2)), widest)
        if abs(following - width) <= 1:
            break
        width = following
    assert best is not None
    return best


def _drop(outlines: list[_Outline], width: int) -> tuple[Float64[np.ndarray, "chart 2"], int]:
    """Place of every chart (lower left cell) in a strip, and the height of the strip."""
    heights = np.array([outline.top.max() for outline in outlines])
    first = np.cumsum([0] + [len(outline.bottom) for outline in outlines]).astype(np.int32)
    skyline, places = np.zeros(width, np.int32), np.empty((len(outlines), 2), np.int32)
    launch(
        drop_charts,
        1,
        inputs=[
            *(np.argsort(-heights, kind="stable").astype(np.int32), first),
            *(np.concatenate([np.asarray(getattr(o, side), np.int32) for o in outlines]) for side in ("bottom", "top")),
        ],
        outputs=[skyline, places],
    )
    return places.astype(np.float64), int(skyline.max())
