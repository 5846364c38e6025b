"""The talk's sweep, and ours.

Left as in the talk: a random copy, swept along the field one point after the other, level by level, with the nearest
window each time. It fits everywhere, and favours what fits most easily. Right blocks of the sample come first, and
all points of one colour choose at once: more of the sample is there, in half the time.

Turk 2001, "Texture Synthesis on Surfaces" (the talk's slides).
"""

import texloom
from examples.pictures import Picture, beside, coat
from texloom.demo import draw, rabbit
from texloom.systems import sweep

METHODS = (sweep.sweeps(), texloom.Sweep())
COATS = ("scales", "pebbles")


def picture(detail: float = 1.0) -> Picture:
    """Two coats by two methods; ``detail`` scales how many texels cover the rabbit."""
    mesh = rabbit()
    field = texloom.smoothest(mesh, 1)
    pictures = []
    for name in COATS:
        sample = draw(name, size=192)
        surface = texloom.Surface.build(mesh, field, texel=texloom.texel_for_repeats(mesh, 2.0 * detail, 192))
        results = [texloom.synthesize(sample, surface, method, seed=0) for method in METHODS]
        pictures += [coat(surface, result.sources, sample) for result in results]
    return beside(*pictures, gap=0)
