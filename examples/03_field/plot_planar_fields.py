"""Textures along planar vector fields.

Patches are traced along the field and its orthogonal, so they bend with it instead of being cut straight: uniform at 30
degrees, radial, sine and ring, as in figure 8 of the paper.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", section 3.2 and fig. 8.
"""

import numpy as np

import texloom
from examples.pictures import Picture, below, beside, shown
from texloom.demo import draw
from texloom.field.planar import radial, ring, sine, uniform

SAMPLES = ("bricks", "weave")


def picture(detail: float = 1.0) -> Picture:
    """Two samples along four fields; ``detail`` scales the sides."""
    side = round(336 * detail)
    fields = (
        uniform(side, side, np.radians(30)),
        radial(side, side),
        sine(side, side, waves=1.5, height=0.05),
        ring(side, side),
    )
    rows = []
    for name in SAMPLES:
        sample = draw(name, size=160)
        grids = [texloom.Grid(side, side, field=field.direction) for field in fields]
        results = [texloom.synthesize(sample, grid, seed=4) for grid in grids]
        rows.append(beside(*(shown(result.sources, sample, (side, side)) for result in results)))
    return below(*rows)
