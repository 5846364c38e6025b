"""Scores on a surface: the same statistics, on pictures resampled from it along the field."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int, Shaped

from texloom.arrays import Image
from texloom.domain.patches import Patches
from texloom.errors import ParameterError
from texloom.metrics.distribution import LEVELS, halve, halved, projected_wasserstein
from texloom.metrics.nearest import nearest
from texloom.metrics.patches import SIDE, Usable, encoded, evenly, patch_places, patch_vectors
from texloom.metrics.score import QUERIES, fewer


@dataclass(frozen=True)
class SurfaceScores:
    """As on a plane (``Scores``); for resampled colours, which are never the stored ones, see ``surface_copying``."""

    swd: float
    coherence: float
    completeness: float


_VECTORS = 150_000  # patches looked at, as many as a 384² picture has


def read_pictures(
    patches: Patches, values: Float32[np.ndarray, "site channel"]
) -> Float32[np.ndarray, "picture row column channel"]:
    """What every wholly traced patch shows, its axes as the exemplar's: one small picture each.

    ``values`` are encoded. Patches that a border or a singularity cuts short are left out.
    """
    whole = (patches.sites[..., 0] >= 0).all(1)
    sites = patches.sites[whole]
    read = values[sites]
    if patches.weights is None:
        shown = read.mean(2)
    else:
        shown = (read * patches.weights[whole][..., None]).sum(2)
    return shown.reshape(len(sites), patches.width, patches.width, values.shape[1]).astype(np.float32)


def score_surface(
    sample: Shaped[np.ndarray, "..."],
    patches: Patches,
    values: Float32[np.ndarray, "site channel"],
    *,
    usable: Usable = None,
    most: int | None = None,
) -> SurfaceScores:
    """Scores of a textured surface against its sample, both encoded, through patches of 7 samples width or more.

    The pictures of all patches together are the result. swd counts the pyramid levels that the patches are wide enough
    for; coherence and completeness are asked of about as many patches as on a plane. ``usable`` and ``most`` are those
    of ``score``.

    Raises: ParameterError, if patches are too small or none is whole, or none of the sample is usable.
    """
    if patches.width < SIDE:
        raise ParameterError(f"scores need patches of {SIDE} samples or wider, these are {patches.width}")
    pictures = read_pictures(patches, values)
    if not len(pictures):
        raise ParameterError("no patch of this surface is whole: use smaller texels or narrower patches")
    exemplar = encoded(sample)
    theirs, ours = patch_vectors(exemplar, usable), _vectors(pictures)
    if not len(theirs):
        raise ParameterError(f"no {SIDE}x{SIDE} patch of the sample is usable throughout: widen its mask")
    queries = fewer(QUERIES, max(len(theirs), len(ours)), most) or QUERIES
    return SurfaceScores(
        swd=_distance_by_level(exemplar, pictures, usable, most),
        coherence=_mean_rms(ours, theirs, queries),
        completeness=_mean_rms(theirs, ours, queries),
    )


def _distance_by_level(sample: Image, pictures: np.ndarray, usable: Usable, most: int | None) -> float:
    """Mean swd over the levels, halving the sample and every picture."""
    distances = []
    for _ in range(LEVELS):
        theirs, ours = patch_vectors(sample, usable, most), evenly(_vectors(pictures), most)
        distances.append(projected_wasserstein(theirs, ours))
        sample, pictures = halve(sample), np.moveaxis(halve(np.moveaxis(pictures, 0, 2)), 2, 0)
        usable = halved(usable)
        if min(*sample.shape[:2], pictures.shape[1]) < SIDE or not len(patch_places(sample, usable)):
            break
    return 100.0 * float(np.mean(distances))


def chart_seam_ratio(
    values: Float32[np.ndarray, "site channel"],
    edges: Int[np.ndarray, "edge 2"],
    *,
    across: Int[np.ndarray, "pair 2"],
) -> float:
    """Mean difference between the two sides of chart borders over the 99th percentile of that between neighbours.

    ``edges`` are neighbouring sites inside charts, ``across`` pairs as far apart that a border parts; at most 1: the
    borders do not show. Without borders 0.
    """
    if not len(across):
        return 0.0
    usual = float(np.percentile(_differences(values, edges), 99)) if len(edges) else 0.0
    step = float(_differences(values, across).mean())
    if usual == 0.0:
        return 0.0 if step == 0.0 else float("inf")
    return step / usual


def _differences(values: np.ndarray, pairs: np.ndarray) -> Float[np.ndarray, "pair"]:
    """Mean absolute difference over the channels of every pair of sites."""
    return np.abs(values[pairs[:, 0]] - values[pairs[:, 1]]).mean(1, dtype=np.float64)


def _vectors(pictures: np.ndarray) -> Float32[np.ndarray, "patch dim"]:
    """7×7 patches of all pictures; evenly thinned where there are more than a large picture has."""
    inner = pictures.shape[1] - SIDE + 1
    stride = max(1, round(np.sqrt(len(pictures) * inner * inner / _VECTORS)))
    view = np.lib.stride_tricks.sliding_window_view(pictures, (SIDE, SIDE), axis=(1, 2))[:, ::stride, ::stride]
    vectors = view.reshape(-1, SIDE * SIDE * pictures.shape[3])
    return np.ascontiguousarray(vectors[:: max(1, round(len(vectors) / _VECTORS))])


def _mean_rms(asking: np.ndarray, asked: np.ndarray, queries: int) -> float:
    """Mean RMS (of 255) of about so many patches, evenly spaced in their order, to the nearest other."""
    step = max(1, len(asking) // queries)
    found = nearest(np.ascontiguousarray(asking[step // 2 :: step]), asked)
    return 255.0 * float(np.sqrt(found.squared / asking.shape[1], dtype=np.float64).mean())
