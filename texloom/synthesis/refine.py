"""Pixel-based synthesis by iterative refinement (key `refine`), after Shin & Shin 2004."""

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count
from typing import Literal, get_args

import numpy as np

from texloom.arrays import Image
from texloom.domain.domain import Domain, Lattice
from texloom.domain.neighbourhoods import square, stencil
from texloom.domain.steps import within
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import LEAST_SIDE, Exemplar
from texloom.exemplar.patches import whole_squares
from texloom.exemplar.scale import dominant_scale
from texloom.exemplar.windows import Windows
from texloom.progress import Report
from texloom.search.blocks import BlockSearch
from texloom.synthesis.continuing import roomy
from texloom.synthesis.convergence import Convergence, Difference
from texloom.synthesis.correction import Correction, near_borders
from texloom.synthesis.growth import Grown, Growth, added, run_on_bare
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.result import Result
from texloom.synthesis.scan import Scan
from texloom.synthesis.seeds import plant

Order = Literal["parallel", "scan-line"]

_BLOCK = 0.4  # of the sample's shorter side: the first pass of the parallel order copies blocks this wide
_NEAR = 3  # texels around a pixel that later passes compare: what is far weighs as much, and tears edges
_FIRST = 18  # texels around a pixel that the first scan compares one by one; the tree sees the whole window
_BORDER = 8  # steps from the blocks' borders where refinement may change a pixel


