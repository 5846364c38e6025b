"""Order-independent correction: where blocks meet, every site takes the texel that fits its surroundings.

After Lefebvre & Hoppe 2005 (§3.3), with the candidates of Ashikhmin 2001 and Tong et al. 2002. Inside a coherent block
every candidate is the block itself, so only sites near its border are visited.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int32, UInt8

from texloom import draws
from texloom.arrays import Image, fours
from texloom.domain.cover import group_by_site
from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.kernels.correction import correct_sites
from texloom.kernels.launch import launch
from texloom.progress import Report
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.reading import weights_of

_SUBPASSES = 4  # a random quarter of the sites at a time, so that most see their neighbours corrected
_CANDIDATES = 12  # distinct ones compared at most; near a border there are two to eight
_PART = 0xC0  # purpose of the draws that part the sites
_SKEW = 0.5  # radians: a site whose source is turned more than this keeps it


@dataclass(frozen=True, eq=False)
class Correction:
    """What correction compares with: the exemplar, where whole neighbourhoods fit in it, and its most alike texels."""

    image: Image  # channels a multiple of four
    usable: UInt8[np.ndarray, "row column"]  # 1 where a neighbourhood may be centred
    similar: Int32[np.ndarray, "row column k 2"]
    width: int  # of the neighbourhoods, odd

    def run(
        self, canvas: Canvas, domain: Domain, sites: Int32[np.ndarray, "n"], *, passes: int, seed: int, report: Report
    ) -> list[float]:
        """Correct ``sites`` that often; returns the mean squared difference that each pass leaves."""
        work = _Work.around(domain.patches(sites, self.width), domain.count)
        part = draws.bits(seed, _PART, index=sites) % _SUBPASSES
        energy = []
        for turn in range(passes):
            for subpass in range(_SUBPASSES):
                chosen = np.flatnonzero(part == subpass).astype(np.int32)
                self._correct(canvas, work, chosen, now=1 + turn * _SUBPASSES + subpass)
            energy.append(float(work.cost.mean(dtype=np.float64)) if len(sites) else 0.0)
            report("correction", (turn + 1) / passes)
        return energy

    def _correct(self, canvas: Canvas, work: "_Work", chosen: Int32[np.ndarray, "patch"], *, now: int) -> None:
        """All chosen sites at once, from what the canvas shows now."""
        patches, turn = work.patches, work.patches.cover_turn
        found = np.empty((len(chosen), 2), np.float32)
        values = np.empty((len(chosen), self.width**2, self.image.shape[2]), np.float32)
        known = np.empty(values.shape[:2], np.float32)
        tried = np.empty((len(chosen), _CANDIDATES, 2), np.float32)
        launch(
            correct_sites,
            len(chosen),
            inputs=[
                *(chosen, patches.centres, self.width, *work.entries, work.site_of_entry, patches.cover_position),
                np.zeros(1, np.float32) if turn is None else turn,
                *(patches.sites, weights_of(patches), fours(canvas.colour), canvas.label, work.changed, work.visited),
                *(canvas.position, canvas.turn, fours(self.image), self.usable, self.similar),
            ],
            outputs=[fours(values), known, tried, found, work.cost],
        )
        work.visited[chosen] = now
        site = patches.centres[chosen]
        moved = (canvas.position[site] != found).any(1) & (np.abs(canvas.turn[site]) < _SKEW)
        site, found = site[moved], found[moved]
        work.changed[site] = now
        canvas.position[site] = found
        texel = np.rint(found).astype(np.int32)
        canvas.colour[site] = self.image[texel[:, 0], texel[:, 1]]


@dataclass(frozen=True, eq=False)
class _Work:
    """Neighbourhoods around the sites to correct, and what is known of each visit."""

    patches: Patches
    entries: tuple[Int32[np.ndarray, "patches_plus_one"], Int32[np.ndarray, "entry"]]
    site_of_entry: Int32[np.ndarray, "entry"]
    changed: Int32[np.ndarray, "site"]  # the subpass in which a site last changed
    visited: Int32[np.ndarray, "patch"]  # the subpass in which a patch was last visited
    cost: Float32[np.ndarray, "patch"]

    @staticmethod
    def around(patches: Patches, count: int) -> "_Work":
        return _Work(
            patches,
            group_by_site(patches.cover_patch, patches.count),
            np.repeat(np.arange(count, dtype=np.int32), np.diff(patches.cover_start)),
            np.zeros(count, np.int32),
            np.zeros(patches.count, np.int32),
            np.zeros(patches.count, np.float32),
        )


def near_borders(canvas: Canvas, domain: Domain, reach: int) -> Bool[np.ndarray, "site"]:
    """Sites within ``reach`` steps of a place where neighbouring sites came with different patches."""
    first, second = domain.edges.T
    apart = canvas.label[first] != canvas.label[second]
    near = np.zeros(domain.count, bool)
    near[first[apart]] = near[second[apart]] = True
    for _ in range(reach):
        grown = near.copy()
        grown[first[near[second]]] = True
        grown[second[near[first]]] = True
        near = grown
    return near
