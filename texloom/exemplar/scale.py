"""How large the structure of a sample is: its dominant scale, from the power spectrum summed over rings.

Shin & Shin 2004, section 3, "Window Size Estimation".
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32

from texloom.arrays import Image
from texloom.exemplar.blas import single_threaded
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image

_THICKNESS = 0.1  # of a ring, in cycles across the sample (the paper's d)
_ANGLES = 720  # directions of the half circle at which a ring is read
_FEWEST_CYCLES = 4.0  # across the sample's shorter side: the window, twice the scale, is at most half of it
_FINEST = 5.0  # texels: structure that fine is grain, and needs no smaller window
MOST_READ = 1024  # texels a side: of a larger sample the middle is enough


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power by frequency, and the scale at its peak. Frequencies are in cycles a texel, evenly spaced."""

    frequency: Float[np.ndarray, "ring"]
    power: Float[np.ndarray, "ring"]  # P(r); the whole range sums to 1
    peak: int  # the ring of the dominant frequency
    prominence: float  # power at the peak over the mean of all rings: near 1 there is no dominant scale to speak of

    @property
    def scale(self) -> float:
        """The dominant scale in texels, N / r̂ in the paper's words."""
        return 1.0 / float(self.frequency[self.peak])


def dominant_scale(exemplar: Exemplar) -> Spectrum:
    """The spectrum of what matching compares, all maps in their shares."""
    return spectrum(match_image(exemplar), exemplar.mask)


def spectrum(image: Image, usable: Bool[np.ndarray, "row column"] | None = None) -> Spectrum:
    """P(r), the power spectrum integrated over rings 0.1 cycles thick, and its highest peak.

    Channels are summed. A plane is taken off first, the mean with it: it is light falling off, not structure. Masked
    texels are filled with the plane. The peak is the highest local maximum between four cycles across the shorter side
    and one in five texels; without one, the highest ring there.

    Departures: frequencies are cycles a texel, so that a sample need not be square. A ring's power is integrated over
    its area, r dr dθ, not summed over angles alone: the sum as it is printed favours the longest waves, and takes the
    light on a heap of gravel for its stones. Of sides over 1024 texels the middle 1024 are read.
    """
    power, (rows, columns) = power_spectrum(image, usable)
    shorter = min(rows, columns)
    cycles = np.arange(0.5, shorter / 2, _THICKNESS)
    frequency = cycles / shorter
    ring = frequency * _ring_means(power, frequency)
    ring /= ring.sum() or 1.0
    peak = _highest_peak(ring, (cycles >= min(_FEWEST_CYCLES, shorter / _FINEST)) & (frequency <= 1 / _FINEST))
    mean = float(ring.mean())
    return Spectrum(frequency, ring, peak, float(ring[peak]) / mean if mean else 0.0)


def power_spectrum(
    image: Image, usable: Bool[np.ndarray, "row column"] | None = None
) -> tuple[Float32[np.ndarray, "twice_row column_and_1"], tuple[int, int]]:
    """|F(u, v)|² summed over channels where u ≥ 0, as ``rfft2`` lays it out, and the rows and columns it is of.

    The sample lies among as many zeros again, so that frequencies half a cycle apart are read: enough to interpolate
    between. A fitted plane is taken off each channel.
    """
    from scipy.fft import rfft2

    image, usable = middle(image), None if usable is None else middle(usable)
    rows, columns, channels = image.shape
    power = np.zeros((2 * rows, columns + 1), np.float32)
    flat = _without_plane(image, usable)
    for channel in range(channels):
        waves = np.asarray(rfft2(flat[..., channel], s=(2 * rows, 2 * columns)))
        power += np.abs(waves) ** 2
    return power, (rows, columns)


def middle(image: np.ndarray) -> np.ndarray:
    """The middle of a large picture, 1024 texels a side at most."""
    rows, columns = (slice(max(0, (side - MOST_READ) // 2), None) for side in image.shape[:2])
    return image[rows, columns][:MOST_READ, :MOST_READ]


def _without_plane(image: Image, usable: Bool[np.ndarray, "row column"] | None) -> Image:
    """The image less its fitted plane; 0 where masked."""
    rows, columns, channels = image.shape
    down, across = np.meshgrid(np.linspace(-1, 1, rows), np.linspace(-1, 1, columns), indexing="ij")
    basis = np.stack([np.ones_like(down), down, across], axis=2).reshape(-1, 3)
    if usable is not None:
        basis *= usable.reshape(-1, 1)
    texels = image.reshape(-1, channels).astype(np.float64)
    with single_threaded():
        plane = np.linalg.lstsq(basis.T @ basis, basis.T @ texels, rcond=None)[0]
        flat = (texels - basis @ plane).astype(np.float32).reshape(image.shape)
    return flat if usable is None else np.where(usable[..., None], flat, np.float32(0))


def _ring_means(
    power: Float32[np.ndarray, "row column"], frequency: Float[np.ndarray, "ring"]
) -> Float[np.ndarray, "ring"]:
    """Mean power over the half circle of each frequency, interpolated between the spectrum's cells."""
    from scipy.ndimage import map_coordinates

    angle = (np.arange(_ANGLES) + 0.5) * np.pi / _ANGLES
    down = np.outer(frequency, np.cos(angle)) * power.shape[0]
    across = np.outer(frequency, np.sin(angle)) * 2 * (power.shape[1] - 1)
    read = np.asarray(map_coordinates(power, [down, across], order=1, mode="grid-wrap"))
    return read.mean(axis=1, dtype=np.float64)


def _highest_peak(power: Float[np.ndarray, "ring"], allowed: Bool[np.ndarray, "ring"]) -> int:
    """The highest local maximum among the allowed rings, else the highest of them."""
    rises = np.diff(power, prepend=0.0) > 0
    falls = np.diff(power, append=0.0) <= 0
    peaks = allowed & rises & falls
    among = peaks if peaks.any() else allowed
    return int(np.where(among, power, -1.0).argmax())
