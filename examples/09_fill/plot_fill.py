"""Holes that cannot be told.

Left pictures with what is to be filled in white: scratches, blots, a word; right the pictures filled with more of what
is around (``texloom fill``). Everything outside the holes stays, bit by bit.

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 5, figure 12.
"""

import numpy as np
from PIL import Image, ImageDraw

from examples.pictures import Picture, below, beside, of_map
from texloom.demo import draw
from texloom.output.filled import filled_maps
from texloom.synthesis.fill import fill


def scratches(pen: ImageDraw.ImageDraw, side: int) -> None:
    """Two thin ones and a wide one."""
    for (x0, y0, x1, y1), width in zip(((4, 20, 90, 76), (60, 2, 22, 97), (75, 3, 96, 60)), (3, 2, 5), strict=True):
        pen.line([v * side / 100 for v in (x0, y0, x1, y1)], fill=255, width=width)


def blots(pen: ImageDraw.ImageDraw, side: int) -> None:
    """Three, of several sizes."""
    for x, y, radius in ((28, 34, 15), (70, 66, 20), (74, 20, 9)):
        pen.ellipse([v * side / 100 for v in (x - radius, y - radius, x + radius, y + radius)], fill=255)


def word(pen: ImageDraw.ImageDraw, side: int) -> None:
    """Written large."""
    pen.text((0.07 * side, 0.32 * side), "HOLE", fill=255, font_size=0.31 * side, stroke_width=2)


def picture(detail: float = 1.0) -> Picture:
    """A row for each picture; ``detail`` scales their sides."""
    side = round(256 * detail)
    pairs = []
    for name, draw_on in (("bricks", blots), ("pebbles", scratches), ("weave", word), ("scales", blots)):
        drawn, sample = Image.new("L", (side, side)), draw(name, size=side)
        draw_on(ImageDraw.Draw(drawn), side)
        hole = np.asarray(drawn) > 127
        damaged = np.where(hole[..., None], np.uint8(255), of_map(sample.lead))
        pairs.append(beside(damaged, of_map(filled_maps(fill(sample, hole, seed=1))["basecolor"])))
    return below(beside(*pairs[:2], gap=24), beside(*pairs[2:], gap=24), gap=24)
