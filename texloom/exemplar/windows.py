"""The windows around an exemplar's texels in a few dimensions: wide surroundings, compared at the price of small ones.

A window 37 texels wide of 3 channels is a vector of 4107 numbers, and an exemplar has tens of thousands. They are never
built: the principal axes come from a few hundred of them (Liang et al. 2001 reduce patches so), and a projection is a
correlation, summed line by line from one matrix product a line.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom import draws
from texloom.arrays import Image
from texloom.errors import ExemplarError
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.patches import whole_squares
from texloom.exemplar.pca import fit

_FITTED = 768  # windows whose axes are found: their covariance varies little from that of all
_PICK = 0x3D0  # purpose of the draw that picks them
_LINES = 8  # lines multiplied at once
_LEAST_NOISE = 1e-7  # squared colour units: so that what is unknown never counts as certain


@dataclass(frozen=True, eq=False)
class Windows:
    """Squares of ``2 reach + 1`` texels that lie whole in the usable part of an exemplar.

    ``axes`` are orthonormal over the window's values (or 0), ``variance`` is that along each of them, and ``noise`` the
    mean variance a value keeps beside them.
    """

    image: Image
    reach: int
    centre: Int32[np.ndarray, "candidate 2"]
    axes: Float32[np.ndarray, "width width channel component"]
    mean: Float32[np.ndarray, "width width channel"]
    variance: Float32[np.ndarray, "component"]
    noise: float

    @staticmethod
    def of(
        image: Image, reach: int, dimensions: int, usable: Bool[np.ndarray, "row column"] | None = None
    ) -> "Windows":
        """Find the axes. Axes of 0 make their number a multiple of four, as kernels take them.

        Raises: ExemplarError, if no window lies in the usable part.
        """
        width = 2 * reach + 1
        corner = np.argwhere(whole_squares(np.ones(image.shape[:2], bool) if usable is None else usable, width))
        if not len(corner):
            raise ExemplarError(f"no {width}x{width} window lies inside the sample and its mask: give a smaller window")
        picked = corner[np.sort(draws.permutation(0, _PICK, count=len(corner))[:_FITTED])]
        windows = np.lib.stride_tricks.sliding_window_view(image, (width, width), axis=(0, 1))
        sample = windows[picked[:, 0], picked[:, 1]].transpose(0, 2, 3, 1).reshape(len(picked), -1)
        projection = fit(sample, dimensions)
        variance = projection(sample).var(axis=0, dtype=np.float64)
        left = float((sample - projection.mean).var(axis=0, dtype=np.float64).sum() - variance.sum())
        absent = (0, dimensions + -dimensions % 4 - len(variance))
        return Windows(
            image,
            reach,
            centre=np.ascontiguousarray(corner + reach, np.int32),
            axes=np.pad(projection.axes, ((0, 0), absent)).reshape(width, width, image.shape[2], -1),
            mean=projection.mean.reshape(width, width, -1),
            variance=np.pad(variance, absent).astype(np.float32),
            noise=max(left / sample.shape[1], _LEAST_NOISE),
        )

    @cached_property
    def vectors(self) -> Float32[np.ndarray, "candidate component"]:
        """Components of every window, the mean window's at the origin."""
        rows, columns = self.image.shape[:2]
        total = np.zeros((rows, columns, self.axes.shape[3]), np.float32)
        for row in range(rows):
            self.add_line(total, self.image[row], row, axis=0, wrap=False)
        return total[self.centre[:, 0], self.centre[:, 1]] - self.mean_components

    @cached_property
    def candidate_at(self) -> Int32[np.ndarray, "row column"]:
        """Which window is centred on each texel; -1 where none is."""
        index = np.full(self.image.shape[:2], -1, np.int32)
        index[self.centre[:, 0], self.centre[:, 1]] = np.arange(len(self.centre))
        return index

    @cached_property
    def mean_components(self) -> Float32[np.ndarray, "component"]:
        """Components of the mean window itself."""
        return np.tensordot(self.mean, self.axes, 3)

    def add_line(
        self,
        total: Float32[np.ndarray, "row column component"],
        values: Float32[np.ndarray, "n channel"],
        at: int,
        *,
        axis: int,
        wrap: bool,
    ) -> None:
        """Add to the components of all windows what the ``values`` of row ``at`` (column, with ``axis`` 1) give them.

        One product of n × (width · channel) by (width · channel) × (width · component).
        """
        lines = total if axis == 0 else total.swapaxes(0, 1)
        padded = np.pad(values, ((self.reach, self.reach), (0, 0)), mode="wrap" if wrap else "constant")
        pieces = np.lib.stride_tricks.sliding_window_view(padded, 2 * self.reach + 1, axis=0).reshape(len(values), -1)
        matrix = self._by_line[axis]
        width, components = self.axes.shape[0], self.axes.shape[3]
        share = np.empty((len(values), matrix.shape[1]), np.float32)

        def multiply(first: int, last: int) -> None:
            share[:, first:last] = pieces @ matrix[:, first:last]

        over_blocks(multiply, matrix.shape[1], _LINES * components)
        share = share.reshape(len(values), width, components).swapaxes(0, 1)
        targets = at + self.reach - np.arange(width)  # line at + k is k lines before the windows' middle
        if wrap and len(lines) < width:  # a line may be seen twice
            np.add.at(lines, targets % len(lines), share)
            return
        inside = np.full(width, True) if wrap else (targets >= 0) & (targets < len(lines))
        lines[targets[inside] % len(lines)] += share[inside]

    @cached_property
    def _by_line(self) -> tuple[np.ndarray, np.ndarray]:
        """The axes as matrices: (channel, place in the line) by (line of the window, component); rows, columns."""

        def matrix(axes: np.ndarray) -> np.ndarray:
            across = axes.transpose(2, 1, 0, 3)
            return np.ascontiguousarray(across.reshape(across.shape[0] * across.shape[1], -1))

        return matrix(self.axes), matrix(self.axes.swapaxes(0, 1))
