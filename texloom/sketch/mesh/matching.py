"""How well a piece of a sketch continues itself when tiled: edges, boundaries and patches compared.

Wang, Qi, Chen, Ke & Hao 2014, eqs 1-3, for many pieces at once.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float64, Int

from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.strands import edge_lengths, head_of, walk

_FLAT = 0.25  # texels from a chord to its curve
_REACH = 3  # doublings: an edge drawn in pieces is compared over up to eight of them on either side
_TURN = 1.0  # λ of eq. 1


@dataclass(frozen=True, eq=False)
class Crossed:
    """The edges that cross each of some lines, in order along it, in compressed rows.

    ``below`` and ``above`` are an edge's two ends, towards lower and higher coordinates across the line.
    """

    start: Int[np.ndarray, "line_plus_one"]
    place: Float64[np.ndarray, "crossing"]  # along the line
    edge: Int[np.ndarray, "crossing"]
    on_edge: Float64[np.ndarray, "crossing"]  # the edge's parameter there
    below: Int[np.ndarray, "crossing"]  # vertices
    above: Int[np.ndarray, "crossing"]

    def between(
        self, line: Int[np.ndarray, "n"], low: Float[np.ndarray, "n"], high: Float[np.ndarray, "n"]
    ) -> tuple[Int[np.ndarray, "n"], Int[np.ndarray, "n"]]:
        """The first crossing on a piece of each line and the one after the last."""
        span = 1 + 2 * max(np.abs(part).max(initial=0) for part in (self.place, low, high))
        rows = np.repeat(np.arange(len(self.start) - 1), np.diff(self.start)) * span + self.place
        return np.searchsorted(rows, line * span + low), np.searchsorted(rows, line * span + high)


def cross_lines(graph: CellGraph, axis: int, at: Float[np.ndarray, "line"]) -> Crossed:
    """Where edges cross the rows (axis 0) or columns (axis 1) ``at``."""
    order = np.argsort(at, kind="stable")
    chords = graph.flattened(_FLAT)
    low, high = chords.start[:, axis], chords.end[:, axis]
    # A line is crossed by the chord that starts before it and ends on it or beyond
    first = np.searchsorted(at[order], np.minimum(low, high), side="right")
    count = np.searchsorted(at[order], np.maximum(low, high), side="right") - first
    chord = np.repeat(np.arange(len(low)), count)
    line = order[np.repeat(first - np.cumsum(count) + count, count) + np.arange(len(chord))]
    share = (at[line] - low[chord]) / (high - low)[chord]
    along = 1 - axis
    place = chords.start[chord, along] * (1 - share) + chords.end[chord, along] * share

    sort = np.lexsort((place, line))
    line, chord, share, place = line[sort], chord[sort], share[sort], place[sort]
    edge = chords.edge[chord].astype(np.int64)
    last, _, _ = walk(graph, graph.degree == 2, edge_lengths(graph), doublings=_REACH)
    ahead, behind = head_of(graph)[last[2 * edge]], head_of(graph)[last[2 * edge + 1]]
    rises = (low < high)[chord]
    return Crossed(
        np.searchsorted(line, np.arange(len(at) + 1)),
        place,
        edge,
        chords.first[chord] + share * (chords.last - chords.first)[chord],
        np.where(rises, behind, ahead),
        np.where(rises, ahead, behind),
    )


def edge_costs(
    inner: Float[np.ndarray, "n 2"], outer: Float[np.ndarray, "n 2"], other: Float[np.ndarray, "n 2"]
) -> Float[np.ndarray, "n"]:
    """What it costs that the edge ``inner`` → ``outer`` is continued by one that ends at ``other``: eq. 1, less 1.

    Departure: the turn counts in proportion where ``other`` is less than a texel from ``inner``, for it has no
    direction there; so edges that coincide cost 0, and those nearly so nearly 0.
    """
    gap, along = other - inner, outer - inner
    distance = np.hypot(*gap.T)
    turn = gap / np.maximum(distance, 1)[:, None] - _unit(along) * np.minimum(distance, 1)[:, None]
    return (1 + distance) * (1 + _TURN * np.hypot(*turn.T)) - 1


def _unit(vectors: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n 2"]:
    return vectors / np.maximum(np.hypot(*vectors.T), 1e-12)[:, None]


def boundary_costs(
    graph: CellGraph, crossed: Crossed, axis: int, first: tuple[np.ndarray, ...], second: tuple[np.ndarray, ...]
) -> Float[np.ndarray, "n"]:
    """What it costs that pieces of two lines are laid on each other: eq. 2; infinite where different counts cross them.

    Each is (line, low, high, position of the line): the lower one and the higher one of a patch. The mean over the
    edges, in order; each pair is judged from both of its edges, half each (eq. 1 asks only the first). 0 where
    nothing crosses.
    """
    start, end = crossed.between(*first[:3])
    start_2, end_2 = crossed.between(*second[:3])
    count = end - start
    match = np.where(end_2 - start_2 == count, count, 0)
    pair = np.repeat(np.arange(len(count)), match)
    place = np.arange(len(pair)) - np.repeat(np.cumsum(match) - match, match)
    one, two = start[pair] + place, start_2[pair] + place
    shift = np.zeros((len(pair), 2))
    shift[:, axis] = (second[3] - first[3])[pair]

    inner_1, outer_1 = graph.vertices[crossed.above[one]], graph.vertices[crossed.below[one]]
    inner_2, outer_2 = graph.vertices[crossed.below[two]] - shift, graph.vertices[crossed.above[two]] - shift
    costs = (edge_costs(inner_1, outer_1, outer_2) + edge_costs(inner_2, outer_2, outer_1)) / 2
    total = np.bincount(pair, weights=costs, minlength=len(count))
    return np.where(end_2 - start_2 == count, total / np.maximum(count, 1), np.inf)


@dataclass(frozen=True, eq=False)
class SelfMatch:
    """How well each crop continues itself, and how many edges cross its upper and its left boundary."""

    cost: Float64[np.ndarray, "crop"]
    crossings: Int[np.ndarray, "crop 2"]


def match_crops(graph: CellGraph, crops: Float[np.ndarray, "crop 4"]) -> SelfMatch:
    """Eq. 3 for every crop (top, left, bottom, right): left on right, top on bottom; infinite where counts differ."""
    cost, counts = np.zeros(len(crops)), []
    index = np.arange(len(crops))
    for axis in (0, 1):
        low, high = crops[:, axis], crops[:, axis + 2]
        from_, to = crops[:, 1 - axis], crops[:, 3 - axis]
        crossed = cross_lines(graph, axis, np.concatenate([low, high]))
        first, second = (index, from_, to, low), (index + len(crops), from_, to, high)
        cost += boundary_costs(graph, crossed, axis, first, second)
        start, end = crossed.between(*first[:3])
        counts.append(end - start)
    return SelfMatch(cost, np.stack(counts, axis=1))
