"""The sites around a site, and where they lie in its frame: stencils without tracing, for a few texels."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int32


@dataclass(frozen=True, eq=False)
class Neighbourhoods:
    """``k`` sites around each of ``n``; the first is the site itself, -1 ends the list.

    ``offset`` is [row, column] texels from the middle site in its frame; where all neighbourhoods are alike it holds
    one row. ``turn`` is the angle by which the middle site's frame is turned against the neighbour's, as the field
    counts: a multiple of 2π/n (None where all are 0).
    """

    sites: Int32[np.ndarray, "n k"]
    offset: Float32[np.ndarray, "n_or_1 k 2"]
    turn: Float32[np.ndarray, "n k"] | None = None


@dataclass(frozen=True, eq=False)
class Stencils:
    """``k`` samples around each of ``n`` sites, for what is shown there to be read.

    A sample shows the mean of ``corner`` sites under ``weights`` (None: of the one site); -1 is no site. It lies at
    ``offset`` [row, column] texels from the middle site, in its frame; one row where all stencils are alike.
    """

    sites: Int32[np.ndarray, "n k corner"]
    weights: Float32[np.ndarray, "n k corner"] | None
    offset: Float32[np.ndarray, "n_or_1 k 2"]


def as_stencils(around: Neighbourhoods) -> Stencils:
    """The neighbouring sites themselves as the samples."""
    return Stencils(around.sites[:, :, None], None, around.offset)


@dataclass(frozen=True, eq=False)
class Beside:
    """For each of ``n`` places the site of a domain nearest to it, and how it lies from that.

    ``offset`` is [row, column] texels of that domain in the site's frame; ``turn`` the angle by which the site's
    frame is turned against the place's, as the field counts: a multiple of 2π/order.
    """

    site: Int32[np.ndarray, "n"]
    offset: Float32[np.ndarray, "n 2"]
    turn: Float32[np.ndarray, "n"]


NEAR = 3
"""Texels within which a neighbourhood holds every site; and where frames turn, its greatest reach."""


def stencil(reach: int) -> Int32[np.ndarray, "k 2"]:
    """[row, column] steps of a square of ``2 reach + 1`` texels a side: all near ones, farther out ever fewer.

    From NEAR on every third row and column is kept, from three times that every sixth, and so on: about forty steps
    for each doubling of the reach. The middle comes first, then rings of growing size.
    """
    parts, inner, outer, step = [square(min(NEAR, reach))], NEAR, 3 * NEAR, NEAR
    while inner < reach:
        steps = square(min(outer, reach) // step) * np.int32(step)
        parts.append(steps[np.abs(steps).max(1) > inner])
        inner, outer, step = outer, 2 * outer, 2 * step
    return np.concatenate(parts)


def square(reach: int) -> Int32[np.ndarray, "k 2"]:
    """All [row, column] steps of a square of ``2 reach + 1`` texels a side: the middle, then rings of growing size."""
    side = np.arange(-reach, reach + 1, dtype=np.int32)
    steps = np.stack(np.meshgrid(side, side, indexing="ij"), -1).reshape(-1, 2)
    return np.ascontiguousarray(steps[np.argsort(np.abs(steps).max(1), kind="stable")])
