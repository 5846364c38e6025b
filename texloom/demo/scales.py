"""Dragon scales: rows of overlapping horn plates, green shading into gold at the tips."""

import numpy as np

from texloom.demo.noise import fractal, per_id, quarters
from texloom.demo.relief import material, tint
from texloom.exemplar.exemplar import Exemplar

_WIDE = 36.0  # texels from scale to scale in a row
_ROW = 21.0  # texels from row to row
_LONG = 40.0  # texels from the root of a scale to its tip
_HORN = ["0d2b2a", "14534a", "1f7a5e", "58a06a", "b9b25f", "e0c56e"]


def scales(size: int, seed: int) -> Exemplar:
    """Tips point down the picture; each row lies over the roots of the row below it."""
    row, column = quarters(size)
    right = column + 1.4 * fractal(row / 45, column / 45, seed + 1, octaves=2)
    down = row + 1.8 * fractal(row / 45, column / 45, seed + 2, octaves=2)
    rows = [_scale(right, down, np.floor(down / _ROW) - above, seed + 10) for above in (0, 1, 2)]
    top = rows[0]
    for shape in rows[1:]:
        top = tuple(np.where(shape[4] > 0, upper, lower) for upper, lower in zip(shape, top, strict=True))
    height, identity, tip, side, rim = top

    grain = fractal(row / 2.0, column / 2.0, seed + 3, octaves=2)
    patch = fractal(row / 60, column / 60, seed + 4, octaves=2)
    growth = np.sin(26.0 * tip + 3.0 * side**2 + 1.5 * patch) * np.clip(1 - np.abs(side), 0, 1)
    height = height + 0.16 * growth + 0.12 * grain
    shade = 0.10 + 0.62 * tip**1.6 + per_id(identity, seed + 5, low=-0.08, high=0.12) + 0.10 * patch + 0.03 * growth
    shade += 0.25 * np.exp(-((rim / 2.2) ** 2))
    value = per_id(identity, seed + 6, low=0.8, high=1.2) * (1 + 0.09 * grain + 0.10 * growth)
    colour = tint(_HORN, shade) * value[..., None]
    return material(
        colour,
        height,
        roughness=0.34 + 0.2 * (1 - tip) + 0.06 * grain,
        metallic=np.clip(0.25 + 0.5 * tip, 0, 1),
        strength=0.75,
    )


def _scale(right: np.ndarray, down: np.ndarray, line: np.ndarray, seed: int) -> tuple[np.ndarray, ...]:
    """Height, identity, way to the tip (0 to 1), sideways place (-1 to 1) and distance inside the rim of one row."""
    slot = right / _WIDE + 0.5 * (line % 2)
    identity = line * 1009 + np.floor(slot)
    side = (slot - np.floor(slot) - 0.5) * 2
    side = side + per_id(identity, seed, low=-0.06, high=0.06)
    tip = (down - line * _ROW + per_id(identity, seed + 1, low=-1.5, high=1.5)) / _LONG
    outline = 1 - 0.55 * np.abs(side) ** 2.2
    rim = (outline - tip) * _LONG * 0.8
    rim = np.minimum(rim, (1.04 - np.abs(side)) * _WIDE * 0.8)
    keel = 1.4 * np.exp(-((side / 0.16) ** 2)) * np.clip(tip * 1.4, 0, 1)
    round_edge = 2.6 * (1 - np.clip(rim / 3.5, 0, 1)) ** 2
    height = 9.5 * tip + 3.0 * (1 - side**2) + keel - round_edge
    return height, identity, np.clip(tip, 0, 1), side, rim
