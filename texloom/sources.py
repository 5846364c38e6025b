"""The result of every synthesis: which part of the exemplar each site shows."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32


@dataclass(frozen=True, eq=False)
class SourceMap:
    """At most four sources a site, heaviest first, weights summing to one.

    A source is a similarity map valid around its site: the exemplar at ``position`` (in texels, [row, column], texel
    centres at integers), its axes turned by ``turn`` radians against the site's own frame and enlarged by ``scale``.
    A point at ``offset`` [row, column] texels from the site, in the site's frame, shows the exemplar at
    ``position + R(turn) offset / scale``. Values of different sources are blended, coordinates never.

    ``turn`` and ``scale`` are None where all are 0 and 1.
    """

    position: Float32[np.ndarray, "site k 2"]
    weight: Float32[np.ndarray, "site k"]
    turn: Float32[np.ndarray, "site k"] | None = None
    scale: Float32[np.ndarray, "site k"] | None = None

    @property
    def count(self) -> int:
        """Number of sites."""
        return len(self.position)
