"""Growing a texture from coherent blocks of the sample: match, cut, paste; every part of the sample in its fair share.

The steps are those of image quilting (Efros & Freeman 2001) and graph-cut textures (Kwatra et al. 2003) on patches of
any domain. Ours: seams are closed paths in the unrolled border of a patch, so that one dynamic program serves any
order of laying; blocks pay for being used more than their fair share, and those of samples shown too little are let
off some; and a block that continues its neighbour exactly counts no better than a good fit, which keeps copied regions
small.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom import draws
from texloom.arrays import fours
from texloom.domain.patches import Patches
from texloom.exemplar.blas import single_threaded
from texloom.exemplar.exemplar import Part
from texloom.kernels.launch import launch
from texloom.kernels.patches import cut_seams
from texloom.progress import Report
from texloom.search.blocks import BlockSearch
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.pasting import Pasting
from texloom.synthesis.reading import read
from texloom.synthesis.seams import Ring
from texloom.synthesis.shares import Shares
from texloom.synthesis.usage import Usage

_CHOICE = 0xB10C  # purpose of the draws that choose a block where nothing is known yet
_TURN = 0x7042  # of the draws that decide where samples take turns
_TYPICAL = 200  # the typical mismatch is that of the best 1 / 200 of all candidates
_LEAST = 1e-8  # mismatch taken for typical where everything fits, as on a constant sample
_FINALISTS = 4  # candidates whose seams are cut
_FLOOR = 0.5  # of the typical mismatch: fits better than this count alike
_SEAM_FLOOR = 0.5  # of the finalists' mean seam cost, likewise


@dataclass(frozen=True, eq=False)
class BlockGrowth:
    """One run of growth: the domain's patches, where blocks come from, and how seams are cut."""

    patches: Patches
    search: BlockSearch
    ring: Ring
    area: Float32[np.ndarray, "site"]
    balance: float  # typical mismatches a block pays for having had its fair share already (squared)
    seed: int
    sites: Bool[np.ndarray, "site"] | None = None  # those that may be written; None: all
    parts: tuple[Part, ...] = ()  # of the search's image, where it is of several samples: each gets its share

    def run(self, canvas: Canvas, batches: Sequence[Int32[np.ndarray, "_"]], report: Report) -> None:
        """Lay every batch in turn onto the canvas; patches of one batch share no site."""
        usage = self._usage(canvas)
        pasting = Pasting.of(self.patches, self.sites, first=canvas.next_label)
        samples = np.arange(self.patches.width**2, dtype=np.int32)
        with single_threaded():  # products whose rounding does not follow the number of threads
            for done, chosen in enumerate(batches):
                values, known = read(canvas, self.patches, chosen, samples)
                anchors, seam = self._choose(chosen, values, known, usage)
                self._paste(canvas, pasting, usage, chosen, anchors, seam)
                report("blocks", (done + 1) / len(batches))

    def _usage(self, canvas: Canvas) -> Usage:
        """What the sites that may be written show already: it is given back where a block covers it."""
        usage = Usage(self.search)
        shown = canvas.label >= 0 if self.sites is None else self.sites & (canvas.label >= 0)
        usage.add(canvas.position[shown], self.area[shown])
        return usage

    def _choose(
        self,
        chosen: Int32[np.ndarray, "patch"],
        values: Float32[np.ndarray, "patch sample channel"],
        known: Float32[np.ndarray, "patch sample"],
        usage: Usage,
    ) -> tuple[Int32[np.ndarray, "patch 2"], Int32[np.ndarray, "patch perimeter"]]:
        """The block that fits best where the canvas is coloured, a less used one among equals; any where it is bare."""
        coarse = self.search.coarse_cost(values, known)
        rank = min(max(coarse.shape[1] // _TYPICAL, 4), coarse.shape[1] - 1)
        typical = np.maximum(np.partition(coarse, rank, axis=1)[:, rank, None], _LEAST)
        price = self._price(chosen, coarse, typical, usage)
        bare = known.sum(1) == 0
        coarse[bare] = draws.uniform(
            self.seed, _CHOICE, index=(chosen[bare, None] * 65537 + np.arange(coarse.shape[1])).ravel()
        ).reshape(-1, coarse.shape[1])
        typical[bare] = 1.0

        wish = np.maximum(coarse / typical, _FLOOR) + price
        shortlist = min(self.search.shortlist, wish.shape[1])
        candidates = np.sort(np.argpartition(wish, shortlist - 1, axis=1)[:, :shortlist], axis=1).astype(np.int32)
        anchors, cost = self.search.refine(candidates, values, known)
        cost[bare] = np.take_along_axis(coarse[bare], candidates[bare], 1)
        price = np.take_along_axis(price, candidates, 1)
        wish = np.maximum(cost / typical, _FLOOR) + price
        finalists = np.argsort(wish, axis=1, kind="stable")[:, :_FINALISTS]
        anchors = np.ascontiguousarray(np.take_along_axis(anchors, finalists[:, :, None], 1))
        seam, seam_cost = self._cut(anchors, values, known)
        usual = np.maximum(seam_cost.mean(1, keepdims=True), 1e-12)
        wish = np.maximum(seam_cost / usual, _SEAM_FLOOR) + np.take_along_axis(price, finalists, 1)
        best = wish.argmin(1)
        row = np.arange(len(chosen))
        return np.ascontiguousarray(anchors[row, best]), np.ascontiguousarray(seam[row, best])

    @cached_property
    def _shares(self) -> Shares | None:
        """The samples that take turns, if there are several."""
        return Shares.of(self.search, self.parts)

    def _price(
        self,
        chosen: Int32[np.ndarray, "patch"],
        coarse: Float32[np.ndarray, "patch candidate"],
        typical: Float32[np.ndarray, "patch 1"],
        usage: Usage,
    ) -> Float32[np.ndarray, "patch candidate"]:
        """Typical mismatches that blocks pay for having been used, less what their samples are let off."""
        price = np.broadcast_to(self.balance * usage.excess() ** 2, coarse.shape)
        if self._shares is None or self.balance == 0:
            return price
        chance = draws.uniform(self.seed, _TURN, index=chosen)
        return price - self._shares.let_off(coarse, chance, usage) / typical

    def _cut(
        self,
        anchors: Int32[np.ndarray, "patch candidate 2"],
        values: Float32[np.ndarray, "patch sample channel"],
        known: Float32[np.ndarray, "patch sample"],
    ) -> tuple[Int32[np.ndarray, "patch candidate perimeter"], Float32[np.ndarray, "patch candidate"]]:
        """How deep inside its border each candidate block would begin, and what its seam would cost."""
        around, depth, _ = self.ring.samples.shape
        count = anchors.shape[0] * anchors.shape[1]
        seam, cost = np.empty((*anchors.shape[:2], around), np.int32), np.empty(anchors.shape[:2], np.float32)
        scratch = np.empty((count, 2, depth), np.float32), np.empty((count, 2 * around, depth), np.int8)
        launch(
            cut_seams,
            count,
            inputs=[
                *(self.ring.samples, anchors, self.patches.width),
                *(fours(values), known, fours(self.search.image)),
            ],
            outputs=[*scratch, seam, cost],
            grain=10,
        )
        return seam, cost

    def _paste(
        self,
        canvas: Canvas,
        pasting: Pasting,
        usage: Usage,
        chosen: Int32[np.ndarray, "patch"],
        anchors: Int32[np.ndarray, "patch 2"],
        seam: Int32[np.ndarray, "patch perimeter"],
    ) -> None:
        """Give the sites inside the seams their new sources, and keep count of what is shown."""
        own = pasting.own(chosen)
        site = pasting.site[own[0]]
        was, coloured = canvas.position[site], canvas.label[site] >= 0
        place = self.ring.place
        took = pasting.paste(canvas, self.search.image, chosen, anchors, own, place=place, seam=seam)
        usage.add(canvas.position[site[took]], self.area[site[took]])
        over = took & coloured
        usage.add(was[over], -self.area[site[over]])
