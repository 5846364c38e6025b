"""Filling as published, and by default.

From left to right: the hole; the paper's four scan directions, from each side to the opposite one; our default, blocks
that continue every border at once, cut by expansion moves and corrected where they meet.

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 5, figure 12.
"""

import numpy as np

from examples.pictures import Picture, below, beside, of_map
from texloom.demo import draw
from texloom.output.filled import filled_maps
from texloom.synthesis.fill import fill
from texloom.systems import refine


def picture(detail: float = 1.0) -> Picture:
    """A row for each picture; ``detail`` scales their sides."""
    side = round(224 * detail)
    rows = []
    for name in ("bricks", "scales"):
        sample, hole = draw(name, size=side), np.zeros((side, side), bool)
        hole[side * 3 // 8 : side * 5 // 8, side * 3 // 8 : side * 5 // 8] = True
        damaged = np.where(hole[..., None], np.uint8(255), of_map(sample.lead))
        fills = (refine.filling(sample, hole, seed=1), fill(sample, hole, seed=1))
        rows.append(beside(damaged, *(of_map(filled_maps(filled)["basecolor"]) for filled in fills)))
    return below(*rows)
