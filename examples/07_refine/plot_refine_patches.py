"""Whole samples, grown together.

Left the sample; next, whole samples laid where Fourier transforms find that they fit, cut where they agree best; then
the bands along the cuts, in red; right those bands grown anew from what is on both sides (``--method refine-patches``).

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 5, figure 13; Kwatra et al.
2003, "Graphcut textures".
"""

import numpy as np

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.arrays import in_fours
from texloom.demo import draw
from texloom.domain.domain import Lattice
from texloom.exemplar.features import match_image
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.laying import Laying
from texloom.synthesis.refine_patches import RefinePatches

_RED = np.array([230, 40, 30])
_BAND = 1 / 8  # of the depth


def picture(detail: float = 1.0) -> Picture:
    """A row for each sample; ``detail`` scales the results' sides."""
    side = round(320 * detail)
    rows = []
    for name, seed in (("scales", 3), ("weave", 1)):
        sample, grid = draw(name, size=192), texloom.Grid(side, side)
        image, method = in_fours(match_image(sample)), RefinePatches()
        lattice = Lattice(side, side, wrap=False)
        canvas, depth = Canvas.empty(grid.count, image.shape[2]), method.depth_for(sample)
        laying = Laying(canvas, sample, image, lattice, None, depth=depth, reach=round(_BAND * depth), seed=seed)
        laying.run(lambda stage, done: None)
        laid = shown(canvas.sources(), sample, (side, side))
        marked = np.where(laying.band.reshape(side, side, 1), (laid + 2 * _RED) // 3, laid).astype(np.uint8)
        result = texloom.synthesize(sample, grid, method, seed=seed)
        rows.append(beside(of_map(sample.lead), laid, marked, shown(result.sources, sample, (side, side))))
    return below(*rows)
