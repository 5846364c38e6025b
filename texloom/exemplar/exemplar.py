"""What to imitate: a stack of aligned maps, with a mask of the texels that may be used."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from texloom.arrays import Image, MapKind


@dataclass(frozen=True, eq=False)
class Map:
    """One map of a stack and how it was stored, so that it can be written back the same way."""

    image: Image
    kind: MapKind
    bits: int  # 8 or 16 (integers), 32 (float)


@dataclass(frozen=True, eq=False)
class Exemplar:
    """Aligned maps of one size, by name ("basecolor", "normal", "roughness", "metallic", "height", "ao", "alpha", ...).

    ``mask`` is True where a texel may be used; None means everywhere. The first map leads where one picture is needed.
    """

    maps: Mapping[str, Map]
    mask: Bool[np.ndarray, "row column"] | None = None
