"""Another try in one place.

Left a tile that was grown; next the part of it that does not please, in red; then that part grown anew with three
seeds, the rest as it was. With ``wrap`` (``--tileable``) the part may lie over the border: the tile stays a tile.
"""

import numpy as np

import texloom
from examples.pictures import Picture, beside, of_map, shown
from texloom.demo import draw
from texloom.output.filled import filled_maps
from texloom.synthesis.fill import fill

_RED = np.array([230, 40, 30])


def picture(detail: float = 1.0) -> Picture:
    """Before, the part, and three tries; ``detail`` scales their sides."""
    side = round(224 * detail)
    sample = draw("bricks", size=192)
    grown = texloom.synthesize(sample, texloom.Grid(side, side, wrap=True), seed=6)
    tile = texloom.Exemplar(texloom.gather_images(grown.sources, sample, rows=side, columns=side))
    row, column = (np.minimum(at, side - at) / side for at in np.indices((side, side)))
    part = np.hypot(row - 0.3, column) < 0.22
    marked = np.where(part[..., None], (of_map(tile.lead) + 2 * _RED) // 3, of_map(tile.lead)).astype(np.uint8)
    tries = [fill(tile, part, sample=sample, wrap=True, seed=seed) for seed in (1, 2, 3)]
    again = (of_map(filled_maps(filled)["basecolor"]) for filled in tries)
    return beside(shown(grown.sources, sample, (side, side)), marked, *again)
