"""How far the patches of a result are, as a population, from those of the sample."""

from functools import cache

import numpy as np
from jaxtyping import Bool, Float32

from texloom.arrays import Image
from texloom.exemplar.blas import over_blocks
from texloom.metrics.patches import SIDE, Picture, Usable, patch_places, patch_vectors

_PROJECTIONS = 128
_QUANTILES = 1024
LEVELS = 3
_BLOCK = 32  # projections at a time


def sliced_wasserstein(sample: Image, result: Picture, usable: Usable = None, *, most: int | None = None) -> float:
    """100 × the mean one-dimensional Wasserstein distance of 7×7 patches over fixed projections and pyramid levels.

    Values are encoded, in [0, 1]. Each level projects all whole patches of both pictures on 128 fixed unit vectors and
    averages the distance of 1024 evenly spaced quantiles; the levels (full, half, quarter size, means of 2×2 texels)
    count alike. A level too small for one patch is left out, and patches of the sample that are not wholly usable.
    Of more than ``most`` patches as many are looked at, evenly spaced.
    """
    distances = []
    for _ in range(LEVELS):
        ours, theirs = patch_vectors(result, most=most), patch_vectors(sample, usable, most)
        distances.append(projected_wasserstein(theirs, ours))
        sample, result = halve(sample), halve(result)
        usable = halved(usable)
        if min(sample.shape[:2] + result.shape[:2]) < SIDE or not len(patch_places(sample, usable)):
            break
    return 100.0 * float(np.mean(distances))


def halve(image: Float32[np.ndarray, "row column *rest"]) -> Float32[np.ndarray, "row2 column2 *rest"]:
    """Means of 2×2 texels; an odd last row or column is dropped."""
    even = image[: image.shape[0] // 2 * 2, : image.shape[1] // 2 * 2]
    return (even[0::2, 0::2] + even[1::2, 0::2] + even[0::2, 1::2] + even[1::2, 1::2]) * np.float32(0.25)


def halved(usable: Usable) -> Bool[np.ndarray, "half_row half_column"] | None:
    """The mask of the halved picture: usable where all four texels are."""
    return None if usable is None else halve(usable.astype(np.float32)) == 1


def projected_wasserstein(sample: Float32[np.ndarray, "texel dim"], result: Float32[np.ndarray, "patch dim"]) -> float:
    """Mean distance of 1024 quantiles over the fixed projections of two sets of vectors, however many each holds."""
    directions = _directions(sample.shape[1])

    def distance(first: int, last: int) -> float:
        some = directions[first:last]
        pairs = zip(some @ result.T, some @ sample.T, strict=True)
        return sum(float(np.abs(_quantiles(ours) - _quantiles(theirs)).mean()) for ours, theirs in pairs)

    return sum(over_blocks(distance, _PROJECTIONS, _BLOCK)) / _PROJECTIONS


def _quantiles(values: Float32[np.ndarray, "n"]) -> Float32[np.ndarray, "q"]:
    """Evenly spaced quantiles (at the middles of 1024 equal shares), linear between order statistics."""
    ordered = np.sort(values)
    at = (np.arange(_QUANTILES) + 0.5) / _QUANTILES * len(ordered) - 0.5
    return np.interp(at, np.arange(len(ordered)), ordered).astype(np.float32)


@cache
def _directions(dimension: int) -> Float32[np.ndarray, "projection dim"]:
    """The same unit vectors for every score of this dimension."""
    vectors = np.random.default_rng(dimension).standard_normal((_PROJECTIONS, dimension))
    return (vectors / np.linalg.norm(vectors, axis=1, keepdims=True)).astype(np.float32)
