"""River pebbles pressed into dark sand."""

import numpy as np

from texloom.demo.noise import cells, fractal, per_id, quarters
from texloom.demo.relief import material, tint
from texloom.exemplar.exemplar import Exemplar

_STONE = ["3d4145", "6b6f70", "8f8a80", "b5aa98", "d8d0c0", "a58468", "7a5a48", "59504c"]
_SAND = ["2a241e", "4a4036", "6b5d4d"]
_PITCH = 28.0  # texels from pebble to pebble


def pebbles(size: int, seed: int) -> Exemplar:
    """Smooth domes of many colours, some veined or speckled."""
    row, column = quarters(size)
    bend = 3.0 * fractal(row / 30, column / 30, seed + 1, octaves=2), 3.0 * fractal(row / 30, column / 30, seed + 2)
    stone, border, offset = cells(row + bend[0], column + bend[1], pitch=_PITCH, rounding=2.6, seed=seed + 3, relax=2)

    # A dome whose rim follows the cell, flatter on top
    gap = per_id(stone, seed + 4, low=-0.2, high=1.6)
    rim = np.clip((border - gap) / per_id(stone, seed + 5, low=7.5, high=12.0), 0, 1)
    dome = np.sqrt(1 - (1 - rim) ** 2)
    tall = per_id(stone, seed + 6, low=6.5, high=10.0)
    tilt = (offset[..., 0] * per_id(stone, seed + 7, low=-0.08, high=0.08)) + offset[..., 1] * per_id(
        stone, seed + 8, low=-0.08, high=0.08
    )
    sand = fractal(row / 2.2, column / 2.2, seed + 9, octaves=3)
    height = np.where(rim > 0, dome * (tall + tilt), 0.9 * sand - 0.8)

    # Each stone has its own colour, and its own mix of clouds, speckles and veins
    clouds = fractal(row / 13, column / 13, seed + 10)
    speckle = fractal(row / 1.7, column / 1.7, seed + 11, octaves=2)
    angle = per_id(stone, seed + 12, high=np.pi)
    across = offset[..., 0] * np.cos(angle) + offset[..., 1] * np.sin(angle) + 2.5 * clouds
    veins = np.exp(-((across - per_id(stone, seed + 13, low=-6, high=6)) ** 2) / 1.5)
    veined = (per_id(stone, seed + 14) > 0.72) * 0.55 * veins
    tone = per_id(stone, seed + 15) + 0.05 * clouds
    value = per_id(stone, seed + 16, low=0.75, high=1.25) * (1 + 0.14 * clouds)
    value += speckle * per_id(stone, seed + 17, low=0.02, high=0.16)
    rock = tint(_STONE, tone) * value[..., None]
    rock = rock * (1 - veined[..., None]) + veined[..., None] * np.array([0.72, 0.7, 0.65])
    colour = np.where((rim > 0)[..., None], rock, tint(_SAND, 0.5 + 0.5 * sand))
    roughness = np.where(rim > 0, per_id(stone, seed + 18, low=0.35, high=0.6) + 0.06 * speckle, 0.95)
    return material(colour, height, roughness=roughness, strength=0.7)