@dataclass(frozen=True, kw_only=True)
class Refine:
    """Every pixel takes the texel whose window fits its own best, again and again, until little changes.

    ``order`` "scan-line" is the paper's: seed points are planted, the first pass goes pixel by pixel from what is
    known, later passes compare whole windows, and the search is PCA and a kd-tree. It is a sequence, on images only;
    around what is known, seeds keep a window away from it, and the passes turn through four directions.
    "parallel" does not depend on the order of pixels and works on any domain: the first pass copies windows whole, as
    blocks, which then take over from each other where that makes seams cheaper; later passes try what the pixels
    around suggest (k-coherence, with ``alike`` further texels each). It gives better pictures of most samples in a
    tenth of the time, so it is the default.

    Where nothing is known the plane is grown as a torus in scan-line order, as in the paper.
    """

    order: Order = "parallel"
    # Texels a side: of what scan lines compare; of the narrowest blocks in parallel. None: twice the dominant scale.
    window: int | None = None
    pitch: int | None = None  # texels between seed points; None: the dominant scale
    passes: int = 10
    threshold: float = 0.01  # stop when a pass changes less than this (eq. 1); 0 never does
    difference: Difference = "mean"
    dimensions: int = 8  # of the tree
    shortlist: int = 4  # nearest windows in the tree that are compared in full; 1 is the paper's search
    alike: int = 0  # k of k-coherence

    def __post_init__(self) -> None:
        if self.order not in get_args(Order):
            raise ParameterError(f"unknown order {self.order!r}: choose {' or '.join(get_args(Order))}")
        if self.difference not in get_args(Difference):
            raise ParameterError(f"unknown difference {self.difference!r}: choose {' or '.join(get_args(Difference))}")
        if self.window is not None and self.window < 3:
            raise ParameterError(f"window {self.window} is too small: use 3 texels or more")
        if self.pitch is not None and self.pitch < 1:
            raise ParameterError(f"pitch {self.pitch} is too small: use 1 texel or more")
        if self.pitch is not None and self.order != "scan-line":
            raise ParameterError(f"pitch {self.pitch} is between seeds, which {self.order} order has not: leave it out")
        if min(self.passes, self.dimensions, self.shortlist) < 1:
            raise ParameterError(
                f"passes {self.passes}, dimensions {self.dimensions} and shortlist {self.shortlist} must be 1 or more"
            )
        if not self.threshold >= 0 or self.alike < 0:
            raise ParameterError(f"threshold {self.threshold} and alike {self.alike} must be 0 or more")

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """Cover the domain; see ``synthesize``."""
        return run_on_bare(self, exemplar, domain, seed=seed, report=report)

    def grow(self, growth: Growth) -> Grown:
        """Colour the bare sites, then refine all of ``sites``; see ``Grower``."""
        start = time.perf_counter()
        window, pitch = self._sizes(growth.exemplar)
        seconds = {"analysis": time.perf_counter() - start}
        grown = self._parallel(growth, window) if self.order == "parallel" else self._scan_lines(growth, window, pitch)
        return replace(grown, seconds=added(seconds, grown.seconds))

    def _sizes(self, exemplar: Exemplar) -> tuple[int, int]:
        """Window and pitch, in texels: as asked, or by the dominant scale; a window is at most half the sample wide."""
        if self.window is not None and self.pitch is not None:
            return self.window, self.pitch
        scale = dominant_scale(exemplar).scale
        most = max(3, exemplar.least_side // 2)
        return self.window or min(max(3, round(2 * scale)), most), self.pitch or max(1, min(round(scale), most))

    def _parallel(self, growth: Growth, window: int) -> Grown:
        """Blocks, then passes in which every pixel tries what its surroundings suggest."""
        canvas, domain, exemplar = growth.canvas, growth.domain, growth.exemplar
        blocks = PatchSampling(patch=self._block(exemplar, growth.image, window), settle=True)
        grown = blocks.grow(growth)
        start = time.perf_counter()
        correction = Correction.of(exemplar, growth.image, reach=min(window // 2, _NEAR), alike=self.alike)
        near = np.flatnonzero(near_borders(canvas, domain, _BORDER) & growth.writable).astype(np.int32)
        passes = correction.passes(canvas, domain, near, seed=growth.seed)
        curve = Convergence(self.difference, self.threshold, growth.writable)
        energy, stopped = curve.follow(canvas, _told(passes, self.passes, growth.report), self.passes)
        seconds = added(grown.seconds, {"refinement": time.perf_counter() - start})
        return Grown(energy, seconds, stopped, grown.patches, curve.curves)

    def _block(self, exemplar: Exemplar, image: Image, window: int) -> int:
        """Texels a side of the blocks of the first pass: a window, or more in a large sample, if the mask has room."""
        most = max(LEAST_SIDE, exemplar.least_side // 2)
        widest = min(max(window, round(exemplar.least_side * _BLOCK), LEAST_SIDE), most) // 4 * 4
        search = roomy(BlockSearch(image, width, exemplar.mask) for width in range(widest, LEAST_SIDE - 1, -4))
        return LEAST_SIDE if search is None else search.width

    def _scan_lines(self, growth: Growth, window: int, pitch: int) -> Grown:
        """A first pass from seeds, or from what is known; then passes with whole windows."""
        lattice = growth.domain.lattice
        if lattice is None:
            raise ParameterError("scan-line order needs an image without a field: use the parallel order")
        start = time.perf_counter()
        window = window if self.window else _fitting(growth.exemplar, window)
        windows = Windows.of(_filled(growth.image), window // 2, self.dimensions, growth.exemplar.mask)
        hole = not growth.canvas.bare().all()
        if not hole:
            lattice = lattice._replace(wrap=True)
        _plant(growth, lattice, pitch, window)
        seconds = {"analysis": time.perf_counter() - start}
        start = time.perf_counter()
        scan = Scan(growth.canvas, growth.image, windows, lattice, self.shortlist)
        passes = self._scans(scan, growth, turning=hole)
        first = next(passes)
        curve = Convergence(self.difference, self.threshold, growth.writable)
        energy, stopped = curve.follow(growth.canvas, passes, self.passes - 1)
        seconds |= {"scan": time.perf_counter() - start}
        return Grown((first, *energy), seconds, stopped, 0, curve.curves)

    def _scans(self, scan: Scan, growth: Growth, *, turning: bool) -> Iterator[float]:
        """The bare sites, then all of them again and again, ``turning`` in four directions; the cost of each pass."""
        reach = scan.windows.reach
        for turn in count():
            chosen = growth.writable if turn else growth.bare
            steps = stencil(reach) if turn else square(min(reach, _FIRST))
            direction = turn % 4 if turning else 0
            for done in scan.run(chosen, steps, axis=direction % 2, backwards=direction > 1):
                growth.report("scan", (turn + done) / self.passes)
            yield float(scan.cost[chosen].mean(dtype=np.float64)) if chosen.any() else 0.0


def _plant(growth: Growth, lattice: Lattice, pitch: int, apart: int) -> None:
    """Seed points on an even grid, ``apart`` from what is known: nearer it is the better guide."""
    canvas, image = growth.canvas, growth.image
    room = growth.writable & ~within(growth.domain, growth.known, apart)
    grid = max(1, round(lattice.rows / pitch)), max(1, round(lattice.columns / pitch))
    row, column = (np.arange(n) * size // n for n, size in zip(grid, lattice[:2], strict=True))
    site = (row[:, None] * lattice.columns + column).ravel()
    if not room[site].any():
        return
    source = plant(image, pitch, grid, seed=growth.seed, usable=growth.exemplar.mask).reshape(-1, 2)
    source, site = source[room[site]], site[room[site]]
    canvas.position[site] = source
    canvas.colour[site] = image[source[:, 0], source[:, 1]]
    canvas.label[site] = 0


def _told(passes: Iterator[float], most: int, report: Report) -> Iterator[float]:
    """The same passes, each reported."""
    for number, left in enumerate(passes, 1):
        report("refinement", number / most)
        yield left


def _fitting(exemplar: Exemplar, window: int) -> int:
    """The widest window, at most so wide, that the usable part of the exemplar holds: beside a hole there is little."""
    mask = exemplar.usable
    return next((width for width in range(window, 3, -2) if whole_squares(mask, width | 1).any()), 3)


def _filled(image: Image) -> Image:
    """The image without the channels of zeros at its end, which make their number a multiple of four."""
    filled = np.flatnonzero(image.any((0, 1)))
    return np.ascontiguousarray(image[..., : max(filled, default=0) + 1])
