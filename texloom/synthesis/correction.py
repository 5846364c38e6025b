"""Order-independent correction: where blocks meet, every site takes the texel that fits its surroundings.

After Lefebvre & Hoppe 2005 (§3.3), with the candidates of Ashikhmin 2001 and Tong et al. 2002. Inside a coherent block
every candidate is the block itself, so only sites near its border are visited.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int32, UInt8

from texloom import draws
from texloom.arrays import Image, fours
from texloom.domain.domain import Domain
from texloom.domain.neighbourhoods import Neighbourhoods
from texloom.kernels.correction import correct_sites
from texloom.kernels.launch import launch
from texloom.progress import Report
from texloom.synthesis.canvas import Canvas

_SUBPASSES = 4  # a random quarter of the sites at a time, so that most see their neighbours corrected
_CANDIDATES = 12  # distinct ones compared at most; near a border there are two to eight
_PART = 0xC0  # purpose of the draws that part the sites


@dataclass(frozen=True, eq=False)
class Correction:
    """What correction compares with: the exemplar, where whole neighbourhoods fit in it, and its most alike texels."""

    image: Image  # channels a multiple of four
    usable: UInt8[np.ndarray, "row column"]  # 1 where a neighbourhood may be centred
    similar: Int32[np.ndarray, "row column k 2"]
    reach: int  # texels: neighbourhoods are 2 reach + 1 wide

    def run(
        self, canvas: Canvas, domain: Domain, sites: Int32[np.ndarray, "n"], *, passes: int, seed: int, report: Report
    ) -> list[float]:
        """Correct ``sites`` that often; returns the mean squared difference that each pass leaves."""
        around = domain.neighbourhoods(sites, self.reach)
        visits = _Visits(np.zeros(domain.count, np.int32), np.zeros(len(sites), np.int32))
        cost = np.zeros(len(sites), np.float32)
        part = draws.bits(seed, _PART, index=sites) % _SUBPASSES
        energy = []
        for turn in range(passes):
            for subpass in range(_SUBPASSES):
                chosen = np.flatnonzero(part == subpass).astype(np.int32)
                self._correct(canvas, around, visits, chosen, cost, now=1 + turn * _SUBPASSES + subpass)
            energy.append(float(cost.mean(dtype=np.float64)) if len(sites) else 0.0)
            report("correction", (turn + 1) / passes)
        return energy

    def _correct(
        self,
        canvas: Canvas,
        around: Neighbourhoods,
        visits: "_Visits",
        chosen: Int32[np.ndarray, "chosen"],
        cost: Float32[np.ndarray, "n"],
        *,
        now: int,
    ) -> None:
        """All chosen neighbourhoods at once, from what the canvas shows now."""
        found = np.empty((len(chosen), 3), np.float32)
        tried = np.empty((len(chosen), _CANDIDATES, 3), np.float32)
        launch(
            correct_sites,
            len(chosen),
            inputs=[
                *(chosen, around.sites, around.offset),
                np.zeros((1, 1), np.float32) if around.turn is None else around.turn,
                *(canvas.position, canvas.turn, fours(canvas.colour), canvas.label, visits.changed, visits.visited),
                *(fours(self.image), self.usable, self.similar),
            ],
            outputs=[tried, found, cost],
            grain=1024,
        )
        visits.visited[chosen] = now
        site = around.sites[chosen, 0]
        moved = (canvas.position[site] != found[:, :2]).any(1) | (canvas.turn[site] != found[:, 2])
        site, found = site[moved], found[moved]
        visits.changed[site] = now
        canvas.position[site], canvas.turn[site] = found[:, :2], found[:, 2]
        texel = np.clip(np.rint(found[:, :2]).astype(np.int32), 0, np.array(self.image.shape[:2]) - 1)
        canvas.colour[site] = self.image[texel[:, 0], texel[:, 1]]


@dataclass(frozen=True, eq=False)
class _Visits:
    """The subpass in which each site last changed, and in which each neighbourhood was last corrected."""

    changed: Int32[np.ndarray, "site"]
    visited: Int32[np.ndarray, "n"]


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
