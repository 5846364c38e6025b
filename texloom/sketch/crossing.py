"""Where line segments meet: all pairs that cross or touch, found over a grid."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float64, Int

_PARALLEL = 1e-9  # sine under which two segments run side by side


@dataclass(frozen=True, eq=False)
class Meetings:
    """Pairs of segments that share a point, each pair once, and where on them: parameters in [0, 1]."""

    first: Int[np.ndarray, "pair"]
    second: Int[np.ndarray, "pair"]
    on_first: Float[np.ndarray, "pair"]
    on_second: Float[np.ndarray, "pair"]


def meetings(
    start: Float[np.ndarray, "segment 2"], end: Float[np.ndarray, "segment 2"], *, period: np.ndarray | None = None
) -> Meetings:
    """All meetings; of two segments that overlap, the middle of what they share. In order of (first, second).

    With ``period`` the plane is a torus of that size, and no segment may be longer than a third of it. Time and memory
    grow with the segments and with those near each other: about 1 µs a segment of a drawing.
    """
    first, second = near_pairs(np.minimum(start, end), np.maximum(start, end), period=period)
    along, beside = end[first] - start[first], end[second] - start[second]
    apart = start[second] - start[first]
    if period is not None:
        apart -= np.round((apart + (beside - along) / 2) / period) * period
    on_first, on_second, meet = _meet(along, beside, apart)
    return Meetings(first[meet], second[meet], on_first[meet], on_second[meet])


def _meet(along: np.ndarray, beside: np.ndarray, apart: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Parameters at which 0 → ``along`` and ``apart`` → ``apart + beside`` meet, and whether they do."""
    turn = cross(along, beside)
    lengths = np.hypot(*along.T) * np.hypot(*beside.T)
    parallel = np.abs(turn) <= _PARALLEL * lengths
    with np.errstate(divide="ignore", invalid="ignore"):
        on_first, on_second = cross(apart, beside) / turn, cross(apart, along) / turn
    meet = ~parallel & (on_first >= 0) & (on_first <= 1) & (on_second >= 0) & (on_second <= 1)
    flat = np.flatnonzero(parallel & (lengths > 0))
    if len(flat):
        s, t, overlap = _overlap(along[flat], beside[flat], apart[flat])
        on_first[flat], on_second[flat], meet[flat] = s, t, overlap
    return on_first, on_second, meet


def _overlap(along: np.ndarray, beside: np.ndarray, apart: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same of parallel segments: the middle of what they share, where they lie on one line."""
    squared = (along**2).sum(axis=1)
    on_line = np.abs(cross(along, apart)) <= _PARALLEL * np.maximum(squared, 1)
    a = (along * apart).sum(axis=1) / squared
    b = (along * (apart + beside)).sum(axis=1) / squared
    low, high = np.maximum(np.minimum(a, b), 0), np.minimum(np.maximum(a, b), 1)
    middle = (low + high) / 2
    return middle, (middle - a) / (b - a), on_line & (low <= high)


def cross(a: Float[np.ndarray, "n 2"], b: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n"]:
    """The area between two vectors, positive where ``b`` is counter-clockwise of ``a`` on the screen."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def near_pairs(
    low: Float[np.ndarray, "box 2"], high: Float[np.ndarray, "box 2"], *, period: np.ndarray | None = None
) -> tuple[Int[np.ndarray, "pair"], Int[np.ndarray, "pair"]]:
    """Pairs (first < second) of boxes that overlap or touch, in order, over a grid as fine as the typical box."""
    count = len(low)
    if count < 2:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    entry, box = _covered(low, high, period)
    order = np.argsort(entry, kind="stable")
    entry, box = entry[order], box[order]
    opens = np.flatnonzero(np.diff(entry, prepend=entry[0] - 1))
    sizes = np.diff(opens, append=len(entry))

    # Every entry with all that follow it in its cell of the grid.
    place = np.arange(len(entry)) - np.repeat(opens, sizes)
    following = np.repeat(sizes, sizes) - 1 - place
    a = np.repeat(np.arange(len(entry)), following)
    b = a + 1 + np.arange(len(a)) - np.repeat(np.cumsum(following) - following, following)
    a, b = np.minimum(box[a], box[b]), np.maximum(box[a], box[b])
    touch = _boxes_touch(low, high, a, b, period) & (a < b)
    pair = np.unique(a[touch] * count + b[touch])
    return pair // count, pair % count


def _covered(low: np.ndarray, high: np.ndarray, period: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """The cells of the grid that each box covers: (cell, box) once for every one."""
    whole = period if period is not None else np.maximum(high.max(axis=0) - low.min(axis=0), 1e-9)
    side = max(float((high - low).max(axis=1).mean()), float(np.sqrt(whole.prod() / (4 * len(low)))), 1e-9)
    origin = np.zeros(2) if period is not None else low.min(axis=0)
    grid = np.maximum(np.floor(whole / side), 1).astype(np.int64)
    cell = whole / grid
    corner = np.floor((low - origin) / cell).astype(np.int64)
    span = np.floor((high - origin) / cell).astype(np.int64) - corner + 1
    if period is not None:
        span = np.minimum(span, grid)
    covered = span.prod(axis=1)
    box = np.repeat(np.arange(len(low)), covered)
    place = np.arange(len(box)) - np.repeat(np.cumsum(covered) - covered, covered)
    row = corner[box, 0] + place // span[box, 1]
    column = corner[box, 1] + place % span[box, 1]
    if period is not None:
        row, column = row % grid[0], column % grid[1]
    return row * (grid[1] + 1) + column, box


def _boxes_touch(
    low: np.ndarray, high: np.ndarray, a: np.ndarray, b: np.ndarray, period: np.ndarray | None
) -> Bool[np.ndarray, "pair"]:
    between = (low[b] + high[b] - low[a] - high[a]) / 2
    if period is not None:
        between -= np.round(between / period) * period
    reach = (high[a] - low[a] + high[b] - low[b]) / 2
    return np.all(np.abs(between) <= reach + 1e-12, axis=1)


def at_common_end(
    a: Int[np.ndarray, "pair 2"],
    b: Int[np.ndarray, "pair 2"],
    on_a: Float64[np.ndarray, "pair"],
    on_b: Float64[np.ndarray, "pair"],
    *,
    tolerance: float,
) -> Bool[np.ndarray, "pair"]:
    """Whether parameters on two edges (tail, head) are ends of both, to a tolerance, that are one vertex."""

    def vertex(edge: np.ndarray, on: np.ndarray, none: int) -> np.ndarray:
        return np.where(on < tolerance, edge[:, 0], np.where(on > 1 - tolerance, edge[:, 1], none))

    return vertex(a, on_a, -1) == vertex(b, on_b, -2)
