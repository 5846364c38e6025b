"""A basket woven of flat reeds, one over and one under."""

import numpy as np

from texloom.demo.noise import fractal, per_id, quarters
from texloom.demo.relief import material, tint
from texloom.exemplar.exemplar import Exemplar

_PITCH = 32.0  # texels from reed to reed
_REED = ["5d3c1e", "8a6131", "b08545", "c9a462", "dcc089"]


def weave(size: int, seed: int) -> Exemplar:
    """Two families of reeds; the upper one at each texel is seen."""
    row, column = quarters(size)
    warp_row = 1.3 * fractal(row / 40, column / 40, seed + 1, octaves=2)
    warp_column = 1.3 * fractal(row / 40, column / 40, seed + 2, octaves=2)
    down, right = row + warp_row, column + warp_column
    flat = _reeds(across=down, along=right, seed=seed + 10)
    upright = _reeds(across=right, along=down, seed=seed + 20, phase=1)
    over = flat[0] >= upright[0]
    height, identity, fibre, edge = (np.where(over, a, b) for a, b in zip(flat, upright, strict=True))

    stain = fractal(row / 50, column / 50, seed + 3)
    fine = fractal(row / 1.6, column / 1.6, seed + 4, octaves=2)
    shade = per_id(identity, seed + 5, low=0.3, high=0.85) + 0.2 * fibre + 0.08 * stain + 0.05 * fine
    colour = tint(_REED, shade) * (1 + 0.18 * fibre + 0.06 * fine)[..., None] * (0.45 + 0.55 * edge)[..., None]
    return material(colour, height, roughness=0.58 - 0.10 * fibre + 0.15 * (1 - edge), strength=0.75)


def _reeds(*, across: np.ndarray, along: np.ndarray, seed: int, phase: int = 0) -> tuple[np.ndarray, ...]:
    """Height, identity, fibres and cover of reeds lying side by side ``across`` and rising and falling ``along``."""
    reed = np.floor(across / _PITCH)
    half = per_id(reed, seed, low=0.43, high=0.485)
    sideways = (across / _PITCH - reed - 0.5) / half
    rise = np.cos(np.pi * (along / _PITCH - 0.5 + reed + phase))
    crown = np.sqrt(np.clip(1 - np.abs(sideways) ** 3, 0, 1))
    wobble = 1.2 * fractal(along / 60 + reed * 3.7, across / 60, seed + 1, octaves=2)
    fibre = fractal((across + wobble) / 2.6, along / 45 + per_id(reed, seed + 2, high=50.0), seed + 3, octaves=3)
    height = 3.6 * rise + 4.0 * crown + 0.32 * fibre
    height = np.where(np.abs(sideways) < 1, height, -6.0)
    return height, reed * 2 + phase + 50_000 * np.floor(along / (9 * _PITCH)), fibre, np.clip(crown * 1.5, 0, 1)
