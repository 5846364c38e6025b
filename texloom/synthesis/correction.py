"""Order-independent correction: where blocks meet, every site takes the texel that fits its surroundings.

After Lefebvre & Hoppe 2005 (§3.3), with the candidates of Ashikhmin 2001 and Tong et al. 2002. Inside a coherent block
every candidate is the block itself, so only sites near its border are visited.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int32, UInt8

from texloom import draws
from texloom.arrays import Image
from texloom.domain.cover import group_by_site
from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.kernels.correction import correct_sites
from texloom.kernels.launch import launch
from texloom.progress import Report
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.reading import read

_SUBPASSES = 4  # a random quarter of the sites at a time, so that most see their neighbours corrected
_PART = 0xC0  # purpose of the draws that part the sites
_SKEW = 0.5  # radians: a site whose source is turned more than this keeps it


@dataclass(frozen=True, eq=False)
class Correction:
    """What correction compares with: the exemplar, where whole neighbourhoods fit in it, and its most alike texels."""

    image: Image
    usable: UInt8[np.ndarray, "row column"]  # 1 where a neighbourhood may be centred
    similar: Int32[np.ndarray, "row column k 2"]
    width: int  # of the neighbourhoods, odd

    def run(
        self, canvas: Canvas, domain: Domain, sites: Int32[np.ndarray, "n"], *, passes: int, seed: int, report: Report
    ) -> list[float]:
        """Correct ``sites`` that often; returns the mean squared difference met in each pass."""
        patches = domain.patches(sites, self.width)
        grouped = group_by_site(patches.cover_patch, patches.count)
        site_of_entry = np.repeat(np.arange(domain.count, dtype=np.int32), np.diff(patches.cover_start))
        part = draws.bits(seed, _PART, index=sites) % _SUBPASSES
        energy = []
        for turn in range(passes):
            total = 0.0
            for subpass in range(_SUBPASSES):
                chosen = np.flatnonzero(part == subpass).astype(np.int32)
                total += self._correct(canvas, patches, chosen, grouped, site_of_entry)
            energy.append(total / max(len(sites), 1))
            report("correction", (turn + 1) / passes)
        return energy

    def _correct(
        self,
        canvas: Canvas,
        patches: Patches,
        chosen: Int32[np.ndarray, "patch"],
        grouped: tuple[Int32[np.ndarray, "patches_plus_one"], Int32[np.ndarray, "entry"]],
        site_of_entry: Int32[np.ndarray, "entry"],
    ) -> float:
        """All chosen sites at once, from what the canvas shows now; returns the sum of their costs."""
        samples = np.arange(self.width**2, dtype=np.int32)
        values, known = read(canvas, patches, chosen, samples)
        found, cost = np.empty((len(chosen), 2), np.float32), np.empty(len(chosen), np.float32)
        turn = patches.cover_turn
        launch(
            correct_sites,
            len(chosen),
            inputs=[
                *(chosen, patches.centres, self.width, *grouped, site_of_entry, patches.cover_position),
                np.zeros(1, np.float32) if turn is None else turn,
                *(values, known, canvas.position, canvas.turn, self.image, self.usable, self.similar),
            ],
            outputs=[found, cost],
        )
        straight = np.abs(canvas.turn[patches.centres[chosen]]) < _SKEW
        site = patches.centres[chosen[straight]]
        canvas.position[site] = found[straight]
        texel = np.rint(found[straight]).astype(np.int32)
        canvas.colour[site] = self.image[texel[:, 0], texel[:, 1]]
        return float(cost.sum(dtype=np.float64))


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
