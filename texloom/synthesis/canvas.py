"""The texture as it grows."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int32

from texloom.arrays import Image
from texloom.domain.domain import Domain
from texloom.sources import SourceMap
from texloom.synthesis.gaps import fill_gaps


@dataclass(frozen=True, eq=False)
class Canvas:
    """What each site shows, from where in the exemplar, how turned, and the patch it came with (-1: none yet).

    The arrays are written in place while the texture grows; ``turn`` is radians against the site's frame.
    """

    position: Float32[np.ndarray, "site 2"]
    colour: Float32[np.ndarray, "site channel"]
    label: Int32[np.ndarray, "site"]
    turn: Float32[np.ndarray, "site"]

    @staticmethod
    def empty(count: int, channels: int) -> "Canvas":
        """No site coloured."""
        return Canvas(
            np.zeros((count, 2), np.float32),
            np.zeros((count, channels), np.float32),
            np.full(count, -1, np.int32),
            np.zeros(count, np.float32),
        )

    def close(self, domain: Domain, image: Image) -> None:
        """Continue the texture over sites that no patch reached."""
        bare = self.label < 0
        fill_gaps(domain, ~bare, self.position, self.turn, image.shape[:2])
        texel = np.rint(self.position[bare]).astype(np.int32)
        self.colour[bare] = image[texel[:, 0], texel[:, 1]]
        self.label[bare] = np.iinfo(np.int32).max  # a patch of its own, so that correction visits its border

    def sources(self) -> SourceMap:
        """One source a site."""
        turn = self.turn[:, None] if self.turn.any() else None
        return SourceMap(self.position[:, None], np.ones((len(self.position), 1), np.float32), turn)
