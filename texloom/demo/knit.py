"""Stocking stitch in heathered wool."""

import numpy as np

from texloom.demo.noise import fractal, per_id, quarters
from texloom.demo.relief import material, tint
from texloom.exemplar.exemplar import Exemplar

_WIDE = 32.0  # texels from wale to wale
_TALL = 17.0  # texels from course to course
_WOOL = ["22344d", "3a5b7d", "6f93ad", "b9cdd4", "e6ddc8"]


def knit(size: int, seed: int) -> Exemplar:
    """Each stitch is a V of two plump strands of plied yarn."""
    row, column = quarters(size)
    right = column + 1.5 * fractal(row / 50, column / 50, seed + 1, octaves=2)
    down = row + 1.5 * fractal(row / 50, column / 50, seed + 2, octaves=2)
    best = None
    for slot in (-1, 0, 1):
        strand = _strand(right, down, slot, seed + 10)
        best = (
            strand
            if best is None
            else tuple(np.where(strand[0] > best[0], new, old) for new, old in zip(strand, best, strict=True))
        )
    assert best is not None
    height, stitch, along, across = best

    # Plies wind around the strand; loose fibres stand off it
    ply = np.sin(along * 9.0 + across * 2.2)
    fibre = fractal(along * 0.9 + stitch % 97, across * 5.0, seed + 3, octaves=3)
    fuzz = fractal(row / 1.5, column / 1.5, seed + 4, octaves=2)
    height = height + 0.55 * ply + 0.35 * fibre + 0.2 * fuzz
    fleck = np.clip(fractal(along * 1.7 + stitch % 89, across * 3.0, seed + 6, octaves=2) - 0.5, 0, 1)
    shade = 0.34 + 0.12 * ply + 0.13 * fibre + 0.05 * fuzz + 0.8 * fleck + per_id(stitch, seed + 5, low=-0.1, high=0.1)
    valley = 1 - 0.55 * np.abs(across) ** 3
    colour = tint(_WOOL, shade) * (valley * (1 + 0.12 * fuzz))[..., None]
    return material(colour, height, roughness=0.92 + 0.05 * fuzz, strength=0.7)


def _strand(right: np.ndarray, down: np.ndarray, slot: int, seed: int) -> tuple[np.ndarray, ...]:
    """Height, stitch, and place along and across of the strand ``slot`` courses from the texel's own."""
    wale = np.floor(right / _WIDE)
    half = (right / _WIDE - wale - 0.5) * 2  # -1 to 1 across the stitch
    side = np.sign(half) + (half == 0)
    # Strands lean from the foot in the middle to the shoulders outside: a V
    lean = 0.95 * np.abs(half)
    place = down / _TALL + lean
    course = np.floor(place) + slot
    middle = place - course - 0.5
    stitch = (wale * 2 + (side > 0)) * 4099 + course
    across = middle / 0.53
    along = np.abs(half) * 2.0 * side + course
    width = np.clip(1 - across**2, 0, 1)
    ends = np.clip(1 - (np.abs(np.abs(half) - 0.5) / 0.56) ** 2, 0, 1)
    height = np.where(width * ends > 0, 9.0 * np.sqrt(width) * np.sqrt(ends), 0.0)
    height = height + 1.2 * np.abs(half) - 0.8 * middle
    return height, stitch, along, across
