"""Drawings as straight pieces: what is mended and traced before curves are laid through it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Float64, Int

from texloom.sketch.crossing import at_common_end, meetings

_MOST_ROUNDS = 8  # of splitting and welding: after the first few, what still crosses is dropped


@dataclass(frozen=True, eq=False)
class Chains:
    """Runs of vertices from one end, fork or corner of a ring to the next, in compressed rows."""

    start: Int[np.ndarray, "chains_plus_one"]
    vertex: Int[np.ndarray, "entry"]

    def __len__(self) -> int:
        return len(self.start) - 1

    @property
    def ends(self) -> Int[np.ndarray, "chain 2"]:
        """First and last vertex of each."""
        return np.stack([self.vertex[self.start[:-1]], self.vertex[self.start[1:] - 1]], axis=1)


@dataclass(frozen=True, eq=False)
class Lines:
    """Straight edges between vertices, each pair of vertices once."""

    vertices: Float64[np.ndarray, "vertex 2"]
    edges: Int[np.ndarray, "edge 2"]

    @property
    def degree(self) -> Int[np.ndarray, "vertex"]:
        """Edges at each vertex."""
        return np.bincount(self.edges.ravel(), minlength=len(self.vertices))

    @cached_property
    def chains(self) -> Chains:
        """All edges as chains between vertices that have not two edges; a ring starts at its lowest vertex."""
        return _chains(len(self.vertices), self.edges)

    @cached_property
    def lengths(self) -> Float64[np.ndarray, "chain"]:
        """The length of each chain."""
        step = np.hypot(*np.diff(self.vertices[self.chains.vertex], axis=0, append=0.0).T)
        step[self.chains.start[1:] - 1] = 0
        return np.add.reduceat(step, self.chains.start[:-1]) if len(self.chains) else np.zeros(0)

    def of(self, chains: Bool[np.ndarray, "chain"]) -> "Lines":
        """Only some chains."""
        runs, kept = self.chains, np.repeat(chains, np.diff(self.chains.start))
        last = np.zeros(len(runs.vertex), bool)
        last[runs.start[1:] - 1] = True
        at = np.flatnonzero(kept & ~last)
        return tidy(self.vertices, np.stack([runs.vertex[at], runs.vertex[at + 1]], axis=1))

    def collapsed(self, group: Int[np.ndarray, "vertex"]) -> "Lines":
        """Vertices of one group made one, at their mean."""
        count = np.maximum(np.bincount(group), 1)
        mean = np.stack([np.bincount(group, self.vertices[:, axis]) / count for axis in (0, 1)], axis=1)
        return tidy(mean, group[self.edges])


def tidy(vertices: Float[np.ndarray, "vertex 2"], edges: Int[np.ndarray, "edge 2"]) -> Lines:
    """The lines without edges from a vertex to itself, without repeats and without vertices nobody uses."""
    edges = np.sort(edges[edges[:, 0] != edges[:, 1]], axis=1).astype(np.int64)
    pair = np.unique(edges[:, 0] * max(len(vertices), 1) + edges[:, 1])
    edges = np.stack([pair // max(len(vertices), 1), pair % max(len(vertices), 1)], axis=1)
    used, edges = np.unique(edges, return_inverse=True)
    return Lines(vertices[used].astype(np.float64), edges.reshape(-1, 2))


def noded(vertices: Float[np.ndarray, "vertex 2"], edges: Int[np.ndarray, "edge 2"], *, weld: float) -> Lines:
    """The same drawing with a vertex wherever edges cross or touch, and vertices within ``weld`` of each other one.

    No two edges of the result meet but at common vertices: what still does after eight rounds is dropped.
    """
    lines = _welded(tidy(vertices, edges), weld)
    for last in [False] * _MOST_ROUNDS + [True]:
        start, end = lines.vertices[lines.edges[:, 0]], lines.vertices[lines.edges[:, 1]]
        met = meetings(start, end)
        a, b = lines.edges[met.first], lines.edges[met.second]
        apart = ~at_common_end(a, b, met.on_first, met.on_second, tolerance=1e-9)
        if not apart.any():
            return lines
        if last:
            kept = np.ones(len(lines.edges), bool)
            kept[met.second[apart]] = False
            return tidy(lines.vertices, lines.edges[kept])
        edge = np.concatenate([met.first[apart], met.second[apart]])
        on = np.concatenate([met.on_first[apart], met.on_second[apart]])
        lines = _welded(_split(lines, edge, on), weld)
    raise AssertionError("the last round returns")


def _split(lines: Lines, edge: np.ndarray, on: np.ndarray) -> Lines:
    """Edges cut at parameters; cuts at their ends are left to the weld."""
    every = np.arange(len(lines.edges))
    order = np.lexsort((np.concatenate([on, every * 0.0, every * 0.0 + 1]), np.concatenate([edge, every, every])))
    tail, head = lines.vertices[lines.edges[edge]].transpose(1, 0, 2)
    cut = tail + on[:, None] * (head - tail)
    vertex = np.concatenate([len(lines.vertices) + np.arange(len(edge)), lines.edges[:, 0], lines.edges[:, 1]])[order]
    whose = np.concatenate([edge, every, every])[order]
    joined = whose[1:] == whose[:-1]
    pieces = np.stack([vertex[:-1][joined], vertex[1:][joined]], axis=1)
    return Lines(np.concatenate([lines.vertices, cut]), pieces)


def _welded(lines: Lines, weld: float) -> Lines:
    """Vertices near each other made one, in groups that chains of such neighbours join."""
    from scipy.spatial import KDTree

    near = KDTree(lines.vertices).query_pairs(weld, output_type="ndarray")
    if not len(near):
        return tidy(lines.vertices, lines.edges)
    return lines.collapsed(joined(len(lines.vertices), near))


def joined(count: int, pairs: Int[np.ndarray, "pair 2"]) -> Int[np.ndarray, "item"]:
    """The number of the connected group of each item."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return connected_components(links, directed=False)[1]


def _chains(count: int, edges: Int[np.ndarray, "edge 2"]) -> Chains:
    origin = edges.ravel()
    degree = np.bincount(origin, minlength=count)
    order = np.argsort(origin, kind="stable")
    opens = np.cumsum(degree) - degree
    through = degree == 2
    follow = np.full(len(origin), -1)
    first = order[opens[through]]
    second = order[opens[through] + 1]
    follow[first ^ 1], follow[second ^ 1] = second, first  # arriving at a vertex of two edges, leave by the other

    after, tail = follow.tolist(), origin.tolist()
    seen = [False] * len(tail)
    start, vertex = [0], []
    begins = np.flatnonzero(~through[origin]).tolist()
    rings = np.flatnonzero(through[origin])
    for begin in begins + rings[np.argsort(origin[rings], kind="stable")].tolist():
        if seen[begin]:
            continue
        at = begin
        while True:
            vertex.append(tail[at])
            seen[at] = seen[at ^ 1] = True
            if after[at] < 0 or after[at] == begin:
                break
            at = after[at]
        vertex.append(tail[at ^ 1])
        start.append(len(vertex))
    return Chains(np.array(start, np.int64), np.array(vertex, np.int64))
