"""All maps of a material at once.

The result of a synthesis is not colours but sources: which texel of the sample each site shows. So base colour, normal,
roughness, height and ambient occlusion come out of one run, aligned to the texel, for the price of a gather each.
"""

import texloom
from examples.pictures import Picture, beside, of_map
from texloom.demo import draw

MAPS = ("basecolor", "normal", "roughness", "height", "ao")


def picture(detail: float = 1.0) -> Picture:
    """Five maps of one result; ``detail`` scales its sides."""
    rows, columns = round(400 * detail), round(300 * detail)
    sample = draw("scales", size=224)
    result = texloom.synthesize(sample, texloom.Grid(rows, columns), seed=2)
    maps = texloom.gather_images(result.sources, sample, rows=rows, columns=columns)
    return beside(*(of_map(maps[name]) for name in MAPS))
