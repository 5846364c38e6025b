"""Where over a partly known picture does a whole sample fit? All translations at once, by Fourier transforms.

Kwatra et al. 2003, sections 3.1 and 5, "entire patch matching".
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from texloom.arrays import Image
from texloom.domain.domain import Lattice


class Covering(NamedTuple):
    """The sample laid over one site, in every way: entry [row, column] is for that texel of it on the site."""

    cost: Float[np.ndarray, "row column"]  # mean squared difference over the overlap; inf where there is none
    overlap: Int[np.ndarray, "row column"]  # known sites that usable texels would cover
    fresh: Int[np.ndarray, "row column"]  # sites not known that the core would cover


class Placement:
    """How a sample fits over the known sites of a lattice, at each of its translations.

    ``usable`` texels are compared; those of ``core``, some of them, are what would be laid. Sums over the overlap are
    kept for every translation. Sites that become known add to those that reach them, so the work of a step grows with
    the sample and not with the lattice: for n channels, n + 2 transforms and 3 back, of twice the sample's sides. On
    a torus all copies of the sample count. Memory: 16 bytes a translation.
    """

    def __init__(
        self,
        sample: Image,
        usable: Bool[np.ndarray, "row column"],
        core: Bool[np.ndarray, "row column"],
        lattice: Lattice,
    ) -> None:
        from scipy.fft import next_fast_len

        self.shape: tuple[int, int] = usable.shape[:2]
        self.usable, self.core = usable, core
        self._lattice = lattice
        self._size = tuple(next_fast_len(2 * side - 1, real=True) for side in self.shape)
        self._mean = sample[usable].mean(0, dtype=np.float64)  # taken off, so that sums lose fewer digits
        texels = np.where(usable, np.moveaxis(sample - self._mean, 2, 0), 0.0)
        self._texels = self._transform(texels).conj()
        self._squares = self._transform((texels**2).sum(0)).conj()
        self._usable, self._core = (self._transform(m.astype(np.float64)).conj() for m in (usable, core))
        margin = (0, 0) if lattice.wrap else tuple(side - 1 for side in self.shape)
        self._difference = np.zeros((lattice.rows + margin[0], lattice.columns + margin[1]))
        self._overlap = np.zeros(self._difference.shape, np.int32)
        self._fresh = _covered(core, lattice)

    def add(
        self,
        corner: tuple[int, int],
        colour: Float32[np.ndarray, "row column channel"],
        known: Bool[np.ndarray, "row column"],
    ) -> None:
        """The known sites of a rectangle are matched from now on; ``corner`` is its first row and column.

        Each site is to be added once. The rectangle may pass the border, where on a plane nothing is known.
        """
        self._change(corner, colour, known, 1)

    def take_away(
        self,
        corner: tuple[int, int],
        colour: Float32[np.ndarray, "row column channel"],
        known: Bool[np.ndarray, "row column"],
    ) -> None:
        """The reverse of ``add``, for sites about to show something else."""
        self._change(corner, colour, known, -1)

    def covering(self, row: int, column: int) -> Covering:
        """The sample laid over the site at that row and column, in every way."""
        at = self._translations((row, column), [np.arange(0, -side, -1) for side in self.shape])
        overlap = self._overlap[at]
        cost = np.full(self.shape, np.inf)
        np.divide(np.maximum(self._difference[at], 0), overlap, out=cost, where=overlap > 0)
        return Covering(cost, overlap, self._fresh[at])

    def _change(self, corner: tuple[int, int], colour: np.ndarray, known: np.ndarray, sign: int) -> None:
        """In pieces no larger than the sample, as the transforms are."""
        rows, columns = self.shape
        for row in range(0, known.shape[0], rows):
            for column in range(0, known.shape[1], columns):
                piece = slice(row, row + rows), slice(column, column + columns)
                if known[piece].any():
                    first, last = np.argwhere(known[piece]).min(0), np.argwhere(known[piece]).max(0) + 1
                    part = slice(first[0], last[0]), slice(first[1], last[1])
                    at = corner[0] + row + int(first[0]), corner[1] + column + int(first[1])
                    self._correlate(at, colour[piece][part], known[piece][part], sign)

    def _correlate(self, corner: tuple[int, int], colour: np.ndarray, known: np.ndarray, sign: int) -> None:
        """Σ known |colour - texel|², multiplied out, is three correlations with the sample; counts are one each."""
        values = np.where(known, np.moveaxis(colour - self._mean, 2, 0), 0.0)
        there = self._transform(known.astype(np.float64))
        difference = self._transform((values**2).sum(0)) * self._usable + there * self._squares
        difference -= 2 * (self._transform(values) * self._texels).sum(0)
        reached = [np.arange(1 - side, length) for side, length in zip(self.shape, known.shape, strict=True)]
        at = self._translations(corner, reached)
        take = np.ix_(*reached)  # negative shifts of a correlation are at its end
        counts = (self._back(there * mask)[take] for mask in (self._usable, self._core))
        overlap, laid = (np.rint(count).astype(np.int32) for count in counts)
        # Unbuffered, for on a small torus several shifts are one translation.
        np.add.at(self._difference, at, sign * self._back(difference)[take])
        np.add.at(self._overlap, at, sign * overlap)
        np.add.at(self._fresh, at, -sign * laid)

    def _translations(self, start: tuple[int, int], steps: list[np.ndarray]) -> tuple[np.ndarray, ...]:
        """Index of the translations that lay the sample's first texel these steps from ``start``."""
        if self._lattice.wrap:
            return np.ix_(*((at + s) % n for at, s, n in zip(start, steps, self._overlap.shape, strict=True)))
        return np.ix_(*(at + s + side - 1 for at, s, side in zip(start, steps, self.shape, strict=True)))

    def _transform(self, values: np.ndarray) -> np.ndarray:
        """One thread: the same sums whatever the number of threads."""
        from scipy.fft import rfft2

        return np.asarray(rfft2(values, s=self._size, workers=1))

    def _back(self, wave: np.ndarray) -> np.ndarray:
        from scipy.fft import irfft2

        return np.asarray(irfft2(wave, s=self._size, workers=1))


def _covered(texels: Bool[np.ndarray, "row column"], lattice: Lattice) -> Int[np.ndarray, "down across"]:
    """Sites that these texels cover at every translation, copies counted on a torus."""
    if lattice.wrap:
        return np.full((lattice.rows, lattice.columns), np.count_nonzero(texels), np.int32)
    sums = np.pad(np.cumsum(np.cumsum(texels, 0, dtype=np.int32), 1, dtype=np.int32), ((1, 0), (1, 0)))
    shown = []
    for length, side in zip((lattice.rows, lattice.columns), texels.shape, strict=True):
        first = np.arange(1 - side, length)  # where the sample's first texel lies
        shown.append((np.maximum(-first, 0), np.minimum(length - first, side)))
    (top, bottom), (left, right) = shown
    corners = sums[np.ix_(bottom, right)] - sums[np.ix_(top, right)]
    return corners - sums[np.ix_(bottom, left)] + sums[np.ix_(top, left)]
