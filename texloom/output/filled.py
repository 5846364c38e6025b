"""The maps of a filled picture."""

from dataclasses import replace

import numpy as np

from texloom.exemplar.exemplar import Map
from texloom.output.gather import gather_sites
from texloom.sources import SourceMap
from texloom.synthesis.fill import Filled


def filled_maps(filled: Filled) -> dict[str, Map]:
    """All maps of the picture, stored as they were; outside the hole with the very values that they had.

    Grey that was filled from a sample in colour has become colour.
    """
    hole, sources = filled.hole, filled.result.sources
    inside = SourceMap(sources.position[hole.ravel()], sources.weight[hole.ravel()])
    maps = {}
    for name, m in filled.picture.maps.items():
        values = gather_sites(inside, filled.exemplar.maps[name])
        image = np.repeat(m.image, values.shape[1] // m.image.shape[2], axis=2)
        image[hole] = values
        maps[name] = replace(m, image=image)
    return maps
