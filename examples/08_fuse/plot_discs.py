"""More and more of the second.

A map generated from discs: at the top nearly all of the first sample, farther down more and more of the second, with
probability 1 - exp(-x² / 2σ²). Left the two samples, then the map, then the fusion (``texloom fuse discs A B``).

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 5, figure 11.
"""

import numpy as np

from examples.pictures import Picture, below, beside, of_map, shown
from texloom import Exemplar, Grid
from texloom.demo import draw
from texloom.exemplar.exemplar import to_map
from texloom.exemplar.scale import dominant_scale
from texloom.fusion.fuse import fuse
from texloom.fusion.labels import discs, fading

COLOURS = np.array([(200, 40, 40), (40, 70, 190)], np.uint8)


def beans(seed: int, skin: tuple[float, float, float]) -> Exemplar:
    """Pebbles of one colour in a dark bowl."""
    pebbles = draw("pebbles", size=192, seed=seed)
    colour, height = (pebbles.maps[name].image for name in ("basecolor", "height"))
    bean = np.clip(4 * height - 0.6, 0, 1)
    bright = (0.2 + 0.8 * height) * (0.6 + 0.6 * np.sqrt(colour.mean(2, keepdims=True)))
    shown = bean * bright * np.array(skin) + (1 - bean) * 0.3 * colour
    return Exemplar({"basecolor": to_map(shown.astype(np.float32), "colour")})


def picture(detail: float = 1.0) -> Picture:
    """Samples, map and fusion; ``detail`` scales the sides of the latter."""
    rows, columns = round(440 * detail), round(360 * detail)
    samples = [beans(3, (0.36, 0.04, 0.1)), beans(5, (0.95, 0.55, 0.12))]
    one, two = (dominant_scale(sample).scale for sample in samples)
    labels = discs(fading(rows, columns), (one, two), seed=1)
    fused = fuse(samples, labels.ravel(), Grid(rows, columns), seed=1)
    grown = shown(fused.result.sources, fused.exemplar, (rows, columns))
    return beside(below(*(of_map(sample.lead) for sample in samples)), COLOURS[labels], grown)
