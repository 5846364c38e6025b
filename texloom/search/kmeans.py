"""k-means by Lloyd's steps on dense products; seeded by a hash, so the same everywhere."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int32

from texloom import draws
from texloom.exemplar.blas import over_blocks, single_threaded
from texloom.progress import Report, silent
from texloom.search.exhaustive import ExhaustiveIndex
from texloom.search.matching import Vectors, squared_distance

Centres = Float32[np.ndarray, "cluster dim"]
Labels = Int32[np.ndarray, "candidate"]

_TASK = 4096  # vectors a thread takes at once
_BLOCK = 256  # vectors compared at once: their scores stay in cache while the largest is found
_LANES = 16  # centres are filled up to a multiple, so that every score of a product is summed in the same order
_FIRST = 64  # vectors a cluster that are clustered before all are
_ROUNDING = 2.0**-20  # of the greatest squared length: nearer than this a vector cannot be served
_HASTE = 8  # power of the share kept that grows about evenly from pass to pass
_PICK = 0x3EA  # purpose of the draw that picks them


@dataclass(frozen=True, eq=False)
class Clustering:
    """Centres, the centre nearest to each vector, and how the steps over all vectors ended."""

    centres: Centres
    label: Labels
    passes: int
    kept: float  # share of the vectors that kept their centre in the last pass

    @property
    def filled(self) -> "Clustering":
        """Without the centres that no vector is nearest to."""
        used, label = np.unique(self.label, return_inverse=True)
        return Clustering(self.centres[used], label.astype(np.int32), self.passes, self.kept)


def cluster(vectors: Vectors, count: int, *, seed: int = 0, passes: int = 10) -> tuple[Centres, Labels]:
    """Centres, and the centre nearest to each vector.

    Starts from ``count`` random vectors; stops when no vector changes its centre or after ``passes``. A centre left
    without vectors moves to the vector worst served, and is dropped if the last pass leaves it so (equal vectors).
    """
    found = lloyd(vectors, _random(vectors, count, seed), passes=passes, nearest=_exactly_nearest).filled
    return found.centres, found.label


def settle(
    vectors: Vectors, count: int, *, kept: float, seed: int = 0, passes: int = 100, report: Report = silent
) -> Clustering:
    """Clusters of all vectors, stopped when the share ``kept`` of them stay with their centre.

    Random vectors, 64 a cluster, are clustered first, which moves the centres most of their way for little.
    """
    centres = _random(vectors, count, seed)
    if len(vectors) > _FIRST * count:
        few = np.sort(draws.permutation(seed, _PICK, count=len(vectors))[: _FIRST * count])
        centres = lloyd(vectors[few], centres, kept=kept, passes=passes).centres
    return _apart(lloyd(vectors, centres, kept=kept, passes=passes, report=report).filled)


def nearest_centre(vectors: Vectors, centres: Centres) -> Labels:
    """The nearest centre of each vector; equal ones take the lowest index.

    Which of two wins that are equally far but for rounding is left to rounding.
    """
    nearest = to_nearest(centres)
    labels = over_blocks(lambda first, last: nearest(vectors[first:last]), len(vectors), _TASK)
    return np.concatenate(labels) if labels else np.zeros(0, np.int32)


def to_nearest(centres: Centres) -> Callable[[Vectors], Labels]:
    """``nearest_centre`` made ready for a few vectors at a time, on the calling thread.

    |v - c|² = |v|² - (2 v·c - |c|²): the bracket is one product, its largest entry wins.
    """
    mean = centres.mean(axis=0)
    table = _table(centres - mean)

    def nearest(vectors: Vectors) -> Labels:
        label = np.empty(len(vectors), np.int32)
        extended = np.ones((min(_BLOCK, len(vectors)), len(table)), np.float32)
        for first in range(0, len(vectors), _BLOCK):
            block = vectors[first : first + _BLOCK]
            np.subtract(block, mean, out=extended[: len(block), :-1])
            label[first : first + _BLOCK] = (extended[: len(block)] @ table).argmax(axis=1)
        return label

    return nearest


def lloyd(
    vectors: Vectors,
    centres: Centres,
    *,
    passes: int,
    kept: float = 1.0,
    nearest: Callable[[Vectors, Centres], Labels] = nearest_centre,
    report: Report = silent,
) -> Clustering:
    """Lloyd's steps from these centres, until the share ``kept`` of the vectors keep theirs or after ``passes``.

    A centre that no vector is nearest to moves to the vector worst served of another cluster. O(vector · centre · dim)
    time a pass.
    """
    label = nearest(vectors, centres)
    by_dimension = np.ascontiguousarray(vectors.T)
    done, share, settled = 0, 0.0, False
    while done < passes and not settled:
        centres = _means(by_dimension, label, centres)
        moved = _fill_empty(centres, vectors, label)
        following = nearest(vectors, centres)
        share = float(np.mean(following == label))
        settled = share == 1.0 or (share >= kept and not moved)
        label, done = following, done + 1
        report("cluster", min(share / kept, 1.0) ** _HASTE)
    return Clustering(centres, label, done, share)


def _exactly_nearest(vectors: Vectors, centres: Centres) -> Labels:
    """The same where even rounding must not choose: it takes twice as long."""
    return ExhaustiveIndex(centres).nearest(vectors).index


def _table(centres: Centres) -> Float32[np.ndarray, "dim_and_bias centre"]:
    """2 c over -|c|², one column a centre, and columns that never win."""
    count, dim = centres.shape
    table = np.zeros((dim + 1, count + -count % _LANES), np.float32)
    table[:dim, :count] = 2.0 * centres.T
    table[dim] = -np.inf
    table[dim, :count] = -np.einsum("ij,ij->i", centres, centres)
    return table


def _apart(found: Clustering) -> Clustering:
    """Centres that only rounding tells apart made one, the first: else rounding would tell equal vectors apart too."""
    from scipy.sparse.csgraph import connected_components

    length = np.einsum("ij,ij->i", found.centres, found.centres)
    with single_threaded():
        squared = length[:, None] + length - 2 * found.centres @ found.centres.T
    _, group = connected_components(squared < _ROUNDING * length.max(), directed=False)
    first = np.unique(group, return_index=True)[1]
    return Clustering(found.centres[first], group[found.label].astype(np.int32), found.passes, found.kept)


def _random(vectors: Vectors, count: int, seed: int) -> Centres:
    """That many of the vectors."""
    return vectors[np.sort(draws.permutation(seed, count=len(vectors))[:count])]


def _means(by_dimension: Float32[np.ndarray, "dim candidate"], label: Labels, centres: Centres) -> Centres:
    """Mean of the vectors of each label, summed in the order of the vectors; that of none stays where it was."""
    count = len(centres)
    size = np.bincount(label, minlength=count)
    total = np.stack([np.bincount(label, weights=values, minlength=count) for values in by_dimension], axis=1)
    return np.where(size[:, None] > 0, total / np.maximum(size, 1)[:, None], centres).astype(np.float32)


def _fill_empty(centres: Centres, vectors: Vectors, label: Labels) -> bool:
    """Move centres without vectors to the vectors worst served, one of each cluster; whether any moved."""
    empty = np.flatnonzero(np.bincount(label, minlength=len(centres)) == 0)
    if not len(empty):
        return False
    cost = squared_distance(vectors, centres, label)
    worst_first = np.argsort(-cost, kind="stable")
    worst_first = worst_first[cost[worst_first] > _ROUNDING * float(np.einsum("ij,ij->i", centres, centres).max())]
    one_each = np.sort(np.unique(label[worst_first], return_index=True)[1])
    chosen = worst_first[one_each][: len(empty)]
    centres[empty[: len(chosen)]] = vectors[chosen]
    return len(chosen) > 0
