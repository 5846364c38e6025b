"""Four methods on the same sample.

From left to right: the sample; the paper's texture optimization (``LeastSquares``) and patch-based sampling
(``BoundarySampling``); ours after the same two ideas, ``PatchSampling`` and the default, ``Optimize``.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", sections 4 and 5.
"""

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.demo import draw

METHODS = (texloom.LeastSquares, texloom.BoundarySampling, texloom.PatchSampling, texloom.Optimize)


def picture(detail: float = 1.0) -> Picture:
    """A row for each sample; ``detail`` scales the results' sides."""
    side = round(288 * detail)
    rows = []
    for name in ("pebbles", "weave"):
        sample = draw(name, size=128)
        results = [texloom.synthesize(sample, texloom.Grid(side, side), method(), seed=1) for method in METHODS]
        rows.append(beside(of_map(sample.lead), *(shown(result.sources, sample, (side, side)) for result in results)))
    return below(*rows)
