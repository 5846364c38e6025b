"""Pasting blocks of the exemplar onto the sites of patches."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom.arrays import Image, fours
from texloom.domain.cover import group_by_site
from texloom.domain.patches import Patches
from texloom.kernels.launch import launch
from texloom.kernels.patches import paste_blocks
from texloom.synthesis.canvas import Canvas


@dataclass(frozen=True, eq=False)
class Pasting:
    """The cover of patches turned about: patch ``p`` lies over entries ``start[p] ... start[p + 1] - 1``.

    Kept in the order of patches, so that pasting walks through memory instead of jumping.
    """

    patches: Patches
    start: Int32[np.ndarray, "patches_plus_one"]
    site: Int32[np.ndarray, "entry"]
    position: Float32[np.ndarray, "entry 2"]
    turn: Float32[np.ndarray, "entry_or_1"]
    first: int = 0  # label of what patch 0 shows

    @staticmethod
    def of(patches: Patches, sites: Bool[np.ndarray, "site"] | None = None, *, first: int = 0) -> "Pasting":
        """O(entry) time; made once for patches that are pasted batch by batch. Only ``sites`` are ever written."""
        count = len(patches.cover_start) - 1
        site = np.repeat(np.arange(count, dtype=np.int32), np.diff(patches.cover_start))
        owner = patches.cover_patch if sites is None else np.where(sites[site], patches.cover_patch, np.int32(-1))
        start, entries = group_by_site(owner, patches.count)
        turn = np.zeros(1, np.float32) if patches.cover_turn is None else patches.cover_turn[entries]
        return Pasting(patches, start, site[entries], patches.cover_position[entries], turn, first)

    def own(self, chosen: Int32[np.ndarray, "chosen"]) -> tuple[Int32[np.ndarray, "own"], Int32[np.ndarray, "own"]]:
        """Entries of the chosen patches one after the other, and which of the patches each belongs to."""
        entries = np.concatenate([np.arange(*self.start[p : p + 2].tolist(), dtype=np.int32) for p in chosen])
        return entries, np.repeat(np.arange(len(chosen), dtype=np.int32), np.diff(self.start)[chosen])

    def paste(
        self,
        canvas: Canvas,
        image: Image,
        chosen: Int32[np.ndarray, "chosen"],
        anchors: Int32[np.ndarray, "chosen 2"],
        own: tuple[Int32[np.ndarray, "own"], Int32[np.ndarray, "own"]],
        *,
        scale: float = 1.0,
        place: Int32[np.ndarray, "sample 2"] | None = None,
        seam: Int32[np.ndarray, "chosen perimeter"] | None = None,
    ) -> Bool[np.ndarray, "own"]:
        """Show block ``anchors`` of the image in each chosen patch; tells which entries took it.

        ``scale`` is texels of the image a sample. Without a seam the whole patch is shown; with one, what lies inside
        it by ``place`` (see ``Ring``) and what was bare. The chosen patches share no site.
        """
        patches = self.patches
        if place is None or seam is None:
            place, seam = np.zeros((patches.width**2, 2), np.int32), np.zeros((len(chosen), 1), np.int32)
        pasted = np.empty(len(own[0]), np.uint8)
        launch(
            paste_blocks,
            len(pasted),
            inputs=[
                *(*own, self.site, self.position, self.turn),
                *(chosen, anchors, scale, patches.width, place, seam, fours(image), self.first),
            ],
            outputs=[canvas.label, canvas.position, canvas.turn, fours(canvas.colour), pasted],
            grain=5000,
        )
        return pasted != 0
