"""A fair share for every part of the sample: how often each is shown so far."""

import numpy as np
from jaxtyping import Float32, Int32

from texloom.exemplar.exemplar import Part
from texloom.search.blocks import BlockSearch

_MOST = 3.0  # fair shares: what is shown more often is no dearer
SOON = 0.3
"""Times the sample is taken to have been shown at least: chance should not weigh while there is little to share."""


class Usage:
    """Texels of output a texel of sample, counted in cells of ``step × step`` texels."""

    def __init__(self, search: BlockSearch) -> None:
        rows, columns, _ = search.image.shape
        self._step = search.step
        self._shape = -(-rows // self._step), -(-columns // self._step)
        self._shown = np.zeros(self._shape)
        self._usable = 1.0 if search.mask is None else float(search.mask.mean())
        self._cells = search.width // search.step
        self._candidates = search.anchors // search.step

    def add(self, position: Float32[np.ndarray, "n 2"], area: Float32[np.ndarray, "n"]) -> None:
        """Count sites that now show ``position`` (with negative area: no longer)."""
        flat = self._cell(position)
        self._shown += np.bincount(flat, weights=area, minlength=self._shown.size).reshape(self._shape)

    def excess_at(self, position: Float32[np.ndarray, "n 2"]) -> Float32[np.ndarray, "n"]:
        """Use of the cell around each position over its fair share, which is at most 3 here: 1 is fair, 0 unused."""
        return np.minimum(self._shown / self._fair, _MOST).astype(np.float32).ravel()[self._cell(position)]

    def shown(self, part: Part) -> float:
        """Texels of output that show the part; a cell that it ends in holds nothing else."""
        rows, columns = (slice(s.start // self._step, -(-s.stop // self._step)) for s in part.slices)
        return float(self._shown[rows, columns].sum())

    def excess(self) -> Float32[np.ndarray, "candidate"]:
        """Mean use of each candidate block over that of all usable texels: 1 is its fair share, 0 unused.

        Until about a third of the sample has been shown once, the share is taken as if it had been.
        """
        total = np.pad(self._shown.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
        r, c, n = self._candidates[:, 0], self._candidates[:, 1], self._cells
        block = total[r + n, c + n] - total[r, c + n] - total[r + n, c] + total[r, c]
        return (block / (n * n * self._fair)).astype(np.float32)

    @property
    def _fair(self) -> float:
        return max(self._shown.mean() / self._usable, SOON * self._step**2)

    def _cell(self, position: Float32[np.ndarray, "n 2"]) -> Int32[np.ndarray, "n"]:
        """The cell around each position, scan-line order."""
        cell = np.clip((position * np.float32(1 / self._step)).astype(np.int32), 0, np.array(self._shape) - 1)
        return cell[:, 0] * np.int32(self._shape[1]) + cell[:, 1]
