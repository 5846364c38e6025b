"""Edges blended.

Close to a coarse mesh, each face quilted alone. Left as every viewer shows it; right with the neighbours' maps faded in
over the edges that show, baked on an atlas. ``examples/10_texton/shader`` does the same while it draws.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", section 3.3, figures 5 and 6.
"""

from examples.pictures import FRONT, Picture, beside
from examples.quilts import blended, quilt, worn
from texloom.demo import draw, rabbit
from texloom.search.textons import learn_textons

CLOSE = slice(560, 1080), slice(560, 1080)  # rows and columns of a picture 1600 pixels a side


def picture(detail: float = 1.0) -> Picture:
    """A part of a rabbit, edges as they are and blended; ``detail`` scales how close it is."""
    textons = learn_textons(draw("weave", size=192))
    quilted = quilt(rabbit(step=0.09), textons, repeats=2.5, width=None)
    side = round(1600 * detail)
    rows, columns = (slice(round(part.start * detail), round(part.stop * detail)) for part in CLOSE)
    plain = worn(quilted, textons.exemplar, [FRONT], side)
    return beside(plain[rows, columns], blended(quilted, textons, [FRONT], side)[rows, columns])
