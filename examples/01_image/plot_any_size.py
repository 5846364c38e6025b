"""Any size from a small sample.

A stack of maps goes in, an image of any size comes out: whole blocks of the sample are laid where they fit, and
corrected where they meet. The sample is the small square at the lower left of each picture.

Efros & Freeman 2001, "Image quilting for texture synthesis and transfer"; Lefebvre & Hoppe 2005, "Parallel controllable
texture synthesis"; Chen, Liu & Dong 2012, "Local resampling for patch-based texture synthesis in vector fields".
"""

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.demo import draw


def picture(detail: float = 1.0) -> Picture:
    """Samples and what grows from them; ``detail`` scales the results' sides."""
    rows, columns = round(448 * detail), round(704 * detail)
    pairs = []
    for name in ("pebbles", "wood"):
        sample = draw(name, size=192)
        result = texloom.synthesize(sample, texloom.Grid(rows, columns), seed=1)
        pairs.append(beside(of_map(sample.lead), shown(result.sources, sample, (rows, columns))))
    return below(*pairs)
