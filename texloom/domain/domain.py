"""What a method may ask of the place where texture grows; it never asks which place it is."""

from typing import Protocol

import numpy as np
from jaxtyping import Float32, Int32

from texloom.domain.neighbourhoods import Neighbourhoods
from texloom.domain.patches import Patches


class Domain(Protocol):
    """Sites one texel apart, each with a frame, and square patches laid on them along that frame."""

    @property
    def count(self) -> int:
        """Number of sites."""
        ...

    @property
    def area(self) -> Float32[np.ndarray, "site"]:
        """Area each site stands for, in exemplar texels."""
        ...

    @property
    def edges(self) -> Int32[np.ndarray, "edge 2"]:
        """Pairs of neighbouring sites."""
        ...

    def centres(self, pitch: float, seed: int) -> Int32[np.ndarray, "patch"]:
        """Sites spread evenly, about ``pitch`` texels apart, so that patches a little wider than that cover all."""
        ...

    def patches(self, centres: Int32[np.ndarray, "patch"], width: int) -> Patches:
        """Patches of ``width × width`` samples around the given sites; built once, kept by the caller."""
        ...

    def neighbourhoods(self, sites: Int32[np.ndarray, "n"], reach: int) -> Neighbourhoods:
        """The sites at most ``reach`` texels (rows and columns) from each given one."""
        ...
