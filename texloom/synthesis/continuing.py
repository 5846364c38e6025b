"""Blocks that continue what is known around bare sites, and letting them take over where they fit."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom import draws
from texloom.arrays import Image
from texloom.domain.domain import Domain
from texloom.domain.steps import within
from texloom.exemplar.exemplar import LEAST_SIDE, Exemplar
from texloom.progress import Report
from texloom.search.blocks import BlockSearch, readable, roomy
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.expansion import Expansion, Proposal
from texloom.synthesis.pasting import Pasting
from texloom.synthesis.reading import read
from texloom.synthesis.schedule import batches, overlaps, touching

WIDTH = 24  # texels: of the patches matched across the border; wider ones would ask for what is not in the sample
_TOP = 4  # best blocks of each that are proposed
_MANY = 400  # patches: of more, half as many blocks are, which bring nine tenths of what all would
_WIDEST = 96  # texels: of the patches matched over what has been laid, a third of the sample where that is less
_RIM = 2  # texels: how far beyond such a patch its block may take over
_PITCH = 0.5  # of the width: how far such patches are apart
_CONTEXT = 0.15  # of a patch: the least that must be known
_CHANCE = 0.5  # how much worse a block may fit by chance, so that another seed is another try
_ORDER = 0xC047  # purpose of the draws
_CELL = 2  # samples a side that are taken together in the first round
_NEAR = 2  # steps: how far around it a block grows, in the second


@dataclass(frozen=True, eq=False)
class Across:
    """Where texture is to be continued: the bare sites, and how many steps they go from what is known (or more)."""

    domain: Domain
    bare: Bool[np.ndarray, "site"]
    depth: int


@dataclass(frozen=True, eq=False)
class Continuing:
    """Patches across the border of what is known, and for each the blocks that match it best there, best first."""

    blocks: Pasting  # what each block may take: bare sites in and around its patch
    anchors: Int32[np.ndarray, "patch rank 2"]  # upper left texel of what a block would show there
    groups: list[Int32[np.ndarray, "_"]]  # best matches first; the blocks of one group do not touch

    @staticmethod
    def everywhere(
        canvas: Canvas, image: Image, exemplar: Exemplar, domain: Domain, sites: Bool[np.ndarray, "site"], seed: int
    ) -> "Continuing | None":
        """Patches over all that has been laid: what is seen at one side of a seam is continued across it."""
        width = max(min(exemplar.least_side // 3, _WIDEST), LEAST_SIDE) // 4 * 4
        across = Across(domain, sites, _RIM)
        return Continuing.of(canvas, image, exemplar.mask, across, width=width, seed=seed, top=_TOP // 2)

    @staticmethod
    def of(
        canvas: Canvas,
        image: Image,
        mask: Bool[np.ndarray, "row column"] | None,
        across: "Across",
        *,
        width: int,
        seed: int,
        top: int = _TOP,
    ) -> "Continuing | None":
        """Patches of ``width`` (narrower if the mask has no room for them) lain half over each other, and matched.

        The ``top`` best blocks of each are proposed.

        None where the mask holds no block at all, or too little is known.
        """
        search = _search(image, mask, width)
        if search is None:
            return None
        domain, bare, width = across.domain, across.bare, search.width
        centres = domain.centres(_PITCH * width, seed)
        patches = domain.patches(centres[within(domain, bare, 2 * width)[centres]], width)
        touched = touching(patches, bare)
        values, known = read(canvas, patches, touched, np.arange(width**2, dtype=np.int32))
        enough = known.mean(1) >= _CONTEXT
        if not enough.any():
            return None
        top = top if np.count_nonzero(enough) <= _MANY else min(top, _TOP // 2)
        anchors, cost = _best(search, values[enough], known[enough], top, seed)
        margin = min(across.depth, width) + 1
        wide = domain.patches(patches.centres[touched[enough]], width + 2 * margin)
        groups = batches(np.argsort(cost[:, 0], kind="stable"), overlaps(wide))
        return Continuing(Pasting.of(wide, bare), anchors - np.int32(margin), groups)

    def take_over(self, expansion: Expansion, label: int, report: Report) -> None:
        """Propose all by rank, in cells at first; then those that are shown once more around it, texel by texel."""
        moves = [(group, rank) for rank in range(self.anchors.shape[1]) for group in self.groups]
        for number, (group, rank) in enumerate(moves):
            expansion.propose(self._proposal(group, rank, _CELL), label + number)
            report("seams", (number + 1) / len(moves))
        for number in np.unique(expansion.labels[expansion.labels >= label]).tolist():
            group, rank = moves[number - label]
            expansion.propose(self._proposal(group, rank, 1).only(expansion.around(number, _NEAR)), number)

    def _proposal(self, group: Int32[np.ndarray, "chosen"], rank: int, cell: int) -> Proposal:
        """The blocks of that rank of a group's patches, but for their rims, so that they do not touch."""
        blocks, width = self.blocks, self.blocks.patches.width
        entries, owner = blocks.own(group)
        place = blocks.position[entries]
        inner = ((place >= 1) & (place <= width - 2)).all(1)
        entries, owner, place = entries[inner], owner[inner], place[inner]
        row, column = np.rint(place).astype(np.int64).T // cell
        turn = blocks.turn[entries] if len(blocks.turn) > 1 else np.zeros(len(entries), np.float32)
        position = place + self.anchors[group[owner], rank]
        return Proposal(blocks.site[entries], position, turn, (owner * width + row) * width + column)


def _search(image: Image, mask: Bool[np.ndarray, "row column"] | None, width: int) -> BlockSearch | None:
    """The search of the widest blocks of at most ``width`` that the mask has room for."""
    searches = (BlockSearch(image, side, readable(mask)) for side in range(width, LEAST_SIDE - 1, -4))
    return roomy(searches)


def _best(
    search: BlockSearch,
    values: Float32[np.ndarray, "patch sample channel"],
    known: Float32[np.ndarray, "patch sample"],
    top: int,
    seed: int,
) -> tuple[Int32[np.ndarray, "patch rank 2"], Float32[np.ndarray, "patch rank"]]:
    """The best blocks of each patch and how far they differ from what is known of it, give or take some chance."""
    coarse = search.coarse_cost(values, known)
    count = min(3 * _TOP, coarse.shape[1])
    near = np.sort(np.argpartition(coarse, count - 1, axis=1)[:, :count], axis=1).astype(np.int32)
    anchors, cost = search.refine(near, values, known)
    cost *= 1 + _CHANCE * draws.uniform(seed, _ORDER, index=np.arange(cost.size)).reshape(cost.shape)
    best = np.argsort(cost, axis=1, kind="stable")[:, :top]
    return np.take_along_axis(anchors, best[:, :, None], 1), np.take_along_axis(cost, best, 1)
