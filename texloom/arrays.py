"""Array types shared by the whole package."""

from typing import Literal

import numpy as np
from jaxtyping import Float32

Image = Float32[np.ndarray, "row column channel"]
"""Floats: linear light where the map is a colour, the stored values in [0, 1] where it is data."""

MapKind = Literal["colour", "normal", "data"]
"""How a map's values behave: light, unit vectors packed into [0, 1] (OpenGL, green up), or plain numbers."""
