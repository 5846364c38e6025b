"""The scores of a result against its sample, all at once."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int, Shaped

from texloom.arrays import Image
from texloom.errors import ParameterError
from texloom.metrics.copying import copy_side
from texloom.metrics.distribution import sliced_wasserstein
from texloom.metrics.nearest import nearest
from texloom.metrics.patches import Picture, encoded, patch_vectors, windows
from texloom.metrics.seam import seam_ratio

QUERIES = 2500  # patches asked for their nearest neighbour, per direction


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
    queries: int | None = QUERIES,
) -> Scores:
    """Scores of a result against its sample, both as stored (encoded), integers or floats in [0, 1].

    Coherence and completeness are means over about ``queries`` patches on a regular grid over all of them, each with
    its exact nearest neighbour among *all* patches of the other picture; None asks every patch.

    Raises: ParameterError, if the channels differ or a picture is smaller than a patch.
    """
    ours, theirs = encoded(result), encoded(sample)
    if ours.shape[2] != theirs.shape[2]:
        channels = f"the sample has {theirs.shape[2]} channels and the result {ours.shape[2]}"
        raise ParameterError(f"{channels}: score maps of the same kind")
    places = grid_places(ours, queries)
    coherence, matches = _nearest_patches(ours, theirs, places)
    completeness, _ = _nearest_patches(theirs, ours, grid_places(theirs, queries))
    return Scores(
        swd=sliced_wasserstein(theirs, ours),
        coherence=coherence,
        completeness=completeness,
        copy=copy_side(theirs, ours, seeds=(places, matches)),
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


def _nearest_patches(
    asking: Image, asked: Picture, places: Int[np.ndarray, "place 2"]
) -> tuple[float, Int[np.ndarray, "place 2"]]:
    """Mean RMS (of 255) from patches at ``places`` to the nearest of all in the other picture, and where these are."""
    view = windows(asking)
    queries: Float32[np.ndarray, "place dim"] = view[places[:, 0], places[:, 1]].reshape(len(places), -1)
    found = nearest(queries, patch_vectors(asked))
    rms = np.sqrt(found.squared / queries.shape[1], dtype=np.float64)
    return 255.0 * float(rms.mean()), np.column_stack(np.unravel_index(found.index, windows(asked).shape[:2]))
