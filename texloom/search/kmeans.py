"""k-means by Lloyd's steps on dense products; seeded by a hash, so the same everywhere."""

import numpy as np
from jaxtyping import Float32, Int32

from texloom import draws
from texloom.search.exhaustive import ExhaustiveIndex
from texloom.search.matching import Vectors


def cluster(
    vectors: Vectors, count: int, *, seed: int = 0, passes: int = 10
) -> tuple[Float32[np.ndarray, "cluster dim"], Int32[np.ndarray, "candidate"]]:
    """Centres, and the centre nearest to each vector.

    Starts from ``count`` random vectors; stops when no vector changes its centre or after ``passes``. A centre left
    without vectors moves to the vector worst served, and is dropped if the last pass leaves it so (equal vectors).
    """
    centres = vectors[np.sort(draws.permutation(seed, count=len(vectors))[:count])]
    match = ExhaustiveIndex(centres).nearest(vectors)
    for _ in range(passes):
        centres = _means(vectors, match.index, match.cost, count)
        following = ExhaustiveIndex(centres).nearest(vectors)
        settled = np.array_equal(following.index, match.index)
        match = following
        if settled:
            break
    filled, label = np.unique(match.index, return_inverse=True)
    return centres[filled], label.astype(np.int32)


def _means(
    vectors: Vectors, label: Int32[np.ndarray, "candidate"], cost: Float32[np.ndarray, "candidate"], count: int
) -> Float32[np.ndarray, "cluster dim"]:
    """Mean of the vectors of each label, summed in the order of the vectors."""
    order = np.argsort(label, kind="stable")
    size = np.bincount(label, minlength=count)
    start = np.concatenate([[0], np.cumsum(size)[:-1]])
    filled = size > 0
    centres = np.empty((count, vectors.shape[1]), np.float32)
    centres[filled] = np.add.reduceat(vectors[order], start[filled]) / size[filled, None].astype(np.float32)
    worst = np.argsort(-cost, kind="stable")[: np.count_nonzero(~filled)]
    centres[~filled] = vectors[worst]
    return centres
