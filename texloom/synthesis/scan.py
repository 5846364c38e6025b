"""Pixel by pixel in scan order: the exact, sequential synthesis of Shin & Shin 2004, section 3.

Every pixel takes the texel whose window is nearest to its own. A window is compared by its principal components, which
are kept up to date for all pixels: when a line is done, one matrix product adds what its changes mean to the windows
around. While some of a window is unknown, its components are the most likely ones given the known part: with axes A of
variances Λ, noise σ² and known values M x, y = (Aᵀ M A + σ² Λ⁻¹)⁻¹ Aᵀ M (x - μ). The paper does not say how it
searches a tree with a window that is partly unknown.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32, Int32
from numpy.lib.stride_tricks import sliding_window_view

from texloom.arrays import Image, fours
from texloom.domain.domain import Lattice
from texloom.exemplar.blas import over_blocks, single_threaded
from texloom.exemplar.windows import Windows
from texloom.kernels.launch import launch
from texloom.kernels.scan import scan_line
from texloom.search.tree import KdTree
from texloom.synthesis.canvas import Canvas

_BLOCK = 64  # windows whose Gram matrices are made at once
_LEAST_VARIANCE = 1e-3  # of the noise: axes that vary less are kept near 0


@dataclass(frozen=True, eq=False)
class Scan:
    """Scan-line synthesis on one canvas, whose sites lie in a lattice."""

    canvas: Canvas
    image: Image  # channels in fours
    windows: Windows
    lattice: Lattice
    shortlist: int  # nearest windows that are compared by their colours; 1: the nearest is taken

    @cached_property
    def cost(self) -> Float32[np.ndarray, "site"]:
        """Mean squared difference to what surrounded each pixel when it was visited last."""
        return np.zeros(self.lattice.rows * self.lattice.columns, np.float32)

    def run(
        self,
        chosen: Bool[np.ndarray, "site"],
        steps: Int32[np.ndarray, "step 2"],
        *,
        axis: int = 0,
        backwards: bool = False,
    ) -> Iterator[float]:
        """Visit the chosen pixels: row by row, or column by column with ``axis`` 1; yields the part that is done.

        ``steps`` from the window's middle are compared, the nearest first.
        """
        sites = self._sites if axis == 0 else self._sites.T
        forth = slice(None, None, -1 if backwards else 1)
        order = np.flatnonzero(chosen[sites].any(axis=1))[forth]
        for number, at in enumerate(order.tolist(), 1):
            line = np.ascontiguousarray(sites[at])
            visits = np.ascontiguousarray(np.flatnonzero(chosen[line])[forth], np.int32)
            self._visit(line, visits, steps, at, axis)
            yield number / len(order)

    def _visit(
        self,
        line: Int32[np.ndarray, "n"],
        visits: Int32[np.ndarray, "visit"],
        steps: Int32[np.ndarray, "step 2"],
        at: int,
        axis: int,
    ) -> None:
        """One line, and what its changes mean to the windows around."""
        windows, before = self.windows, self._shown(line)
        projected = np.array(self._projected.swapaxes(0, axis)[at], order="C")  # the line's own copy, while it is done
        inverse, mean = self._completion(at, axis, visits)
        launch(
            scan_line,
            1,
            inputs=[
                *(line, visits, self._shape, inverse, fours(mean), fours(self._along[axis])),
                *(fours(windows.vectors), *self._tree.arrays, windows.centre, windows.candidate_at),
                *(fours(self.image), steps, np.empty(len(steps), np.int32)),
                *(fours(np.empty_like(projected[:1])), np.empty(9, np.int32)),
                *(np.empty((1, self.shortlist), np.int32), np.empty((1, self.shortlist), np.float32)),
            ],
            outputs=[
                *(fours(projected), fours(self.canvas.colour), self.canvas.position, self.canvas.label, self.cost)
            ],
        )
        change = self._shown(line) - before
        if change.any():
            windows.add_line(self._projected, change, at, axis=axis, wrap=self.lattice.wrap)

    def _completion(
        self, at: int, axis: int, visits: Int32[np.ndarray, "visit"]
    ) -> tuple[Float32[np.ndarray, "visit_or_1 d d"], Float32[np.ndarray, "visit_or_1 component"]]:
        """What turns the components of the known parts into the likely components of whole windows, visit by visit."""
        known = self._known_around(at, axis, visits)
        if known.all():
            return np.zeros((1, 1, 1), np.float32), self.windows.mean_components[None]
        count = self.windows.axes.shape[3]
        gram = np.empty((len(visits), self._products.shape[1]), np.float32)

        def multiply(first: int, last: int) -> None:
            gram[first:last] = known[first:last].reshape(last - first, -1).astype(np.float32) @ self._products

        over_blocks(multiply, len(visits), _BLOCK)
        matrix = gram[:, : count * count].reshape(-1, count, count).astype(np.float64)
        prior = self.windows.noise / np.maximum(self.windows.variance, self.windows.noise * _LEAST_VARIANCE)
        with single_threaded():
            inverse = np.linalg.inv(matrix + np.diag(prior))
        return inverse.astype(np.float32), np.ascontiguousarray(gram[:, count * count :])

    def _known_around(
        self, at: int, axis: int, visits: Int32[np.ndarray, "visit"]
    ) -> Bool[np.ndarray, "visit width width"]:
        """Which sites of the windows of a line's visits are coloured by then: earlier visits of the line are."""
        width = 2 * self.windows.reach + 1
        known = (self.canvas.label >= 0).reshape(self._sites.shape).swapaxes(0, axis)
        rank = np.full(self._sites.shape[1 - axis], len(visits))
        rank[visits] = np.arange(len(visits))
        strip = self._padded(known, outside=False)[at : at + width]
        around = sliding_window_view(strip, width, axis=1).swapaxes(0, 1)[visits]
        beside = sliding_window_view(self._padded(rank, outside=len(visits)), width)[visits]
        around[:, self.windows.reach] |= beside < np.arange(len(visits))[:, None]
        return around if axis == 0 else around.swapaxes(1, 2)

    def _padded(self, values: np.ndarray, *, outside: int) -> np.ndarray:
        """The values with a window's reach around them: those beyond the border, on a torus; else ``outside``."""
        if self.lattice.wrap:
            return np.pad(values, self.windows.reach, mode="wrap")
        return np.pad(values, self.windows.reach, constant_values=outside)

    def _shown(self, line: Int32[np.ndarray, "n"]) -> Float32[np.ndarray, "n channel"]:
        """The line's colours, 0 where there is none yet, in the channels of the windows."""
        return self.canvas.colour[line, : self.windows.axes.shape[2]] * (self.canvas.label[line] >= 0)[:, None]

    @cached_property
    def _sites(self) -> Int32[np.ndarray, "row column"]:
        rows, columns = self.lattice.rows, self.lattice.columns
        return np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)

    @property
    def _shape(self) -> Int32[np.ndarray, "3"]:
        return np.array([self.lattice.rows, self.lattice.columns, self.lattice.wrap], np.int32)

    @cached_property
    def _projected(self) -> Float32[np.ndarray, "row column component"]:
        """Components of the known part of every pixel's window, kept up to date."""
        total = np.zeros((*self._sites.shape, self.windows.axes.shape[3]), np.float32)
        for row, line in enumerate(self._sites):
            shown = self._shown(line)
            if shown.any():
                self.windows.add_line(total, shown, row, axis=0, wrap=self.lattice.wrap)
        return total

    @cached_property
    def _tree(self) -> KdTree:
        return KdTree.of(self.windows.vectors)

    @cached_property
    def _along(self) -> tuple[np.ndarray, np.ndarray]:
        """The axes of a window's own row, and of its own column."""
        middle = self.windows.reach
        return np.ascontiguousarray(self.windows.axes[middle]), np.ascontiguousarray(self.windows.axes[:, middle])

    @cached_property
    def _products(self) -> Float32[np.ndarray, "place product"]:
        """What a known place of a window adds to Aᵀ M A and to Aᵀ M μ."""
        axes, mean = self.windows.axes, self.windows.mean
        count = axes.shape[3]
        places = axes.reshape(-1, axes.shape[2], count)
        gram = np.einsum("pci,pcj->pij", places, places).reshape(len(places), -1)
        means = np.einsum("pci,pc->pi", places, mean.reshape(len(places), -1))
        return np.ascontiguousarray(np.concatenate([gram, means], axis=1))
