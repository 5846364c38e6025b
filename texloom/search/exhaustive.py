"""Every candidate looked at: the reference for all other searches, and dense enough to be fast."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float32, Int32

from texloom.exemplar.blas import over_blocks
from texloom.search.matching import Match, State, Vectors, squared_distance

_QUERIES = 128  # a block of this many rows of scores stays in cache while its largest entry is found
_CANDIDATES = 8192
_MOST_TIES = 8  # near ties decided by exact cost; beyond them the lowest index is as good as any
_ROUNDING = 2.0**-21  # of a product's score, relative to the squared lengths that enter it


@dataclass(frozen=True)
class Exhaustive:
    """Nearest of all candidates. O(query · candidate · dim) time, as matrix products."""

    def prepare(self, vectors: Vectors) -> "ExhaustiveIndex":
        """Nothing to learn."""
        return ExhaustiveIndex(vectors)

    def restore(self, vectors: Vectors, state: State) -> "ExhaustiveIndex":
        """Nothing was learnt."""
        return ExhaustiveIndex(vectors)


@dataclass(frozen=True, eq=False)
class ExhaustiveIndex:
    """All candidates, as they are."""

    vectors: Vectors

    def nearest(self, queries: Float32[np.ndarray, "query dim"]) -> Match:
        """The nearest candidate of each query.

        |q - c|² = |q|² - (2 q·c - |c|²): the bracket is one product with a column of -|c|² appended, its largest entry
        wins. Rounding hides differences of about 1e-7 of the squared lengths there, so near ties are decided again by
        their exact costs. Vectors are centred first, which keeps those lengths and so the rounding small.
        """
        blocks = over_blocks(lambda first, last: self.nearest_in_block(queries[first:last]), len(queries), _QUERIES)
        if not blocks:
            return Match(np.zeros(0, np.int32), np.zeros(0, np.float32))
        index, cost = (np.concatenate(part) for part in zip(*blocks, strict=True))
        return Match(index, cost)

    def state(self) -> State:
        """Nothing was learnt."""
        return {}

    @cached_property
    def _mean(self) -> Float32[np.ndarray, "dim"]:
        return self.vectors.mean(axis=0)

    @cached_property
    def _table(self) -> Float32[np.ndarray, "dim_and_bias candidate"]:
        """2 c over -|c|², one column a candidate."""
        dim = self.vectors.shape[1]
        table = np.empty((dim + 1, len(self.vectors)), np.float32)
        centred = self.vectors - self._mean
        table[:dim] = 2.0 * centred.T
        table[dim] = -np.einsum("ij,ij->i", centred, centred)
        return table

    @cached_property
    def _largest(self) -> float:
        """The greatest |c|²."""
        return float(-self._table[-1].min())

    def nearest_in_block(
        self, queries: Float32[np.ndarray, "query dim"]
    ) -> tuple[Int32[np.ndarray, "query"], Float32[np.ndarray, "query"]]:
        """Index and cost for a few queries, on the calling thread."""
        extended = np.empty((len(queries), queries.shape[1] + 1), np.float32)
        np.subtract(queries, self._mean, out=extended[:, :-1])
        tolerance = _ROUNDING * (np.einsum("ij,ij->i", extended[:, :-1], extended[:, :-1]) + self._largest)
        extended[:, -1] = 1.0
        index = np.zeros(len(queries), np.int32)
        cost = np.full(len(queries), np.inf, np.float32)
        for first in range(0, len(self.vectors), _CANDIDATES):  # a later block must be strictly cheaper
            scores = extended @ self._table[:, first : first + _CANDIDATES]
            winner = (scores.argmax(axis=1) + first).astype(np.int32)
            winner_cost = squared_distance(queries, self.vectors, winner)
            self._settle_ties(queries, scores, tolerance, first, winner, winner_cost)
            better = winner_cost < cost
            index[better], cost[better] = winner[better], winner_cost[better]
        return index, cost

    def _settle_ties(
        self,
        queries: Float32[np.ndarray, "query dim"],
        scores: Float32[np.ndarray, "query candidate"],
        tolerance: Float32[np.ndarray, "query"],
        first: int,
        winner: Int32[np.ndarray, "query"],
        cost: Float32[np.ndarray, "query"],
    ) -> None:
        """Where rounding may have chosen, choose by exact cost among the first few, the lowest index first."""
        best = scores[np.arange(len(scores)), winner - first]
        near = scores >= (best - tolerance)[:, None]
        if np.count_nonzero(near) == len(near):
            return
        row, column = np.divmod(np.flatnonzero(near), near.shape[1])
        rank = np.arange(len(row)) - np.searchsorted(row, np.arange(len(near)))[row]
        for turn in range(min(_MOST_TIES, int(rank.max()) + 1)):
            at = rank == turn
            query, candidate = row[at], (column[at] + first).astype(np.int32)
            challenge = squared_distance(queries[query], self.vectors, candidate)
            wins = (challenge < cost[query]) | ((challenge == cost[query]) & (candidate < winner[query]))
            winner[query[wins]], cost[query[wins]] = candidate[wins], challenge[wins]
