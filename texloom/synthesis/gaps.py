"""Sites that no patch reached, at singularities and narrow boundaries: their neighbours' sources are continued."""

import numpy as np
from jaxtyping import Bool, Float32

from texloom.domain.domain import Domain


def fill_gaps(
    domain: Domain,
    known: Bool[np.ndarray, "site"],
    position: Float32[np.ndarray, "site 2"],
    turn: Float32[np.ndarray, "site"],
    shape: tuple[int, int],
    sites: Bool[np.ndarray, "site"] | None = None,
) -> None:
    """Give every unknown site of ``sites`` (None: of all) the source of the nearest known one beside it.

    It is moved by the offset between them; outwards from what is known, in place.

    Positions stay within an exemplar of ``shape``: at its border they stand still.

    Parts of the domain where nothing is known keep what they have.
    """
    known = known.copy()
    missing = np.flatnonzero(~known if sites is None else ~known & sites).astype(np.int32)
    while len(missing):
        around = domain.neighbourhoods(missing, 1)
        usable = (around.sites >= 0) & known[around.sites]
        offset = np.broadcast_to(around.offset, (*around.sites.shape, 2))
        distance = np.where(usable, (offset**2).sum(2), np.inf)
        nearest = distance.argmin(1)
        row = np.flatnonzero(usable[np.arange(len(missing)), nearest])
        if not len(row):
            return
        column = nearest[row]
        site, other = missing[row], around.sites[row, column]
        angle = turn[other] - (0.0 if around.turn is None else around.turn[row, column])
        continued = position[other] - turned(offset[row, column], angle)
        position[site] = np.clip(continued, 0, np.array(shape, np.float32) - 1)
        turn[site] = angle
        known[site] = True
        missing = missing[~known[missing]]


def turned(offset: Float32[np.ndarray, "n 2"], angle: Float32[np.ndarray, "n"]) -> Float32[np.ndarray, "n 2"]:
    """[row, column] offsets as axes turned counter-clockwise by ``angle`` read them."""
    c, s = np.cos(angle), np.sin(angle)
    row, column = offset.T
    return np.stack([c * row + s * column, c * column - s * row], 1).astype(np.float32)
