"""What textons are.

Three samples; the texton of each texel, a colour each: texels of one colour have like surroundings, so the same part of
a scale or a strand has the same colour everywhere; the mean surroundings of each texton, the commonest first.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", section 3.1, figure 2.
"""

import numpy as np
from PIL import Image

from examples.pictures import Picture, below, beside, of_map
from texloom.demo import draw
from texloom.output.textons_picture import texton_colours, texton_tiles
from texloom.search.textons import learn_textons

SIZE = 128  # texels a side of a sample


def picture(detail: float = 1.0) -> Picture:
    """Sample, texton map and textons, a row each; ``detail`` scales the samples' sides."""
    rows, side = [], round(2 * SIZE * detail)
    for name in ("weave", "scales", "pebbles"):
        sample = draw(name, size=round(SIZE * detail))
        textons = learn_textons(sample, count=round(100 * detail))
        large = (each.repeat(2, axis=0).repeat(2, axis=1) for each in (of_map(sample.lead), texton_colours(textons)))
        tiles = Image.fromarray(texton_tiles(textons)).resize((side, side), Image.Resampling.LANCZOS)
        rows.append(beside(*large, np.asarray(tiles)))
    return below(*rows)
