"""From a height field to a whole material: normals, occlusion, light, and the stack of maps.

Heights are in texels, so that slopes are true angles. Colours are linear light.
"""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter, shift

from texloom.exemplar.exemplar import Exemplar, Map

Plane = Float[np.ndarray, "row column"]
Colour = Float[np.ndarray, "row column 3"]

_SUN = (-0.55, -0.6)  # where the light comes from, [row, column]: above left
_SUN_SLOPE = 1.0  # its height over the horizon, as a tangent


def normals(height: Plane) -> Colour:
    """Unit normals of a height field, x along columns, y up the picture (against rows), z out of it."""
    down, right = np.gradient(height)
    normal = np.stack([-right, down, np.ones_like(height)], -1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def horizon(height: Plane, direction: tuple[float, float], *, reach: int) -> Plane:
    """Tangent of the steepest rise seen from each texel in a direction [row, column], at most ``reach`` texels away."""
    row, column = np.asarray(direction) / np.hypot(*direction)
    steepest = np.zeros_like(height)
    for distance in np.unique(np.geomspace(1, reach, 9).round()):
        there = shift(height, (-row * distance, -column * distance), order=1, mode="nearest")
        steepest = np.maximum(steepest, (there - height) / distance)
    return steepest


def occlusion(height: Plane, *, reach: int = 16) -> Plane:
    """Part of the sky each texel sees, 1 on a plane: cosine-weighted mean over twelve horizons (Max 1988)."""
    angles = np.arange(12) * (np.pi / 6)
    tangents = np.stack([horizon(height, (np.sin(a), np.cos(a)), reach=reach) for a in angles])
    return (1.0 / (1.0 + tangents**2)).mean(0)


def light(height: Plane, ao: Plane, *, strength: float) -> Plane:
    """What a soft sun from above left and the sky leave on the relief, 1 on a lit plane; ``strength`` 0 is none."""
    sun = np.array([_SUN[1], -_SUN[0], _SUN_SLOPE])
    facing = np.clip(normals(height) @ sun, 0.0, None) / _SUN_SLOPE
    over = horizon(height, _SUN, reach=14) - _SUN_SLOPE
    shade = 1.0 - gaussian_filter(np.clip(over * 2.0, 0.0, 1.0), 0.7)
    return (1 - strength) + strength * (0.35 * ao + 0.65 * facing * shade)


def material(
    colour: Colour,
    height: Plane,
    *,
    roughness: Plane,
    metallic: Plane | None = None,
    strength: float = 0.6,
) -> Exemplar:
    """The full stack from an unlit colour and a relief, both drawn on quarters of texels.

    The base colour keeps ``strength`` of the light, as photographs do.
    """
    colour, height, roughness = mean_of_quarters(colour), mean_of_quarters(height), mean_of_quarters(roughness)
    metallic = np.zeros_like(height) if metallic is None else mean_of_quarters(metallic)
    ao = occlusion(height)
    lit = colour * (light(height, ao, strength=strength) * ao**0.8)[..., None]
    span = max(np.ptp(height), 1e-6)
    planes = {
        "roughness": (roughness, 8),
        "metallic": (metallic, 8),
        "height": ((height - height.min()) / span, 16),
        "ao": (ao, 8),
    }
    maps = {
        "basecolor": Map(_stored(lit), "colour", 8),
        "normal": Map(_stored(normals(height) * 0.5 + 0.5), "normal", 8),
    }
    maps |= {name: Map(_stored(plane[..., None]), "data", bits) for name, (plane, bits) in planes.items()}
    return Exemplar(maps)


def mean_of_quarters(fine: np.ndarray) -> np.ndarray:
    """A texel's value from its four quarters: edges come out smooth."""
    return (fine[0::2, 0::2] + fine[1::2, 0::2] + fine[0::2, 1::2] + fine[1::2, 1::2]) / 4


def _stored(values: np.ndarray) -> np.ndarray:
    """Values as a map keeps them: float32 in [0, 1]."""
    return np.ascontiguousarray(np.clip(values, 0.0, 1.0), np.float32)


def tint(palette: list[str], amount: Plane) -> Colour:
    """Colours along a palette of ``rrggbb`` stops, ``amount`` in [0, 1] from the first to the last, in linear light."""
    stops = np.array([[int(code[i : i + 2], 16) / 255 for i in (0, 2, 4)] for code in palette])
    linear = np.where(stops <= 0.04045, stops / 12.92, ((stops + 0.055) / 1.055) ** 2.4)
    at = np.linspace(0, 1, len(stops))
    return np.stack([np.interp(np.clip(amount, 0, 1), at, linear[:, c]) for c in range(3)], -1)
