"""Exact nearest neighbours among many thousands of patches, by bounds that rule most of them out."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int

from texloom.exemplar.blas import over_blocks, single_threaded

_QUERIES = 256  # rows a block: with _TARGETS columns of float32 it stays in the second-level cache
_TARGETS = 2048
_RUN = 32  # targets looked at together before they are looked at one by one
_KEPT = 28  # principal components in the bound
_PAIRS = 8192  # pairs measured in full at a time


@dataclass(frozen=True, eq=False)
class Nearest:
    """For every query its nearest target and the squared distance to it."""

    index: Int[np.ndarray, "query"]
    squared: Float32[np.ndarray, "query"]


def nearest(queries: Float32[np.ndarray, "query dim"], targets: Float32[np.ndarray, "target dim"]) -> Nearest:
    """The nearest target of every query, exactly; ties keep the lowest index.

    A distance is no less than the distance between the principal components of both together with the lengths of what
    the components leave out. That bound is one matrix product per block of pairs; only pairs whose bound is below the
    best distance so far are measured in full. O(query · target · 30) multiplications, O(target · dim) memory.
    """
    with single_threaded():
        query_rows, query_norms, target_columns = _bound_factors(queries, targets)
    index = np.empty(len(queries), np.int64)
    squared = np.empty(len(queries), np.float32)

    def search(first: int, last: int) -> None:
        rows, norms = query_rows[first:last], query_norms[first:last]
        best = _Best(queries[first:last], targets)
        best.guess(rows @ target_columns[:, ::_RUN])
        for column in range(0, len(targets), _TARGETS):
            best.offer(rows @ target_columns[:, column : column + _TARGETS], norms, column)
        index[first:last], squared[first:last] = best.index, best.squared

    over_blocks(search, len(queries), _QUERIES)
    return Nearest(index, squared)


def _bound_factors(queries: np.ndarray, targets: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows and columns whose product is the bound on the squared distance, less the query's norm (the second item)."""
    mean = targets.mean(0)
    spread = targets[:: max(1, len(targets) // 8192)] - mean
    basis = np.linalg.eigh(spread.T @ spread)[1][:, ::-1][:, :_KEPT].copy()
    few_queries, few_targets = _reduce(queries, mean, basis), _reduce(targets, mean, basis)
    query_rows = np.column_stack([few_queries, np.ones(len(queries), np.float32)])
    # Padding targets are infinitely far.
    columns = np.zeros((few_targets.shape[1] + 1, -(-len(targets) // _RUN) * _RUN), np.float32)
    columns[-1] = np.inf
    columns[:-1, : len(targets)] = -2.0 * few_targets.T
    columns[-1, : len(targets)] = np.einsum("ij,ij->i", few_targets, few_targets)
    return query_rows, np.einsum("ij,ij->i", few_queries, few_queries), columns


def _reduce(vectors: np.ndarray, mean: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """The leading components of every vector, then the length of the rest."""
    centred = vectors - mean
    kept = centred @ basis
    rest = np.einsum("ij,ij->i", centred, centred) - np.einsum("ij,ij->i", kept, kept)
    return np.column_stack([kept, np.sqrt(np.maximum(rest, 0.0))])


class _Best:
    """The best targets so far for one block of queries."""

    def __init__(self, queries: np.ndarray, targets: np.ndarray) -> None:
        self.queries, self.targets = queries, targets
        self.index = np.full(len(queries), len(targets))
        self.squared = np.full(len(queries), np.inf, np.float32)

    def guess(self, bound: np.ndarray) -> None:
        """Measure one likely target each, given the bounds of every _RUN-th: a start that rules most others out."""
        self._measure(np.arange(len(bound)), _RUN * bound.argmin(1))

    def offer(self, bound: np.ndarray, norms: np.ndarray, first: int) -> None:
        """Look at the targets from ``first`` on, given ``bound`` (less the queries' norms) on their distances."""
        # Rounding of the bound is far below this part of the norms that cancel in it.
        limit = self.squared - norms + 1e-5 * (norms + 1.0)
        run_count = bound.shape[1] // _RUN
        lowest = bound.reshape(len(bound), _RUN, run_count).min(1)
        query, run = np.nonzero(lowest <= limit[:, None])
        target = run[:, None] + run_count * np.arange(_RUN)
        bound = bound[query[:, None], target]
        # The most promising of each run first: it often rules the rest of the run out.
        likely = bound.argmin(1)
        self._measure(query, first + target[np.arange(len(query)), likely])
        limit = self.squared - norms + 1e-5 * (norms + 1.0)
        close = bound <= limit[query, None]
        query, target = query[np.nonzero(close)[0]], target[close]
        for part in range(0, len(query), _PAIRS):
            self._measure(query[part : part + _PAIRS], first + target[part : part + _PAIRS])

    def _measure(self, query: np.ndarray, target: np.ndarray) -> None:
        """Measure pairs in full and keep what is better, or as near and of lower index."""
        difference = self.queries[query] - self.targets[target]
        squared = np.einsum("ij,ij->i", difference, difference)
        order = np.lexsort((target, squared, query))
        query, squared, target = query[order], squared[order], target[order]
        head = np.flatnonzero(np.diff(query, prepend=-1))
        query, squared, target = query[head], squared[head], target[head]
        better = (squared < self.squared[query]) | ((squared == self.squared[query]) & (target < self.index[query]))
        self.squared[query[better]], self.index[query[better]] = squared[better], target[better]
