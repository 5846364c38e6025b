"""Refined pixel by pixel.

From left to right: the sample; the seed points; the first scan-line pass, which knows seeds and finished pixels only;
the tenth, with whole windows that wrap around; and the parallel order, the default, from blocks instead of seeds.

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 3, figures 1, 5 and 8.
"""

import numpy as np

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.demo import draw
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.scale import dominant_scale
from texloom.synthesis.refine import Refine
from texloom.synthesis.seeds import plant

METHODS = (Refine(order="scan-line", passes=1), Refine(order="scan-line", threshold=0.0), Refine())
SAMPLES = {"weave": (128, 192), "scales": (96, 144)}  # sides of samples and results
_SEED = 1


def seeds(sample: Exemplar, side: int) -> Picture:
    """The seed points of a square, each drawn large."""
    colours, pitch = of_map(sample.lead), round(dominant_scale(sample).scale)
    grid = max(1, round(side / pitch))
    source = plant(colours.astype(np.float32), pitch, (grid, grid), seed=_SEED)
    picture = np.full((side, side, 3), 255, np.uint8)
    for (row, column), texel in zip(np.ndindex(grid, grid), source.reshape(-1, 2), strict=True):
        top, left = row * side // grid, column * side // grid
        picture[top : top + 4, left : left + 4] = colours[texel[0], texel[1]]
    return picture


def picture(detail: float = 1.0) -> Picture:
    """A row for each sample; ``detail`` scales the results' sides."""
    rows = []
    for name, (size, wide) in SAMPLES.items():
        sample, side = draw(name, size=size), round(wide * detail)
        results = [texloom.synthesize(sample, texloom.Grid(side, side, wrap=True), m, seed=_SEED) for m in METHODS]
        grown = (shown(result.sources, sample, (side, side)) for result in results)
        rows.append(beside(of_map(sample.lead), seeds(sample, side), *grown))
    return below(*rows)
