"""An image as a place to grow texture: a plane or a torus of texels, one site each."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int32

from texloom import draws
from texloom.domain.cover import group_by_site
from texloom.domain.patches import Patches
from texloom.errors import ParameterError

_PHASE = 0x6C61  # purpose of the draw that shifts a torus's lattice


@dataclass(frozen=True)
class Grid:
    """``rows × columns`` sites, one texel apart; site ``row * columns + column``. ``wrap`` joins opposite borders.

    All frames are the image's own. A patch of width w around a centre c covers ``c - w // 2 ... c - w // 2 + w - 1``.
    """

    rows: int
    columns: int
    wrap: bool = False

    def __post_init__(self) -> None:
        if self.rows < 1 or self.columns < 1:
            raise ParameterError(f"a grid of {self.rows} × {self.columns} texels has no site: use 1 × 1 or more")

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.rows, self.columns

    @property
    def count(self) -> int:
        """Number of sites."""
        return self.rows * self.columns

    @property
    def area(self) -> Float32[np.ndarray, "site"]:
        """One texel each."""
        return np.ones(self.count, np.float32)

    @property
    def edges(self) -> Int32[np.ndarray, "edge 2"]:
        """Each site with the one to its right, then each with the one below."""
        site = np.arange(self.count, dtype=np.int32).reshape(self.shape)
        pairs = [(site, np.roll(site, -1, axis)) for axis in (1, 0)]
        if not self.wrap:
            pairs = [(site[:, :-1], site[:, 1:]), (site[:-1], site[1:])]
        return np.concatenate([np.stack([a.ravel(), b.ravel()], 1) for a, b in pairs])

    def centres(self, pitch: float, seed: int) -> Int32[np.ndarray, "patch"]:
        """An even lattice, in scan-line order, at most ``pitch`` texels apart (less, so that the size divides).

        A torus's lattice starts anywhere, by ``seed``; a plane's begins and ends half a pitch inside the border.
        """
        phase = draws.uniform(seed, _PHASE, index=np.arange(2)) if self.wrap else np.full(2, 0.5)
        row, column = (_spread(size, pitch, at) for size, at in zip(self.shape, phase, strict=True))
        return (row[:, None] * self.columns + column).ravel().astype(np.int32)

    def patches(self, centres: Int32[np.ndarray, "patch"], width: int) -> Patches:
        """Squares of sites around ``centres``; samples outside a plane are -1.

        On a torus smaller than ``width`` samples repeat; the cover keeps each site once, nearest the centre.
        """
        row, row_once = self._steps(centres // self.columns, width, self.rows)
        column, column_once = self._steps(centres % self.columns, width, self.columns)
        sites = row[:, :, None] * np.int32(self.columns) + column[:, None, :]
        if not self.wrap:
            sites[(row < 0)[:, :, None] | (column < 0)[:, None, :]] = -1
        kept = sites if row_once.all() and column_once.all() else np.where(row_once[:, None] & column_once, sites, -1)
        start, entry = group_by_site(kept.reshape(-1), self.count)
        patch, sample = np.divmod(entry, np.int32(width * width))
        return Patches(
            width=width,
            centres=centres,
            sites=sites.reshape(len(centres), width * width, 1),
            weights=None,
            cover_start=start,
            cover_patch=patch,
            cover_position=np.stack(np.divmod(sample, np.int32(width)), axis=1, dtype=np.float32, casting="unsafe"),
        )

    def _steps(
        self, centre: Int32[np.ndarray, "patch"], width: int, size: int
    ) -> tuple[Int32[np.ndarray, "patch width"], np.ndarray]:
        """Rows (or columns) of each patch, -1 outside, and which of them show a row for the first time."""
        offset = np.arange(width, dtype=np.int32) - width // 2
        steps = centre[:, None] + offset
        if self.wrap:
            return steps % np.int32(size), (offset >= -(size // 2)) & (offset < size - size // 2)
        return np.where((steps >= 0) & (steps < size), steps, -1), np.ones(width, bool)


def _spread(size: int, pitch: float, phase: float) -> Int32[np.ndarray, "step"]:
    """Even steps over ``0 .. size - 1``, no farther apart than ``pitch`` (rounding aside)."""
    steps = max(1, int(np.ceil(size / pitch)))
    return (np.floor((np.arange(steps) + phase) * (size / steps)).astype(np.int64) % size).astype(np.int32)
