"""A plank of oak cut along the grain."""

import numpy as np

from texloom.demo.noise import fractal, quarters
from texloom.demo.relief import material, tint
from texloom.exemplar.exemplar import Exemplar

_OAK = ["6a4224", "8f5f36", "b07f4d", "c99b66", "dab581"]


def wood(size: int, seed: int) -> Exemplar:
    """Year rings cut at a slant (cathedral grain), pores along the fibres, and fine rays."""
    row, column = quarters(size)
    # Distance from the heart of a slowly bending trunk that the saw leaves at a slant
    bend = 9.0 * fractal(row / 170, column / 60, seed + 1, octaves=2)
    sideways = (column - 0.5 * size + bend) / 24.0
    depth = 2.2 + row / 190 + 0.35 * fractal(row / 120, column / 90, seed + 2, octaves=2)
    radius = np.hypot(sideways, depth) * 2.6 + 0.10 * fractal(row / 90, column / 14, seed + 3, octaves=2)
    year = radius - np.floor(radius)
    late = year**3 * (1 - np.clip((year - 0.92) / 0.08, 0, 1) ** 2)

    fibre = fractal(row / 40, column / 1.8, seed + 4, octaves=4)
    pores = np.clip(fractal(row / 18, column / 0.9, seed + 5, octaves=2) - 0.55 + 0.3 * (1 - year), 0, 1)
    rays = np.clip(fractal(row / 3, column / 2, seed + 6, octaves=2) - 0.75, 0, 1)
    stain = fractal(row / 120, column / 50, seed + 7, octaves=3)
    shade = 0.72 - 0.5 * late + 0.14 * fibre + 0.12 * stain + 0.5 * rays
    colour = tint(_OAK, shade) * (1 - 0.6 * np.clip(pores * 1.8, 0, 1))[..., None]
    height = 1.1 * late + 0.45 * fibre - 4.0 * pores
    return material(colour, height, roughness=0.55 + 0.25 * pores - 0.12 * late + 0.05 * fibre, strength=0.5)
