"""What a texton sees of the texels around it: a window under a Gaussian, or the answers of a bank of filters.

Both are linear in the texels, so each is a bank of kernels, and the same bank turned describes the turned surroundings:
no image is ever turned. Offsets are complex, column + 1j · row.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float, Float32

from texloom.errors import ParameterError

_LARGEST = 31  # texels a side of a window: the kernels of a wider one would be most of the work
_SPREAD = 0.25  # standard deviation of the weights, as a share of the width: an eighth is left at the border

# The bank of Leung & Malik (2001): scales in texels; a filter spans three standard deviations of the largest.
_EDGE_SCALES = 2.0 ** np.array([0.0, 0.5, 1.0])
_BLOB_SCALES = 2.0 ** np.array([0.5, 1.0, 1.5, 2.0])
_ELONGATION = 3.0  # along an edge over across it
_DIRECTIONS = 6
_FILTER_REACH = 24

Kernels = Float32[np.ndarray, "response side side"]


@dataclass(frozen=True)
class WindowBank:
    """The ``width × width`` texels around one, weighted by a Gaussian (Magda & Kriegman 2003, section 3.1).

    Weights of a squared difference sum to 1, so it is that of the image averaged around the texel; the factors of the
    texels are their square roots, again a Gaussian.

    Raises: ParameterError, unless the width is odd and from 3 to 31.
    """

    width: int

    def __post_init__(self) -> None:
        if not (3 <= self.width <= _LARGEST and self.width % 2):
            raise ParameterError(f"window {self.width}: give an odd number of texels from 3 to {_LARGEST}, such as 11")

    def kernels(self, turn: float) -> Kernels:
        """One kernel a texel of the window turned by ``turn`` radians: its bilinear taps times its factor."""
        place = _square(self.width // 2).ravel()
        weight = np.exp(-0.5 * (np.abs(place) / (_SPREAD * self.width)) ** 2)
        at = place * np.exp(1j * turn)
        at = np.round(at.real, 9) + 1j * np.round(at.imag, 9)  # quarter turns fall on texels
        reach = int(np.ceil(max(np.abs(at.real).max(), np.abs(at.imag).max())))
        kernels = np.zeros((len(place), 2 * reach + 1, 2 * reach + 1))
        row, column = np.floor(at.imag).astype(int), np.floor(at.real).astype(int)
        down, right = at.imag - row, at.real - column
        factor = np.sqrt(weight / weight.sum())
        for below, beside in np.ndindex(2, 2):
            tap = factor * (down if below else 1 - down) * (right if beside else 1 - right)
            texel = np.flatnonzero(tap)  # where nothing is read the tap may lie outside
            kernels[texel, row[texel] + below + reach, column[texel] + beside + reach] = tap[texel]
        return kernels.astype(np.float32)


@dataclass(frozen=True)
class FilterBank:
    """48 filters: elongated first and second derivatives at 3 scales in 6 directions, 8 Laplacians, 4 Gaussians.

    After Leung & Malik (2001), in the usual discrete form: 49 texels wide, absolute values that sum to 1, and sum 0 but
    for the Gaussians. Directions turn with the surroundings.
    """

    def kernels(self, turn: float) -> Kernels:
        """The filters turned by ``turn`` radians."""
        place = _square(_FILTER_REACH)
        edges, bars = [], []
        for scale in _EDGE_SCALES:
            for direction in np.arange(_DIRECTIONS) * np.pi / _DIRECTIONS + turn:
                turned = place * np.exp(-1j * direction)
                across, along = turned.imag, turned.real
                envelope = _gaussian(across, scale) * _gaussian(along, _ELONGATION * scale)
                edges.append(_balanced(-across / scale**2 * envelope))
                bars.append(_balanced((across**2 / scale**2 - 1) / scale**2 * envelope))
        distance = np.abs(place)
        blobs = [
            _balanced((distance**2 - 2 * scale**2) / scale**4 * _gaussian(distance, scale))
            for scale in (*_BLOB_SCALES, *(3 * _BLOB_SCALES))
        ]
        means = [_gaussian(distance, scale) for scale in _BLOB_SCALES]
        return np.stack([*edges, *bars, *blobs, *(mean / mean.sum() for mean in means)]).astype(np.float32)


Bank = WindowBank | FilterBank


def _square(reach: int) -> Complex[np.ndarray, "side side"]:
    """Offsets up to ``reach`` texels along rows and columns."""
    along = np.arange(-reach, reach + 1)
    return along[None, :] + 1j * along[:, None]


def _gaussian(distance: Float[np.ndarray, "side side"], scale: float) -> Float[np.ndarray, "side side"]:
    return np.exp(-0.5 * (distance / scale) ** 2)


def _balanced(kernel: Float[np.ndarray, "side side"]) -> Float[np.ndarray, "side side"]:
    """Of sum 0, absolute values of sum 1."""
    kernel = kernel - kernel.mean()
    return kernel / np.abs(kernel).sum()
