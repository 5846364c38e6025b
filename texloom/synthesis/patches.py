"""Patch-based sampling: the texture laid patch by patch (key `patches`)."""

import time
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from jaxtyping import Int32

from texloom import draws
from texloom.arrays import Image, in_fours
from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.progress import Report
from texloom.search.blocks import BlockSearch
from texloom.synthesis.blocks import BlockGrowth
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.result import Result
from texloom.synthesis.schedule import batches, breadth_first, overlaps
from texloom.synthesis.seams import ring

Order = Literal["scan", "breadth-first", "random"]

_STEP = 4  # texels; patches are a whole number of steps wide
_LARGE = 384  # texels: samples with this shorter side or more are searched in double steps first
_LARGEST = 64  # texels: larger blocks would show as copies


@dataclass(frozen=True, kw_only=True)
class PatchSampling:
    """Coherent blocks of the sample, matched, cut along least-cost seams and laid in order.

    After Chen, Liu & Dong, section 5. Departures: blocks are matched on all that is laid already instead of on an
    estimated boundary; seams are cut (Kwatra et al. 2003) instead of blended; every part of the sample is used its
    fair share. The paper's own method is ``BoundarySampling``.
    """

    patch: int | None = None  # texels per side; None: a quarter of the sample's shorter side, 16 to 64
    overlap: float = 1 / 3  # of the patch: how far neighbours overlap, and how deep seams may run
    balance: float = 0.4  # typical mismatches a block pays for having had its fair share already
    order: Order = "breadth-first"

    def __post_init__(self) -> None:
        if self.patch is not None and self.patch < 2 * _STEP:
            raise ParameterError(f"patch {self.patch} is too small: use {2 * _STEP} texels or more")
        if not 0 < self.overlap <= 0.5:
            raise ParameterError(f"overlap {self.overlap} must be above 0 and at most 0.5 of the patch")
        if not self.balance >= 0:
            raise ParameterError(f"balance {self.balance} must be 0 or more")
        if self.order not in get_args(Order):
            raise ParameterError(f"unknown order {self.order!r}: choose one of {', '.join(get_args(Order))}")

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """Cover the domain once; see ``synthesize``."""
        start = time.perf_counter()
        canvas, count, seconds = self.lay(exemplar, in_fours(match_image(exemplar)), domain, seed=seed, report=report)
        seconds["blocks"] = time.perf_counter() - start - sum(seconds.values())
        return Result(canvas.sources(), seconds=seconds, patches=count)

    def lay(
        self, exemplar: Exemplar, image: Image, domain: Domain, *, seed: int, report: Report
    ) -> tuple[Canvas, int, dict[str, float]]:
        """The canvas covered with blocks, how many, and the seconds that preparing the patches took."""
        search = self.search_for(exemplar, image)
        width = search.width
        depth = max(2, round(self.overlap * width))
        start = time.perf_counter()
        patches = domain.patches(domain.centres(width - depth, seed), width)
        shared = overlaps(patches)
        groups = batches(self.ordered(patches, shared, seed), shared)
        seconds = {"patches": time.perf_counter() - start}
        canvas = Canvas.empty(domain.count, image.shape[2])
        growth = BlockGrowth(patches, search, ring(width, depth), domain.area, self.balance, seed)
        growth.run(canvas, groups, report)
        canvas.close(domain, image)
        return canvas, patches.count, seconds

    def search_for(self, exemplar: Exemplar, image: Image) -> BlockSearch:
        """The search among blocks; narrower ones than the sample's size suggests where its mask holds no such block.

        Raises: ExemplarError, if the mask holds no block of the width asked for, or none at all.
        """
        for width in range(self.width_for(exemplar), 2 * _STEP - 1, -_STEP):
            step = 2 * _STEP if min(exemplar.shape) >= _LARGE and width % (2 * _STEP) == 0 else _STEP
            search = BlockSearch(image, width, exemplar.mask, step=step)
            if len(search.anchors):
                return search
            if self.patch is not None:
                raise ExemplarError(f"no {width}x{width} block lies inside the mask: lower patch, or widen the mask")
        raise ExemplarError(f"no {2 * _STEP}x{2 * _STEP} block lies inside the mask: widen the mask")

    def width_for(self, exemplar: Exemplar) -> int:
        """Texels a side: as asked, or by the sample's size; never more than half of it, in whole steps."""
        side = min(exemplar.shape)
        wanted = self.patch if self.patch is not None else min(max(side // 4, 16), _LARGEST)
        return max(2 * _STEP, min(wanted, side // 2 if side >= 4 * _STEP else side) // _STEP * _STEP)

    def ordered(self, patches: Patches, shared: np.ndarray, seed: int) -> Int32[np.ndarray, "patch"]:
        """The order of laying."""
        if self.order == "random":
            return draws.permutation(seed, count=patches.count).astype(np.int32)
        if self.order == "breadth-first":
            return breadth_first(shared, seed)
        return np.arange(patches.count, dtype=np.int32)
