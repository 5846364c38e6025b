"""What a method may ask of the place where texture grows; it never asks which place it is."""

from typing import NamedTuple, Protocol

import numpy as np
from jaxtyping import Float32, Int, Int32

from texloom.domain.neighbourhoods import Neighbourhoods
from texloom.domain.patches import Patches


class Lattice(NamedTuple):
    """Sites in whole rows, frames along them: site ``row * columns + column``. ``wrap`` joins opposite borders."""

    rows: int
    columns: int
    wrap: bool

    def site_at(self, row: Int[np.ndarray, "*at"], column: Int[np.ndarray, "*at"]) -> Int[np.ndarray, "*at"]:
        """The sites at any rows and columns: around the border of a torus, -1 outside a plane."""
        if self.wrap:
            return row % self.rows * self.columns + column % self.columns
        inside = (row >= 0) & (row < self.rows) & (column >= 0) & (column < self.columns)
        return np.where(inside, row * self.columns + column, -1)


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

    @property
    def lattice(self) -> Lattice | None:
        """The rows and columns that all sites lie in, one texel apart; None where they do not."""
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
