"""Uniform and progressively variant texture over the same field.

The direction of a vector turns the texture, its length enlarges it. Left of each pair all samples are one texel apart,
right their distance follows the length: a ring that grows outwards, and rays that do.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", fig. 2 and fig. 8.
"""

import texloom
from examples.pictures import Picture, beside, shown
from texloom.demo import draw
from texloom.field.planar import radial, ring


def picture(detail: float = 1.0) -> Picture:
    """Four pictures in a row; ``detail`` scales the sides."""
    side = round(400 * detail)
    pictures = []
    for name, field in (("scales", ring), ("bricks", radial)):
        sample = draw(name, size=160)
        for scale in (1.0, 0.45):
            planar = field(side, side, centre_scale=scale)
            grid = texloom.Grid(side, side, field=planar.direction, magnitude=planar.scale)
            pictures.append(shown(texloom.synthesize(sample, grid, seed=6).sources, sample, (side, side)))
    return beside(*pictures)
