"""The scores of a result against its sample, all at once."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int, Shaped

from texloom.arrays import Image
from texloom.errors import ParameterError
from texloom.exemplar.patches import whole_squares
from texloom.metrics.copying import copy_side
from texloom.metrics.distribution import sliced_wasserstein
from texloom.metrics.nearest import nearest
from texloom.metrics.patches import SIDE, Usable, encoded, evenly, patch_places, patch_vectors, patches_at, windows
from texloom.metrics.seam import seam_ratio

QUERIES = 2500  # patches asked for their nearest neighbour, per direction
_FEWEST = 800  # that a mean needs


@dataclass(frozen=True)
class Scores:
    """How good a result is; for all but ``copy`` nothing better than 0 exists. No single one is enough."""

    swd: float  # 100 × sliced Wasserstein distance of 7×7 patches: same kinds of patches, in the same shares?
    coherence: float  # mean RMS (of 255) of a result's patch to the nearest of the sample: nothing made up?
    completeness: float  # the reverse: nothing left out?
    copy: float  # texels, side of the typical exactly copied piece: repetition
    seam: float  # step across the borders over steps inside: at most 1 tiles without a seam


def score(
    sample: Shaped[np.ndarray, "..."],
    result: Shaped[np.ndarray, "..."],
    *,
    usable: Usable = None,
    queries: int | None = QUERIES,
    most: int | None = None,
) -> Scores:
    """Scores of a result against its sample, both as stored (encoded), integers or floats in [0, 1].

    Coherence and completeness are means over about ``queries`` patches on a regular grid over all of them, each with
    its exact nearest neighbour among *all* patches of the other picture; None asks every patch. Only patches of the
    sample that are ``usable`` throughout count. Where a picture has more than ``most`` patches, swd looks at so many,
    and fewer are asked in proportion, so that the time hardly grows.

    Raises: ParameterError, if the channels differ, a picture is smaller than a patch, or none of the sample is usable.
    """
    ours, theirs = encoded(result), encoded(sample)
    if ours.shape[2] != theirs.shape[2]:
        channels = f"the sample has {theirs.shape[2]} channels and the result {ours.shape[2]}"
        raise ParameterError(f"{channels}: score maps of the same kind")
    known = patch_places(theirs, usable)
    if not len(known):
        raise ParameterError(f"no {SIDE}x{SIDE} patch of the sample is usable throughout: widen its mask")
    queries = fewer(queries, max(len(known), ours.shape[0] * ours.shape[1]), most)
    places = grid_places(ours, queries)
    asked = grid_places(theirs, queries) if usable is None else _usable_places(theirs, usable, known, queries)
    coherence, matches = _nearest_patches(ours, places, patch_vectors(theirs, usable))
    completeness, _ = _nearest_patches(theirs, asked, patch_vectors(ours))
    return Scores(
        swd=sliced_wasserstein(theirs, ours, usable, most=most),
        coherence=coherence,
        completeness=completeness,
        copy=copy_side(theirs, ours, seeds=(places, known[matches])),
        seam=seam_ratio(ours),
    )


def grid_places(image: Image, count: int | None) -> Int[np.ndarray, "place 2"]:
    """About ``count`` patch places, the middles of equal cells, so that no part counts more (all places for None)."""
    sides = windows(image).shape[:2]
    share = 1.0 if count is None else min(1.0, np.sqrt(count / (sides[0] * sides[1])))
    rows, columns = (_middles(side, max(1, round(side * share))) for side in sides)
    return np.stack(np.meshgrid(rows, columns, indexing="ij"), axis=-1).reshape(-1, 2)


def _middles(length: int, count: int) -> Int[np.ndarray, "count"]:
    """``count`` of ``range(length)`` in the middles of equal shares."""
    return ((2 * np.arange(count) + 1) * length) // (2 * count)


def _usable_places(
    image: Image, usable: Bool[np.ndarray, "row column"], known: Int[np.ndarray, "patch 2"], count: int | None
) -> Int[np.ndarray, "place 2"]:
    """Those of a grid that lie among the ``known``, dense enough that about ``count`` do."""
    rows, columns = windows(image).shape[:2]
    places = grid_places(image, None if count is None else count * rows * columns // len(known))
    inside = whole_squares(usable, SIDE)[places[:, 0], places[:, 1]]
    return places[inside] if inside.any() else evenly(known, count)


def fewer(queries: int | None, patches: int, most: int | None) -> int | None:
    """Fewer queries where they would be asked of more than ``most`` patches, but enough for a mean."""
    if queries is None or most is None or patches <= most:
        return queries
    return min(queries, max(_FEWEST, queries * most // patches))


def _nearest_patches(
    asking: Image, places: Int[np.ndarray, "place 2"], asked: Float32[np.ndarray, "patch dim"]
) -> tuple[float, Int[np.ndarray, "place"]]:
    """Mean RMS (of 255) from patches at ``places`` to the nearest of the others, and which these are."""
    queries = patches_at(asking, places)
    found = nearest(queries, asked)
    rms = np.sqrt(found.squared / queries.shape[1], dtype=np.float64)
    return 255.0 * float(rms.mean()), found.index
