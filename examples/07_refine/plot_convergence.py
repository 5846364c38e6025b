"""How refinement settles.

Mean square error to the pass before, and pixels that changed, pass by pass, for the paper's scan-line order and for the
parallel order; right the sample and the results. Every result has such ``curves``; ``--json`` gives them too.

Shin & Shin 2004, "On pixel-based texture synthesis by non-parametric sampling", section 5, figure 7.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from PIL import Image, ImageDraw

import texloom
from examples.pictures import Picture, below, beside, of_map, shown
from texloom.demo import draw
from texloom.synthesis.refine import Refine

PASSES = 16
METHODS = {order: Refine(order=order, passes=PASSES, threshold=0) for order in ("scan-line", "parallel")}
COLOURS = {"scan-line": (200, 70, 40), "parallel": (60, 110, 170)}
_WIDE, _TALL, _LEFT, _TOP, _LOW, _GREY = 560, 240, 64, 26, 212, (110, 110, 110)


def plot(title: str, curves: Mapping[str, Sequence[float]]) -> Picture:
    """A line for each name, on an axis from 0."""
    picture = Image.new("RGB", (_WIDE, _TALL), "white")
    pen, most = ImageDraw.Draw(picture), max(map(max, curves.values()))
    pen.text((_LEFT, 6), title, fill="black")
    pen.text((_LEFT, _LOW + 8), f"passes after the first, up to {PASSES}", fill=_GREY)
    for value in (0.0, most / 2, most):
        y = _LOW - value / most * (_LOW - _TOP)
        pen.line((_LEFT, y, _WIDE - 10, y), fill=(220, 220, 220))
        pen.text((_LEFT - 8, y), f"{value:.2g}" if most < 10 else f"{value:.0f}", fill=_GREY, anchor="rm")
    for x, (name, values) in zip((400, 480), curves.items(), strict=True):
        across = _LEFT + np.arange(len(values)) * (_WIDE - _LEFT - 10) / (PASSES - 1)
        up = _LOW - np.array(values) / most * (_LOW - _TOP)
        pen.line(list(zip(across.tolist(), up.tolist(), strict=True)), fill=COLOURS[name], width=3)
        pen.text((x, 6), name, fill=COLOURS[name])
    return np.asarray(picture)


def picture(detail: float = 1.0) -> Picture:
    """Two curves and the textures they belong to; ``detail`` scales the textures' sides."""
    side, sample = round(160 * detail), draw("bricks", size=128)
    grid = texloom.Grid(side, side, wrap=True)
    results = {name: texloom.synthesize(sample, grid, method, seed=1) for name, method in METHODS.items()}
    plots = [plot(what, {n: r.curves[what] for n, r in results.items()}) for what in ("MSE", "changed pixels")]
    grown = (shown(result.sources, sample, (side, side)) for result in results.values())
    return beside(below(*plots), below(of_map(sample.lead), *grown))
