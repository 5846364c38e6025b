"""Texture over a mesh of any shape.

Sites one texel apart cover the mesh; patches of the sample are traced over its triangles along a smooth direction
field, so nothing is flattened and nothing stretched. Colours and normals are baked on an atlas. The sample is inset.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields"; Knöppel, Crane, Pinkall &
Schröder 2013, "Globally optimal direction fields".
"""

import texloom
from examples.pictures import Picture, beside, coat, inset, of_map
from texloom.demo import draw, rabbit

COATS = ("scales", "knit", "bricks", "weave")


def picture(detail: float = 1.0) -> Picture:
    """The rabbit in four coats; ``detail`` scales how many texels cover it."""
    mesh = rabbit()
    field = texloom.smoothest(mesh, 1)
    pictures = []
    for name in COATS:
        sample = draw(name, size=192)
        texel = texloom.texel_for_repeats(mesh, 2.2 * detail, sample.shape[1])
        surface = texloom.Surface.build(mesh, field, texel=texel)
        result = texloom.synthesize(sample, surface, seed=0)
        pictures.append(inset(coat(surface, result.sources, sample), of_map(sample.lead), side=96))
    return beside(*pictures, gap=0)
