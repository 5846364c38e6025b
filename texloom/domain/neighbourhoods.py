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
