"""Curves through drawn lines: the fewest cubic Bézier pieces that keep near, all chains at once."""

import numpy as np
from jaxtyping import Bool, Float, Float64, Int

from texloom.sketch.bezier import lines as straight_curves
from texloom.sketch.bezier import points_at
from texloom.sketch.cells import clockwise
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.lines import Lines

_STIFFNESS = 1e-4  # pull of control points to thirds, beside one unit a sample: decides where samples do not
_ROUNDS = 8  # of least squares and nearer parameters
_FEWEST_SAMPLES = 8  # along a chain
_OF_LENGTH = 0.1  # a chain's tolerance is at most so much of its length
_TIGHTER = 0.5  # of its tolerance, for a chain whose curves crossed others
_CLOSEST = 0.1  # of the tolerance: closer than that a chain stays as drawn


def curved(size: tuple[float, float], lines: Lines, *, tolerance: float) -> CellGraph:
    """The cell graph of a planar drawing, curves within ``tolerance`` texels of its lines.

    Chains whose curves would cross, or leave a vertex in another order, are fitted closer, at last as the lines
    themselves: the cells are those of the lines.
    """
    chains = lines.chains
    points, start, corner = _samples(lines, step=4 * tolerance)
    around = _around(lines, points[start[:-1] + 1], points[start[1:] - 2])
    near = np.minimum(tolerance, _OF_LENGTH * lines.lengths)  # or a small ring would fall flat
    while True:
        curves, first, last, chain = fit(points, start, near, corner)
        graph = _assembled(size, lines, curves, first, last, start, chain)
        opens, closes = first == start[chain], last == start[chain + 1] - 1
        order = clockwise(chains.ends.ravel(), _leaving(curves[opens], curves[closes]))
        wrong = np.unique([*chain[graph.crossings().ravel()], *np.flatnonzero(order != around) // 2]).astype(np.int64)
        if not near[wrong].any():
            return graph
        near[wrong] = np.where(near[wrong] > _CLOSEST * tolerance, _TIGHTER * near[wrong], 0.0)


def _around(lines: Lines, second: np.ndarray, last_but_one: np.ndarray) -> Int[np.ndarray, "half_chain"]:
    """The next half-chain clockwise around each one's vertex, as the lines are drawn."""
    ends = lines.vertices[lines.chains.ends]
    leaving = _leaving(straight_curves(ends[:, 0], second), straight_curves(last_but_one, ends[:, 1]))
    return clockwise(lines.chains.ends.ravel(), leaving)


def _leaving(first: np.ndarray, last: np.ndarray) -> Float64[np.ndarray, "half_chain 4 2"]:
    """Each chain's first curve and its last one backwards, from 0."""
    both = np.stack([first - first[:, :1], last[:, ::-1] - last[:, 3:]], axis=1)
    return both.reshape(-1, 4, 2)


def fit(
    points: Float[np.ndarray, "point 2"],
    start: Int[np.ndarray, "chains_plus_one"],
    tolerance: Float[np.ndarray, "chain"],
    corner: Bool[np.ndarray, "point"],
) -> tuple[Float64[np.ndarray, "curve 4 2"], np.ndarray, np.ndarray, np.ndarray]:
    """Cubic pieces through chains of points: each with the points at its two ends and its chain, in order.

    Least squares with both ends held, parameters moved to the nearest places between (Schneider 1990); a piece that
    misses a point by more than its chain's ``tolerance`` is cut there. Where that is 0 every piece joins two corners,
    straight.
    """
    first, last, chain = start[:-1], start[1:] - 1, np.arange(len(start) - 1)
    done: list[tuple[np.ndarray, ...]] = []
    exact = np.repeat(tolerance == 0, np.diff(start))
    at = np.flatnonzero(exact & (corner | np.isin(np.arange(len(points)), np.concatenate([first, last]))))
    of = np.repeat(chain, np.diff(start))[at]
    same = of[1:] == of[:-1]
    a, b = at[:-1][same], at[1:][same]
    done.append((straight_curves(points[a], points[b]), a, b, of[1:][same]))
    first, last, chain = (values[tolerance > 0] for values in (first, last, chain))
    while len(first):
        curves, error, worst = _fit_once(points, first, last)
        good = (error <= tolerance[chain]) | (last - first < 2)
        done.append((curves[good], first[good], last[good], chain[good]))
        f, m, end, c = first[~good], worst[~good], last[~good], chain[~good]
        first, last, chain = np.concatenate([f, m]), np.concatenate([m, end]), np.concatenate([c, c])
    curves, first, last, chain = (np.concatenate(parts) for parts in zip(*done, strict=True))
    order = np.argsort(first, kind="stable")
    return curves[order], first[order], last[order], chain[order]


def _fit_once(points: np.ndarray, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One curve for each run of points, its largest miss and the inner point missed."""
    count = last - first + 1
    run = np.repeat(np.arange(len(first)), count)
    opens = np.cumsum(count) - count
    at = first[run] + np.arange(len(run)) - opens[run]
    point = points[at]
    arc = np.cumsum(np.hypot(*np.diff(point, axis=0, prepend=point[:1]).T))
    arc -= arc[opens][run]
    t = arc / np.maximum(arc[opens + count - 1][run], 1e-12)
    curves = straight_curves(points[first], points[last])
    for _ in range(_ROUNDS):
        curves = _least_squares(curves, point, t, run)
        t = _nearer(curves[run], point, t)
    miss = np.hypot(*(points_at(curves[run], t) - point).T)
    miss[opens] = miss[opens + count - 1] = -1
    error = np.maximum.reduceat(miss, opens)
    order = np.lexsort((-miss, run))
    return curves, error, at[order[opens]]


def _least_squares(curves: np.ndarray, point: np.ndarray, t: np.ndarray, run: np.ndarray) -> np.ndarray:
    """The curves with their control points where the samples are met best."""
    b1, b2 = 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t**2
    fixed = curves[run, 0] * ((1 - t) ** 3)[:, None] + curves[run, 3] * (t**3)[:, None]
    thirds = straight_curves(curves[:, 0], curves[:, 3])
    rest = point - fixed - b1[:, None] * thirds[run, 1] - b2[:, None] * thirds[run, 2]

    def total(values: np.ndarray) -> np.ndarray:
        return np.bincount(run, values, len(curves))

    a, b, c = total(b1 * b1) + _STIFFNESS, total(b1 * b2), total(b2 * b2) + _STIFFNESS
    down = np.stack([total(b1 * rest[:, 0]), total(b1 * rest[:, 1])], axis=1)
    up = np.stack([total(b2 * rest[:, 0]), total(b2 * rest[:, 1])], axis=1)
    det = (a * c - b * b)[:, None]
    room = np.zeros(len(curves))
    np.maximum.at(room, run, np.hypot(*(point - curves[run, 0]).T))
    one = thirds[:, 1] + _within((c[:, None] * down - b[:, None] * up) / det, room)
    two = thirds[:, 2] + _within((a[:, None] * up - b[:, None] * down) / det, room)
    return np.stack([curves[:, 0], one, two, curves[:, 3]], axis=1)


def _within(step: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Vectors shortened to a length: where few samples decide, control points must not fly off."""
    length = np.hypot(*step.T)
    return step * np.minimum(1, room / np.maximum(length, 1e-12))[:, None]


def _nearer(curves: np.ndarray, point: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Parameters one Newton step nearer to the points; ends stay."""
    d1 = 3 * np.diff(curves, axis=1)
    d2 = 2 * np.diff(d1, axis=1)
    s, u = (1 - t)[:, None], t[:, None]
    away = points_at(curves, t) - point
    velocity = d1[:, 0] * s**2 + 2 * d1[:, 1] * s * u + d1[:, 2] * u**2
    bend = d2[:, 0] * s + d2[:, 1] * u
    slope = (velocity**2).sum(axis=1) + (away * bend).sum(axis=1)
    step = (away * velocity).sum(axis=1) / np.where(slope > 1e-12, slope, np.inf)
    inner = (t > 0) & (t < 1)
    return np.where(inner, np.clip(t - step, 1e-6, 1 - 1e-6), t)


def _samples(lines: Lines, *, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points along every chain, where each chain starts, and which points are drawn.

    They are no farther apart than ``step``, nor than an eighth of the chain.
    """
    chains = lines.chains
    point = lines.vertices[chains.vertex]
    ahead = np.diff(point, axis=0, append=point[-1:])
    ahead[chains.start[1:] - 1] = 0
    finest = np.repeat(np.minimum(step, lines.lengths / _FEWEST_SAMPLES), np.diff(chains.start))
    count = np.maximum(np.ceil(np.hypot(*ahead.T) / finest), 1).astype(np.int64)
    which = np.repeat(np.arange(len(point)), count)
    opens = np.cumsum(count) - count
    share = (np.arange(len(which)) - opens[which]) / count[which]
    start = np.append(opens[chains.start[:-1]], len(which))
    return point[which] + share[:, None] * ahead[which], start, share == 0


def _assembled(
    size: tuple[float, float],
    lines: Lines,
    curves: np.ndarray,
    first: np.ndarray,
    last: np.ndarray,
    start: np.ndarray,
    chain: np.ndarray,
) -> CellGraph:
    """Pieces in order joined to a graph: ends of chains are shared, cuts between pieces are vertices of two edges."""
    ends = lines.chains.ends[chain]
    opens, closes = first == start[chain], last == start[chain + 1] - 1
    inner = np.arange(len(first)) + len(lines.vertices)  # the vertex at the end of each piece that does not close
    tail = np.where(opens, ends[:, 0], np.roll(inner, 1))
    head = np.where(closes, ends[:, 1], inner)
    position = np.concatenate([lines.vertices, curves[:, 3]])
    used, edges = np.unique(np.stack([tail, head], axis=1), return_inverse=True)
    curve = curves[:, 1:] - curves[:, :1]
    return CellGraph(size, position[used], edges.reshape(-1, 2).astype(np.int32), curve)
