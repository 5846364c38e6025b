"""The same arrangement in another material.

Sources hold no colour. Kept in a file, they lay any other stack of the sample's size in the same arrangement: here the
same bricks, once as drawn and once painted white and worn. ``texloom apply`` does this on the command line.
"""

import numpy as np

import texloom
from examples.pictures import Picture, beside, inset, of_map, shown
from texloom.demo import draw
from texloom.exemplar.exemplar import to_map


def painted(sample: texloom.Exemplar) -> texloom.Exemplar:
    """The same wall in white paint, worn off where the bricks stand out most."""
    height, colour = (sample.maps[name].image for name in ("height", "basecolor"))
    worn = np.clip((height - 0.72) * 6 + (colour[..., :1] - 0.3) * 2, 0.0, 1.0)
    paint = np.float32([0.62, 0.72, 0.74]) * (0.45 + 0.55 * sample.maps["ao"].image)
    return texloom.Exemplar({"basecolor": to_map((worn * colour + (1 - worn) * paint).astype(np.float32), "colour")})


def picture(detail: float = 1.0) -> Picture:
    """Two materials on one set of sources; ``detail`` scales their sides."""
    rows, columns = round(448 * detail), round(640 * detail)
    sample = draw("bricks", size=256)
    sources = texloom.synthesize(sample, texloom.Grid(rows, columns), seed=3).sources
    stacks = (sample, painted(sample))
    return beside(*(inset(shown(sources, stack, (rows, columns)), of_map(stack.lead)) for stack in stacks))
