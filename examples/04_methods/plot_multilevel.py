"""Texture optimization as published, on one level and on six stages.

Left the sample; middle 32 × 32 patches on the finest level only; right three resolutions and three sizes of patch,
coarse to fine, as in figure 5 of the paper. A single level stops at the first arrangement that is consistent nearby.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", section 4.4 and fig. 5.
"""

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.demo import draw
from texloom.synthesis.least_squares import Stage, stages

SCHEDULES = ((Stage(1, 32),), stages(32))


def picture(detail: float = 1.0) -> Picture:
    """A row for each sample; ``detail`` scales the results' sides."""
    side = round(384 * detail)
    rows = []
    for name in ("scales", "pebbles"):
        sample = draw(name, size=128)
        methods = [texloom.LeastSquares(schedule=schedule) for schedule in SCHEDULES]
        results = [texloom.synthesize(sample, texloom.Grid(side, side), method, seed=1) for method in methods]
        rows.append(beside(of_map(sample.lead), *(shown(result.sources, sample, (side, side)) for result in results)))
    return below(*rows)
