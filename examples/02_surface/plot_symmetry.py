"""Fields of different symmetry.

A field of one direction cannot be smooth all over a closed surface; lines and crosses can be smoother, for their
singularities are halves and quarters. A weave looks the same after a quarter turn, so crosses suit it: left arrows,
middle lines, right crosses.

Knöppel, Crane, Pinkall & Schröder 2013, "Globally optimal direction fields".
"""

import texloom
from examples.pictures import Picture, beside, coat
from texloom.demo import draw, rabbit
from texloom.output.camera import Camera

ABOVE = Camera(azimuth=20, elevation=30, margin=0.03)


def picture(detail: float = 1.0) -> Picture:
    """Symmetries 1, 2 and 4; ``detail`` scales how many texels cover the mesh."""
    mesh, sample = rabbit(), draw("weave", size=192)
    texel = texloom.texel_for_repeats(mesh, 2.2 * detail, sample.shape[1])
    pictures = []
    for order in (1, 2, 4):
        surface = texloom.Surface.build(mesh, texloom.smoothest(mesh, order), texel=texel)
        result = texloom.synthesize(sample, surface, seed=0)
        pictures.append(coat(surface, result.sources, sample, [ABOVE]))
    return beside(*pictures, gap=0)
