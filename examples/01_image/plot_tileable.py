"""A tile whose opposite borders fit together.

``Grid(wrap=True)`` is a torus: patches go across its borders like anywhere else, so there is no seam to hide. Left the
tile, right three by two of it.
"""

import numpy as np

import texloom
from examples.pictures import Picture, beside, shown
from texloom.demo import draw


def picture(detail: float = 1.0) -> Picture:
    """A tile and its repetition; ``detail`` scales its side."""
    side = round(256 * detail)
    sample = draw("knit", size=192)
    result = texloom.synthesize(sample, texloom.Grid(side, side, wrap=True), seed=3)
    tile = shown(result.sources, sample, (side, side))
    return beside(tile, np.tile(tile, (2, 3, 1)))
