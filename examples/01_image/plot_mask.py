"""Only what the mask allows.

A stain (or a logo, a shadow, a hand) lies on the sample. A mask says which texels may be used; nothing of the others
gets into the result. Left the sample, then the mask, then the texture.
"""

import numpy as np

import texloom
from examples.pictures import Picture, beside, of_map, shown
from texloom.demo import draw
from texloom.exemplar.exemplar import to_map


def stained(side: int) -> texloom.Exemplar:
    """A sample with paint on it, and the mask of what is clean."""
    clean = draw("pebbles", size=side).maps["basecolor"].image
    row, column = np.indices((side, side)) / side - 0.5
    angle = np.arctan2(row + 0.06, column - 0.1)
    stain = np.hypot(row + 0.06, column - 0.1) < 0.17 * (1 + 0.25 * np.sin(5 * angle) + 0.1 * np.sin(11 * angle))
    paint = np.where(stain[..., None], np.float32([0.72, 0.02, 0.03]) * (0.6 + clean.mean()), clean)
    return texloom.Exemplar({"basecolor": to_map(paint, "colour")}, mask=~stain)


def picture(detail: float = 1.0) -> Picture:
    """Sample, mask and result; ``detail`` scales the result's sides."""
    rows, columns = round(400 * detail), round(640 * detail)
    sample = stained(256)
    result = texloom.synthesize(sample, texloom.Grid(rows, columns), seed=5)
    return beside(
        of_map(sample.lead),
        of_map(to_map(sample.usable[..., None], "data")),
        shown(result.sources, sample, (rows, columns)),
    )
