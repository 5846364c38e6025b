"""Two samples as one.

Photographs of the same stuff, taken in two places: together they hold more of it than either, and the texture takes
from both. Left the samples, middle the texture, right which sample each texel comes from (``texloom image A B -o C``).
"""

import numpy as np

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.demo import draw
from texloom.exemplar.join import join

_SIDE = 128  # of the samples
TINTS = np.array([(200, 120, 90), (90, 130, 180)], np.uint8)


def picture(detail: float = 1.0) -> Picture:
    """Samples, texture and origins; ``detail`` scales the sides of the latter."""
    rows, columns = round(352 * detail), round(416 * detail)
    samples = [draw("scales", size=_SIDE, seed=seed) for seed in (0, 5)]
    joined = join(samples)
    result = texloom.synthesize(joined.exemplar, texloom.Grid(rows, columns), seed=2)
    texture = shown(result.sources, joined.exemplar, (rows, columns))
    second = joined.parts[1]
    place = result.sources.position[:, 0]
    inside = (place >= (second.row, second.column)).all(1)
    tint = TINTS[inside.astype(int)].reshape(rows, columns, 3)
    origins = (texture.mean(2, keepdims=True) * 0.5 + tint * 0.5).astype(np.uint8)
    return beside(below(*(of_map(sample.lead) for sample in samples)), texture, origins)
