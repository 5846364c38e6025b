"""What a bank sees around every texel, in a few numbers and at any turn, a few rows at a time.

Kernels and principal axes are both linear, so they are multiplied first: what is left is one correlation a component.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32

from texloom import draws
from texloom.arrays import Image
from texloom.exemplar.appearance import fill_masked
from texloom.exemplar.blas import over_blocks, single_threaded
from texloom.exemplar.pca import Projection, fit
from texloom.search.texton_banks import Bank

ROWS = 8
"""Rows of texels worth describing at once."""

_COMPONENTS = 32
_FITTED = 2048  # texels whose surroundings give the axes
_PICK = 0x7E7  # purpose of the draw that picks them

Describe = Callable[[int, int], Float32[np.ndarray, "texel component"]]
"""Features of the texels of rows ``first .. last - 1``, row by row."""


@dataclass(frozen=True, eq=False)
class TextonFeatures:
    """The leading 32 principal components of what a bank sees around each texel, the image mirrored at its border.

    Departure: the paper clusters all n² values a channel. The components left out tell few textons apart
    (docs/papers/texton.md has the measured difference).
    """

    image: Image  # texels that may not be used filled from the nearest
    bank: Bank
    projection: Projection

    @staticmethod
    def of(image: Image, bank: Bank, usable: Bool[np.ndarray, "row column"] | None) -> "TextonFeatures":
        """Find the axes, from up to 2048 of the usable texels."""
        image = fill_masked(image, usable)
        kernels = bank.kernels(0.0)
        side = kernels.shape[1]
        texel = np.arange(image.shape[0] * image.shape[1]) if usable is None else np.flatnonzero(usable)
        texel = texel[np.sort(draws.permutation(0, _PICK, count=len(texel))[:_FITTED])]
        around = np.lib.stride_tricks.sliding_window_view(_mirrored(image, side // 2), (side, side), axis=(0, 1))
        picked = around[texel // image.shape[1], texel % image.shape[1]].reshape(-1, side * side)
        with single_threaded():
            seen = (picked @ kernels.reshape(len(kernels), -1).T).reshape(len(texel), -1)
        return TextonFeatures(image, bank, fit(seen, _COMPONENTS))

    def all(self, turn: float) -> Float32[np.ndarray, "texel component"]:
        """Features of every texel, row by row."""
        describe = self.turned(turn)
        return np.concatenate(over_blocks(describe, len(self.image), ROWS))

    def turned(self, turn: float) -> Describe:
        """What the bank turned by ``turn`` radians sees: the texels ``image[p + exp(1j turn) d]`` around each ``p``."""
        kernels = self.bank.kernels(turn)
        side, channels = kernels.shape[1], self.image.shape[2]
        axes = self.projection.axes.reshape(channels, len(kernels), -1)
        with single_threaded():
            lines = np.einsum("rst,crk->stck", kernels, axes, optimize=True).reshape(side, side * channels, -1)
            offset = self.projection.mean @ self.projection.axes
        lines, read = np.ascontiguousarray(lines), _read(kernels, channels)
        padded = _mirrored(self.image, side // 2)
        columns = self.image.shape[1]

        def describe(first: int, last: int) -> Float32[np.ndarray, "texel component"]:
            pieces = np.lib.stride_tricks.sliding_window_view(padded[first : last + side - 1], side, axis=1)
            pieces = pieces.transpose(0, 1, 3, 2).reshape(-1, columns, side * channels)
            total = np.broadcast_to(-offset, ((last - first) * columns, len(offset))).copy()
            for line, part in enumerate(read):
                total += pieces[line : line + last - first, :, part].reshape(len(total), -1) @ lines[line, part]
            return total

        return describe


def _read(kernels: Float32[np.ndarray, "response side side"], channels: int) -> list[slice]:
    """The part of each line of texels that any kernel reads."""
    read = []
    used = np.abs(kernels).max(axis=0)
    for line in used:
        place = np.flatnonzero(line)
        read.append(slice(channels * place[0], channels * (place[-1] + 1)) if len(place) else slice(0, 0))
    return read


def _mirrored(image: Image, reach: int) -> Float32[np.ndarray, "tall wide channel"]:
    """With ``reach`` more texels on every side."""
    return np.pad(image, ((reach, reach), (reach, reach), (0, 0)), mode="symmetric")
