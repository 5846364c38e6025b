"""What every search is: candidates prepared once, then the cheapest of them for each query, again and again."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from jaxtyping import Float32, Int32

Vectors = Float32[np.ndarray, "candidate dim"]
State = Mapping[str, np.ndarray]
"""What a search learnt from its candidates, by name: enough, with the candidates, to restore its index."""


@dataclass(frozen=True, eq=False)
class Match:
    """The candidate found for each query, and its squared distance in the space of the queries."""

    index: Int32[np.ndarray, "query"]
    cost: Float32[np.ndarray, "query"]


class Index(Protocol):
    """Candidates made ready to be searched."""

    def nearest(self, queries: Float32[np.ndarray, "query dim"]) -> Match:
        """A cheap candidate for every query; equal costs take the lowest index."""
        ...

    def state(self) -> State:
        """What was learnt, for ``Search.restore``."""
        ...


class Search(Protocol):
    """A way to find cheap candidates. Frozen dataclasses of parameters; the index owns the arrays."""

    def prepare(self, vectors: Vectors) -> Index:
        """Learn from the candidates."""
        ...

    def restore(self, vectors: Vectors, state: State) -> Index:
        """The index of a former ``prepare`` on the same candidates."""
        ...


def squared_distance(
    queries: Float32[np.ndarray, "query dim"], vectors: Vectors, index: Int32[np.ndarray, "query"]
) -> Float32[np.ndarray, "query"]:
    """Squared distance of each query to its candidate, from the differences, so that equal vectors give 0."""
    difference = queries - vectors[index]
    return np.einsum("ij,ij->i", difference, difference)
