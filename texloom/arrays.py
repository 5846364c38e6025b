"""Array types shared by the whole package."""

from typing import Literal

import numpy as np
from jaxtyping import Float32

Image = Float32[np.ndarray, "row column channel"]
"""Floats: linear light where the map is a colour, the stored values in [0, 1] where it is data."""

MapKind = Literal["colour", "normal", "data"]
"""How a map's values behave: light, unit vectors packed into [0, 1] (OpenGL, green up), or plain numbers."""


def fours(values: Float32[np.ndarray, "*shape channel"]) -> Float32[np.ndarray, "*shape group 4"]:
    """A view of the same values, four channels a vector, as kernels take them."""
    return values.reshape(*values.shape[:-1], values.shape[-1] // 4, 4)


def in_fours(image: Image) -> Image:
    """The image with channels of zeros added up to a multiple of four, so that kernels compare four at once."""
    return np.ascontiguousarray(np.pad(image, ((0, 0), (0, 0), (0, -image.shape[2] % 4))))
