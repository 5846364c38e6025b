"""Several samples in fair shares, each in regions of its own.

A patch among others of a sample fits that one best, so unlike samples would never take turns: whichever comes first
covers everything.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Float32, Float64, Int64

from texloom.exemplar.exemplar import Part
from texloom.search.blocks import BlockSearch
from texloom.synthesis.usage import SOON, Usage

_PULL = 2.0  # at even chances, a sample that is nowhere shown beside one that has its share takes its turn


@dataclass(frozen=True, eq=False)
class Shares:
    """The samples side by side in an image that have blocks to offer, with the blocks and usable texels of each."""

    parts: tuple[Part, ...]
    blocks: tuple[Int64[np.ndarray, "_"], ...]  # which of the candidates
    texels: Float64[np.ndarray, "part"]

    @classmethod
    def of(cls, search: BlockSearch, parts: Sequence[Part]) -> Self | None:
        """None where there are not at least two to share."""
        usable = np.ones(search.image.shape[:2], bool) if search.mask is None else search.mask
        blocks = [np.flatnonzero(_begins_in(part, search)) for part in parts]
        used = [number for number in range(len(parts)) if len(blocks[number])]
        if len(used) < 2:
            return None
        texels = np.array([usable[parts[number].slices].sum() for number in used], np.float64)
        return cls(tuple(parts[number] for number in used), tuple(blocks[number] for number in used), texels)

    def behind(self, usage: Usage) -> Float64[np.ndarray, "part"]:
        """How many fair shares less each sample is shown than the one shown most; shares go by usable texels.

        While they are small they are taken as if all had been shown ``SOON`` times, as ``Usage.excess`` does.
        """
        shown = np.array([usage.shown(part) for part in self.parts])
        share = shown / self.texels / max(shown.sum() / self.texels.sum(), SOON)
        return share.max() - share

    def let_off(
        self,
        cost: Float32[np.ndarray, "patch candidate"],
        chance: Float32[np.ndarray, "patch"],
        usage: Usage,
    ) -> Float32[np.ndarray, "patch candidate"]:
        """How much of its cost each block is let off, for its sample being behind.

        The gap is what a change of sample costs: how much worse the worst one's best block fits than the best of all.
        Every sample is let off the gap, times how far it is behind, times the patch's ``chance`` of 0 to 1. So changes
        come where they are overdue or cheap, and regions stay whole until then.
        """
        best = np.stack([cost[:, own].min(1) for own in self.blocks], axis=1)
        gap = best.max(1) - best.min(1)
        off = np.zeros_like(cost)
        for own, behind in zip(self.blocks, self.behind(usage), strict=True):
            off[:, own] = (np.float32(_PULL * behind) * chance * gap)[:, None]
        return off


def _begins_in(part: Part, search: BlockSearch) -> np.ndarray:
    """Which candidates are blocks of the part."""
    row, column = search.anchors.T
    down, across = row - part.row, column - part.column
    return (down >= 0) & (down < part.rows) & (across >= 0) & (across < part.columns)
