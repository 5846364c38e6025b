"""How periodic a sample is, and with which periods: peaks of its autocorrelation that lie on a lattice."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from texloom.arrays import Image
from texloom.exemplar.scale import MOST_READ, middle, power_spectrum

NEAR_REGULAR = 0.15
"""Regularity from which the eye sees a period: bricks, weaves and tiles have 0.2 to 1, grass and granite under 0.1."""

_SLOWEST = 3.0  # cycles across the shorter side: slower waves are light, and hide the peaks
_SOFT = 1 / 30  # of the scale: edges are softened as much, since no two straws or bricks are quite alike
_MOST_PEAKS = 200
_SHORT_ENOUGH = 0.7  # of the best peak's height: the shortest such is the period, longer ones its multiples
_SECOND = 0.5  # of the first period's height, which a second needs


@dataclass(frozen=True, eq=False)
class Regularity:
    """The share of the sample's variance that repeats over its lattice, 0 to 1, and the lattice's vectors.

    ``lattice`` has no vector, one (rows of something: planks, lines of text, ripples) or two: [row, column] in texels.
    ``correlation`` is the autocorrelation by lag, the lag 0 in its middle, up to three quarters of each side.
    """

    value: float
    lattice: tuple[tuple[float, float], ...]
    correlation: Float32[np.ndarray, "lag_row lag_column"]


def regularity(image: Image, scale: float, usable: Bool[np.ndarray, "row column"] | None = None) -> Regularity:
    """Find the lattice on which the sample correlates best with itself; ``scale`` is its dominant scale in texels.

    A period is a peak of the autocorrelation and counts for its height over the lowest place on the way to it, so that
    a stripe, which correlates all along itself, is no period. Periods are as long as the scale, less a quarter, or
    longer, and at most half a side. What is no higher than independent spots of that scale reach by chance is none.
    The value is the mean height at the vectors, their sum and their difference, or at the one vector and its double.
    A few Fourier transforms of four times the sample, and at most 200 peaks looked at.
    """
    correlation = autocorrelation(image, usable, blur=_SOFT * scale)
    landscape = _Landscape(correlation)
    sides = np.minimum(image.shape[:2], MOST_READ)
    peaks = landscape.peaks(0.75 * scale, sides // 2)
    heights = landscape.heights(peaks)
    certain = heights >= scale / np.sqrt((sides - np.abs(peaks)).prod(axis=1))
    peaks, heights = peaks[certain], heights[certain]
    if not len(peaks):
        return Regularity(0.0, (), correlation)
    first = peaks[_shortest_high(peaks, heights)]
    second = _second(landscape, peaks, first, scale)
    there = np.stack([first, 2 * first] if second is None else [first, second, first + second, first - second])
    value = float(np.clip(np.nanmean(landscape.heights(there)), 0.0, 1.0))
    vectors = [first] if second is None else [first, second]
    return Regularity(value, tuple((float(down), float(across)) for down, across in vectors), correlation)


def autocorrelation(
    image: Image, usable: Bool[np.ndarray, "row column"] | None = None, *, blur: float = 0.0
) -> Float32[np.ndarray, "lag_row lag_column"]:
    """Mean product of texels a lag apart over the mean square, the lag 0 in the middle, without slow waves.

    The sample is softened by a Gaussian of ``blur`` texels. Each lag is divided by the number of pairs it has, so
    that distant ones are not faded; where there are fewer pairs than a sixteenth of the texels it is 0.
    """
    from scipy.fft import irfft2

    power, (rows, columns) = power_spectrum(image, usable)
    down, across = np.fft.fftfreq(2 * rows)[:, None], np.fft.rfftfreq(2 * columns)[None]
    frequency = np.hypot(down, across)
    slow = np.exp(-0.5 * (frequency * min(rows, columns) / _SLOWEST) ** 2)
    kept = np.exp(-((2 * np.pi * blur * frequency) ** 2)) * (1 - slow)
    products = np.asarray(irfft2(power * kept, s=(2 * rows, 2 * columns)))
    pairs = _pairs(middle(np.ones(image.shape[:2], bool) if usable is None else usable))
    correlation = np.where(pairs > pairs[0, 0] / 16, products / np.maximum(pairs, 1.0), 0.0)
    correlation /= correlation[0, 0] or 1.0
    reach = 3 * rows // 4, 3 * columns // 4
    centred = np.fft.fftshift(correlation)
    return centred[rows - reach[0] : rows + reach[0] + 1, columns - reach[1] : columns + reach[1] + 1].astype(
        np.float32
    )


def _pairs(usable: Bool[np.ndarray, "row column"]) -> Float[np.ndarray, "twice_row twice_column"]:
    """How many pairs of usable texels lie each lag apart."""
    from scipy.fft import irfft2, rfft2

    shape = (2 * usable.shape[0], 2 * usable.shape[1])
    waves = np.asarray(rfft2(usable.astype(np.float64), s=shape))
    return np.round(np.asarray(irfft2(np.abs(waves) ** 2, s=shape)))


class _Landscape:
    """An autocorrelation read at lags."""

    def __init__(self, correlation: Float32[np.ndarray, "lag_row lag_column"]) -> None:
        from scipy.ndimage import maximum_filter

        self.correlation = correlation
        self.origin = np.array(correlation.shape) // 2
        self.around = np.asarray(maximum_filter(correlation, 3))  # periods are seldom whole texels

    def peaks(self, shortest: float, farthest: Int[np.ndarray, "2"]) -> Float[np.ndarray, "peak 2"]:
        """Lags of the highest local maxima of one half plane, highest first."""
        lag = np.argwhere(self.correlation == self.around) - self.origin
        half = (lag[:, 0] > 0) | ((lag[:, 0] == 0) & (lag[:, 1] > 0))
        lag = lag[half & (np.hypot(*lag.T) >= shortest) & (np.abs(lag) <= farthest).all(axis=1)]
        value = self.correlation[tuple((lag + self.origin).T)]
        return lag[np.argsort(-value, kind="stable")[:_MOST_PEAKS]].astype(np.float64)

    def heights(self, lag: Float[np.ndarray, "lag 2"]) -> Float[np.ndarray, "lag"]:
        """Correlation at each lag over the lowest on the way to it (0 at the least); NaN beyond the lags known."""
        way = lag[:, None] * np.linspace(0.1, 0.9, 33)[None, :, None]
        height = self._read(self.around, lag) - np.maximum(self._read(self.around, way).min(axis=1, initial=1), 0)
        return np.where((np.abs(lag) <= self.origin).all(axis=1), np.maximum(height, 0), np.nan)

    def _read(self, values: Float32[np.ndarray, "row column"], lag: Float[np.ndarray, "*shape 2"]) -> np.ndarray:
        from scipy.ndimage import map_coordinates

        place = np.moveaxis(lag + self.origin, -1, 0)
        return np.asarray(map_coordinates(values, place, order=1, mode="nearest"))


def _second(
    landscape: _Landscape, peaks: Float[np.ndarray, "peak 2"], first: Float[np.ndarray, "2"], scale: float
) -> Float[np.ndarray, "2"] | None:
    """The period that spans a lattice with the first; None where rows have no period of their own.

    A lattice's sum and difference of vectors are periods too: of two peaks in a row of stripes, one of them is a
    step along a stripe.
    """
    lag = peaks - np.round(peaks @ first / (first @ first))[:, None] * first
    aside = np.abs(lag @ [first[1], -first[0]]) / np.hypot(*first)
    lag = lag[(aside >= 0.4 * scale) & (np.hypot(*lag.T) >= 0.75 * scale)]
    if not len(lag):
        return None
    at = [landscape.heights(lag), landscape.heights(first + lag), landscape.heights(first - lag)]
    heights = np.nanmin(at, axis=0)
    if heights.max() < _SECOND * landscape.heights(first[None])[0]:
        return None
    return lag[_shortest_high(lag, heights)]


def _shortest_high(lag: Float[np.ndarray, "lag 2"], heights: Float[np.ndarray, "lag"]) -> int:
    """The shortest of the lags that are nearly as high as the highest."""
    high = np.flatnonzero(heights >= _SHORT_ENOUGH * heights.max())
    return int(high[np.hypot(*lag[high].T).argmin()])
