"""Any size from a small sample.

An image of any size grows from a small sample: whole blocks of it are laid where they fit, and corrected where they
meet. Left the samples, 192 texels square, in the same scale as what grew from them.

Efros & Freeman 2001, "Image quilting for texture synthesis and transfer"; Lefebvre & Hoppe 2005, "Parallel controllable
texture synthesis"; Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields".
"""

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.demo import draw

SAMPLES = ("scales", "bricks")


def picture(detail: float = 1.0) -> Picture:
    """Samples and what grows from them; ``detail`` scales the results' sides."""
    rows, columns = round(392 * detail), round(560 * detail)
    samples = [draw(name, size=192) for name in SAMPLES]
    results = [texloom.synthesize(sample, texloom.Grid(rows, columns), seed=1) for sample in samples]
    grown = [shown(result.sources, sample, (rows, columns)) for result, sample in zip(results, samples, strict=True)]
    return beside(below(*(of_map(sample.lead) for sample in samples)), *grown)
