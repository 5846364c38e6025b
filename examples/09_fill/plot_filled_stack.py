"""Every map of a damaged stack.

One fill for all maps: base colour, normal, roughness, height, ambient occlusion, aligned to the texel. Above with the
hole, below filled.
"""

import numpy as np

from examples.pictures import Picture, below, beside, of_map
from texloom.demo import draw
from texloom.output.filled import filled_maps
from texloom.synthesis.fill import fill

MAPS = ("basecolor", "normal", "roughness", "height", "ao")


def picture(detail: float = 1.0) -> Picture:
    """Two rows of maps; ``detail`` scales their sides."""
    side = round(224 * detail)
    stack = draw("scales", size=side)
    row, column = np.indices((side, side)) / side - 0.5
    angle = np.arctan2(row, column)
    hole = np.hypot(row, column) < 0.24 * (1 + 0.3 * np.sin(4 * angle) + 0.12 * np.sin(9 * angle))
    damaged = [np.where(hole[..., None], np.uint8(255), of_map(stack.maps[name])) for name in MAPS]
    maps = filled_maps(fill(stack, hole, seed=3))
    return below(beside(*damaged), beside(*(of_map(maps[name]) for name in MAPS)))
