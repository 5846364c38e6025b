"""Where in the exemplar does a partly known patch fit? Coarse candidates by matrix product, then texel by texel."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom.arrays import Image, fours
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.patches import whole_squares
from texloom.kernels.launch import launch
from texloom.kernels.patches import refine_anchors

_BLOCK = 1024  # candidates compared at once


@dataclass(frozen=True, eq=False)
class BlockSearch:
    """Search of ``width × width`` blocks of an exemplar for patches of which some samples are known.

    Cost is the mean squared difference over the known samples. All blocks at multiples of ``step`` texels are compared
    on averages of ``step × step`` texels (|e|² m − 2 e·(m x), one matrix product); the ``shortlist`` best are moved by
    up to ``step // 2`` texels, compared at every so many samples. ``width`` is a multiple of ``step``.
    """

    image: Image
    width: int
    mask: Bool[np.ndarray, "row column"] | None = None
    step: int = 4  # texels
    shortlist: int = 8

    @cached_property
    def usable(self) -> np.ndarray:
        """(row, column) uint8: 1 where a block may begin."""
        rows, columns = (size - self.width + 1 for size in self.image.shape[:2])
        if self.mask is None:
            return np.ones((rows, columns), np.uint8)
        return whole_squares(self.mask, self.width).astype(np.uint8)

    @cached_property
    def anchors(self) -> Int32[np.ndarray, "candidate 2"]:
        """Upper left texel of every coarse candidate, scan-line order."""
        return np.argwhere(self.usable[:: self.step, :: self.step]).astype(np.int32) * np.int32(self.step)

    @cached_property
    def _coarse(self) -> tuple[np.ndarray, np.ndarray]:
        """Candidates as rows: the averaged texels (candidate, cell · channel), and their squares (candidate, cell)."""
        small = _average(self.image, self.step)
        cells = self.width // self.step
        windows = np.lib.stride_tricks.sliding_window_view(small, (cells, cells), axis=(0, 1))
        at = self.anchors // self.step
        rows = windows[at[:, 0], at[:, 1]].transpose(0, 2, 3, 1)
        flat = np.ascontiguousarray(rows.reshape(len(at), -1))
        return flat, (rows * rows).sum(3).reshape(len(at), -1)

    def coarse_cost(
        self, values: Float32[np.ndarray, "patch sample channel"], known: Float32[np.ndarray, "patch sample"]
    ) -> Float32[np.ndarray, "patch candidate"]:
        """Mean squared difference of averaged texels, over the known part; 0 where nothing is known."""
        cells = self.width // self.step
        blocks = (len(values), cells, self.step, cells, self.step)
        share = known.reshape(blocks).mean((2, 4)).reshape(len(values), -1)
        total = values.reshape(*blocks, -1).mean((2, 4)).reshape(*share.shape, -1)
        own = (total * total).sum(2) / np.maximum(share, 1e-6)
        texels, squares = self._coarse
        cross = total.reshape(len(values), -1)
        cost = np.empty((len(values), len(squares)), np.float32)

        def compare(first: int, last: int) -> None:
            cost[:, first:last] = share @ squares[first:last].T - 2 * (cross @ texels[first:last].T)

        over_blocks(compare, len(squares), _BLOCK)
        cost += own.sum(1)[:, None]
        return np.maximum(cost, 0) / np.maximum(share.sum(1), 1e-6)[:, None]

    def refine(
        self,
        candidates: Int32[np.ndarray, "patch shortlist"],
        values: Float32[np.ndarray, "patch sample channel"],
        known: Float32[np.ndarray, "patch sample"],
    ) -> tuple[Int32[np.ndarray, "patch shortlist 2"], Float32[np.ndarray, "patch shortlist"]]:
        """The best anchor within half a step of each coarse candidate, and its cost on the samples themselves."""
        near = np.ascontiguousarray(self.anchors[candidates])
        best, cost = np.empty_like(near), np.empty(candidates.shape, np.float32)
        launch(
            refine_anchors,
            candidates.size,
            inputs=[
                near,
                self.step // 2,
                self.width,
                self.step // 2,
                fours(values),
                known,
                fours(self.image),
                self.usable,
            ],
            outputs=[best, cost],
            grain=10,
        )
        return best, cost


def _average(image: Image, step: int) -> Float32[np.ndarray, "cell_row cell_column channel"]:
    """Means of ``step × step`` texels; an incomplete last row or column is left out."""
    rows, columns = image.shape[0] // step, image.shape[1] // step
    return image[: rows * step, : columns * step].reshape(rows, step, columns, step, -1).mean((1, 3))


def roomy(searches: Iterable[BlockSearch]) -> BlockSearch | None:
    """The first whose blocks begin at a quarter of the texels that may be used, as many as fit a square twice as wide.

    Else the first that has any block; None if none has. Around a hole that leaves a narrow frame, wide blocks would be
    few.
    """
    some = None
    for search in searches:
        if len(search.anchors):
            some = some or search
            if search.mask is None or search.usable.sum() >= search.mask.sum() / 4:
                return search
    return some


def readable(mask: Bool[np.ndarray, "row column"] | None) -> Bool[np.ndarray, "row column"] | None:
    """Texels that may be used, and those of holes at most two wide: a block may be compared across a scratch.

    Never to be shown: that is what the mask itself tells.
    """
    if mask is None:
        return None
    grown = np.pad(mask, 1, mode="edge")
    for axis in (0, 1):
        grown = grown | np.roll(grown, 1, axis) | np.roll(grown, -1, axis)
    grown = np.pad(grown[1:-1, 1:-1], 1, mode="edge")
    for axis in (0, 1):
        grown = grown & np.roll(grown, 1, axis) & np.roll(grown, -1, axis)
    return grown[1:-1, 1:-1]
