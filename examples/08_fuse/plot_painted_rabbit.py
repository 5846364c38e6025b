"""A painted rabbit.

Colours at the vertices of a mesh are a map too: each stands for one sample (``texloom surface MESH A B --fuse
vertex``). Belts and cuts follow the surface. Left the paint, right the coat of scales, weave and knit from two sides.

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 4.
"""

import numpy as np

import texloom
from examples.pictures import BACK, FRONT, Picture, beside, coat, coloured
from texloom.demo import draw, rabbit
from texloom.fusion.fuse import fuse
from texloom.fusion.labels import from_colours

COLOURS = np.array([(0.8, 0.15, 0.15), (0.15, 0.3, 0.75), (0.25, 0.6, 0.25)])
NAMES = ("scales", "weave", "knit")


def painted(place: np.ndarray) -> np.ndarray:
    """Paint on each point: a shirt of the second colour, the third above."""
    x, y, z = ((place - place.min(0)) / np.ptp(place, axis=0)).T
    waist, collar = 0.22 + 0.02 * np.sin(9 * x), 0.53 - 0.12 * z
    return COLOURS[np.where(y > collar, 2, (y > waist).astype(int))]


def picture(detail: float = 1.0) -> Picture:
    """Paint and coat; ``detail`` scales how many texels cover the mesh."""
    mesh, samples = rabbit(), [draw(name, size=160) for name in NAMES]
    texel = texloom.texel_for_repeats(mesh, 2.6 * detail, samples[0].shape[1])
    surface = texloom.Surface.build(mesh, texloom.smoothest(mesh, 1), texel=texel)
    colours = painted(surface.refined.mesh.vertices)
    fused = fuse(samples, from_colours(colours, len(samples), COLOURS).labels, surface, seed=0)
    paint = coloured(surface, colours**2.2)
    return beside(paint, coat(surface, fused.result.sources, fused.exemplar, views=(FRONT, BACK)), gap=0)
