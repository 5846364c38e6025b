"""Three textures and a drawn map.

Areas may touch in any way, three at a point included; belts follow their borders. Left the
map; then the fusion, whose maps all come out aligned: colours, and normals.

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", sections 4 and 5.
"""

import numpy as np

from examples.pictures import Picture, beside, of_map, shown
from texloom import Grid, gather_images
from texloom.demo import draw
from texloom.fusion.fuse import fuse
from texloom.fusion.labels import from_picture

COLOURS = np.array([(200, 40, 40), (40, 70, 190), (60, 150, 60)], np.uint8)
NAMES = ("pebbles", "wood", "scales")


def island(side: int) -> Picture:
    """A disc on two halves."""
    row, column = np.indices((side, side)) / side - 0.5
    halves = (row + 0.4 * column + 0.06 * np.sin(9 * column) > 0.02).astype(int)
    inside = np.hypot(row + 0.02, column - 0.05) < 0.27 + 0.03 * np.sin(3 * np.arctan2(row, column))
    return COLOURS[np.where(inside, 2, halves)]


def picture(detail: float = 1.0) -> Picture:
    """Map, colours, normals; ``detail`` scales their sides."""
    side = round(384 * detail)
    samples, painted = [draw(name, size=256) for name in NAMES], island(side)
    labels = from_picture(painted / 255.0, len(samples)).labels.ravel()
    fused = fuse(samples, labels, Grid(side, side), seed=1)
    normal = gather_images(fused.result.sources, fused.exemplar, rows=side, columns=side)["normal"]
    return beside(painted, shown(fused.result.sources, fused.exemplar, (side, side)), of_map(normal))
