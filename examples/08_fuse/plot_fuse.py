"""Two textures where a map wants them.

From left to right: the map, red for bricks and blue for pebbles; both textures grown through a belt along the border
and cut where they differ least, the default; the paper's belts, filled from a sample cut together of the two.

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 4, figures 2 and 6.
"""

import numpy as np

from examples.pictures import Picture, beside, shown
from texloom import Grid
from texloom.demo import draw
from texloom.fusion.fuse import fuse
from texloom.fusion.labels import from_picture

COLOURS = np.array([(200, 40, 40), (40, 70, 190)], np.uint8)


def wave(side: int) -> Picture:
    """A map as one would paint it."""
    row, column = np.indices((side, side)) / side
    below = row - 0.5 > 0.16 * np.sin(2 * np.pi * column) + 0.05 * np.sin(7 * np.pi * column)
    return COLOURS[below.astype(int)]


def picture(detail: float = 1.0) -> Picture:
    """The map and two fusions; ``detail`` scales their sides."""
    side = round(384 * detail)
    samples = [draw("bricks", size=256), draw("pebbles", size=256)]
    painted = wave(side)
    labels = from_picture(painted / 255.0, len(samples)).labels.ravel()
    fusions = [fuse(samples, labels, Grid(side, side), belts=belts, seed=1) for belts in ("cut", "sample")]
    return beside(painted, *(shown(fused.result.sources, fused.exemplar, (side, side)) for fused in fusions))
