"""A wall of fired bricks in running bond."""

import numpy as np

from texloom.demo.noise import fractal, per_id, quarters
from texloom.demo.relief import material, tint
from texloom.exemplar.exemplar import Exemplar

_COURSE = 32.0  # texels from course to course
_LENGTH = 68.0  # texels from brick to brick
_JOINT = 4.0  # texels of mortar between bricks
_CLAY = ["4a2a22", "7c3b2b", "94472f", "a8563a", "b9724e", "8b5a48"]
_MORTAR = ["8d867b", "b3ab9d", "cfc7b8"]


def bricks(size: int, seed: int) -> Exemplar:
    """Worn edges, a colour of its own for each brick, pits, and sandy mortar."""
    row, column = quarters(size)
    warp = 1.6 * fractal(row / 22, column / 22, seed + 1)
    course = np.floor((row + 0.7 * warp) / _COURSE)
    along = (column + warp) / _LENGTH + 0.5 * (course % 2) + per_id(course, seed + 2, high=0.06)
    brick = course * 1009 + np.floor(along)

    # Distance inwards from the rounded rectangle of the brick, its edges chipped
    half = np.array([_COURSE, _LENGTH]) / 2 - _JOINT / 2
    inset_row = np.abs((row + 0.7 * warp) - (course + 0.5) * _COURSE) - half[0] + per_id(brick, seed + 3, high=1.2)
    inset_column = np.abs((along - np.floor(along) - 0.5) * _LENGTH) - half[1] + per_id(brick, seed + 4, high=1.6)
    radius = 4.0
    outside = np.hypot(np.maximum(inset_row + radius, 0), np.maximum(inset_column + radius, 0)) - radius
    chipped = fractal(row / 9, column / 9, seed + 5, octaves=3)
    inside = -np.maximum(outside, np.maximum(inset_row, inset_column)) - np.maximum(chipped - 0.35, 0) * 5

    grain = fractal(row / 3, column / 3, seed + 6, octaves=3)
    rough = fractal(row / 14, column / 14, seed + 7)
    pits = np.maximum(fractal(row / 4.5, column / 4.5, seed + 8, octaves=2) - 0.55, 0)
    edge = np.clip(inside / 3.0, 0, 1)
    body = 1 - (1 - edge) ** 2
    height = body * (4.5 + per_id(brick, seed + 9, low=-0.8, high=0.8) + 0.35 * rough + 0.22 * grain - 2.5 * pits)
    height += (1 - body) * (0.5 * rough + 0.45 * grain)

    fired = per_id(brick, seed + 10)
    shade = fired + 0.16 * rough + 0.07 * grain - 0.5 * pits
    clay = tint(_CLAY, shade) * (1 + 0.16 * rough + 0.10 * grain)[..., None]
    lime = np.clip(fractal(row / 30, column / 40, seed + 11) - 0.35, 0, 0.5)[..., None]
    clay = clay * (1 - lime) + lime * np.array([0.55, 0.5, 0.45])
    mortar = tint(_MORTAR, 0.5 + 0.35 * rough + 0.3 * grain)
    cover = np.clip(inside / 1.2, 0, 1)[..., None]
    colour = mortar * (1 - cover) + clay * cover
    return material(colour, height, roughness=0.82 + 0.08 * grain - 0.1 * body * (1 - fired), strength=0.55)
