"""Patch-based sampling: the texture laid patch by patch (key `patches`)."""

import time
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from jaxtyping import Bool, Int32

from texloom import draws
from texloom.arrays import Image
from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.domain.steps import steps_from, within
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.progress import Report
from texloom.search.blocks import BlockSearch, roomy
from texloom.synthesis.blocks import BlockGrowth
from texloom.synthesis.continuing import WIDTH, Across, Continuing
from texloom.synthesis.expansion import Expansion
from texloom.synthesis.growth import Grown, Growth, run_on_bare
from texloom.synthesis.result import Result
from texloom.synthesis.schedule import batches, breadth_first, inwards, overlaps, touching
from texloom.synthesis.seams import ring
from texloom.synthesis.usage import Usage

Order = Literal["scan", "breadth-first", "random"]

_STEP = 4  # texels; patches are a whole number of steps wide
_LARGE = 384  # texels: samples with this shorter side or more are searched in double steps first
_THIN = 2  # steps from what is known: bare sites no farther need no block
_CELLS = 8  # along the sample's shorter side: parts whose use is evened out when blocks settle
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
    settle: bool = False  # at the end blocks take over across seams, where all seams together get cheaper

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
        return run_on_bare(self, exemplar, domain, seed=seed, report=report)

    def grow(self, growth: Growth) -> Grown:
        """Blocks over all that is bare, inwards from what is known, then cheaper ones at its border; see ``Grower``."""
        canvas, exemplar, image, domain = growth.canvas, growth.exemplar, growth.image, growth.domain
        bare, known = growth.bare, growth.known
        if not bare.any():
            return Grown()
        clock = [time.perf_counter()]
        continuing, usage, deep = None, None, bare
        if known.any():
            width = min(WIDTH, self.width_for(exemplar))
            steps = steps_from(domain, known, width)
            deep = bare & (steps > _THIN)  # what is as thin as a scratch is closed from its sides
            across = Across(domain, bare, int(steps[bare].max()))
            continuing = Continuing.of(canvas, image, exemplar.mask, across, width=width, seed=growth.seed)
        clock.append(time.perf_counter())
        count, tracing = self.lay(growth, deep)
        canvas.close(domain, image, exemplar.mask, growth.sites)
        clock.append(time.perf_counter())
        if self.settle and not known.any():
            continuing = Continuing.everywhere(canvas, image, exemplar, domain, bare, growth.seed)
            cell = max(exemplar.least_side // _CELLS, 2)
            usage = Usage(BlockSearch(image, cell, exemplar.mask, step=cell))
        if continuing is not None:
            expansion = Expansion(canvas, image, exemplar.usable, domain, bare, usage)
            continuing.take_over(expansion, canvas.next_label, growth.report)
        clock.append(time.perf_counter())
        matching, laying, cutting = np.diff(clock).tolist()
        seconds = {"patches": tracing, "blocks": laying - tracing}
        return Grown(seconds=seconds if continuing is None else seconds | {"seams": matching + cutting}, patches=count)

    def lay(self, growth: Growth, bare: Bool[np.ndarray, "site"]) -> tuple[int, float]:
        """Blocks over every patch that touches a bare site; how many, and the seconds that preparing patches took."""
        if not bare.any():
            return 0, 0.0
        exemplar, domain, seed = growth.exemplar, growth.domain, growth.seed
        search = self.search_for(exemplar, growth.image)
        depth = max(2, round(self.overlap * search.width))
        start = time.perf_counter()
        patches = self.patches(domain, bare, search.width, depth, seed)
        laid = touching(patches, bare)
        groups = self.groups(patches, laid, growth.known, seed)
        spent = time.perf_counter() - start
        seams = ring(search.width, depth)
        blocks = BlockGrowth(patches, search, seams, domain.area, self.balance, seed, growth.sites, exemplar.parts)
        blocks.run(growth.canvas, groups, growth.report)
        return len(laid), spent

    def patches(self, domain: Domain, bare: Bool[np.ndarray, "site"], width: int, depth: int, seed: int) -> Patches:
        """The domain's even patches, those that can touch a bare site at least: tracing them is what costs."""
        centres = domain.centres(width - depth, seed)
        if not bare.all():
            # A patch reaches its width along both axes together; edges of a mesh may be half a texel long.
            centres = centres[within(domain, bare, 2 * width)[centres]]
        return domain.patches(centres, width)

    def groups(
        self, patches: Patches, laid: Int32[np.ndarray, "laid"], known: Bool[np.ndarray, "site"], seed: int
    ) -> list[Int32[np.ndarray, "_"]]:
        """The patches laid, in batches."""
        shared = overlaps(patches)[np.ix_(laid, laid)]
        order = inwards(patches, known, laid, seed) if known.any() else self.ordered(shared, seed)
        return [laid[group] for group in batches(order, shared)]

    def search_for(self, exemplar: Exemplar, image: Image) -> BlockSearch:
        """The search among blocks; narrower ones than the sample's size suggests where its mask holds no such block.

        Raises: ExemplarError, if the mask holds no block of the width asked for, or none at all.
        """
        widest, large = self.width_for(exemplar), exemplar.least_side >= _LARGE
        narrowest = 2 * _STEP if self.patch is None else widest
        widths = range(widest, narrowest - 1, -_STEP)
        doubled = [large and width % (2 * _STEP) == 0 for width in widths]
        sizes = zip(widths, doubled, strict=True)
        search = roomy(BlockSearch(image, width, exemplar.mask, step=_STEP * (1 + twice)) for width, twice in sizes)
        if search is not None:
            return search
        remedy = "widen the mask" if self.patch is None else "lower patch, or widen the mask"
        raise ExemplarError(f"no {narrowest}x{narrowest} block lies inside the mask: {remedy}")

    def width_for(self, exemplar: Exemplar) -> int:
        """Texels a side: as asked, or by the sample's size; never more than half of it, in whole steps."""
        side = exemplar.least_side
        wanted = self.patch if self.patch is not None else min(max(side // 4, 16), _LARGEST)
        return max(2 * _STEP, min(wanted, side // 2 if side >= 4 * _STEP else side) // _STEP * _STEP)

    def ordered(self, shared: Bool[np.ndarray, "patch patch"], seed: int) -> Int32[np.ndarray, "patch"]:
        """The order of laying where nothing is known."""
        if self.order == "random":
            return draws.permutation(seed, count=len(shared)).astype(np.int32)
        if self.order == "breadth-first":
            return breadth_first(shared, seed)
        return np.arange(len(shared), dtype=np.int32)
