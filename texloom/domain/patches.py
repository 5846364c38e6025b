"""Square patches of samples laid on a domain: what synthesis reads from it and pastes onto it.

On a grid a sample falls on a site; on a surface it falls in a triangle and is the barycentric mean of three sites.
Synthesis sees the same arrays either way.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int32


@dataclass(frozen=True, eq=False)
class Patches:
    """``patch`` squares of ``width × width`` samples, one texel apart, rows and columns as in the exemplar.

    Sample ``(row, column)`` of a patch is entry ``row * width + column``. Its value is the mean of ``corner`` sites
    (1 on a grid, 3 on a surface) under ``weights``; a sample that tracing could not reach has site -1.

    The cover is the inverse, in compressed rows: site ``i`` lies in patches ``cover_patch[cover_start[i] :
    cover_start[i + 1]]``, in increasing order, at ``cover_position`` [row, column] in samples of that patch.
    ``cover_turn`` is the angle of the patch's axes against the site's frame there (None where all are 0).
    """

    width: int
    centres: Int32[np.ndarray, "patch"]  # the site each patch was laid around
    sites: Int32[np.ndarray, "patch sample corner"]
    weights: Float32[np.ndarray, "patch sample corner"] | None  # None on a grid: the one site counts whole
    cover_start: Int32[np.ndarray, "sites_plus_one"]
    cover_patch: Int32[np.ndarray, "entry"]
    cover_position: Float32[np.ndarray, "entry 2"]
    cover_turn: Float32[np.ndarray, "entry"] | None = None

    @property
    def count(self) -> int:
        """Number of patches."""
        return len(self.centres)
