"""Grain along the shape.

The field may follow the lines of least curvature, lengthwise on a limb, and be smooth where the surface has no
direction of its own. A field leads the columns of the sample; the grain of this wood runs down its rows, so the field
is turned by a right angle. Left the smoothest field of lines, right the one by curvature, each from two sides.
"""

import texloom
from examples.pictures import BACK, FRONT, Picture, beside, coat
from texloom.demo import draw, rabbit
from texloom.field.curvature import along_curvature
from texloom.field.direction import DirectionField


def picture(detail: float = 1.0) -> Picture:
    """Wood along two fields; ``detail`` scales how many texels cover the mesh."""
    mesh, sample = rabbit(), draw("wood", size=160)
    texel = texloom.texel_for_repeats(mesh, 2.2 * detail, sample.shape[1])
    lengthwise = along_curvature(mesh, 2)
    across = DirectionField(2, -lengthwise.power)  # squares of directions: the other sign is a right angle
    pictures = []
    for field in (texloom.smoothest(mesh, 2), across):
        surface = texloom.Surface.build(mesh, field, texel=texel)
        result = texloom.synthesize(sample, surface, seed=0)
        pictures.append(coat(surface, result.sources, sample, [FRONT, BACK]))
    return beside(*pictures, gap=0)
