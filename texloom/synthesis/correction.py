"""Order-independent correction: where blocks meet, every site takes the texel that fits its surroundings.

After Lefebvre & Hoppe 2005 (§3.3), with the candidates of Ashikhmin 2001 and Tong et al. 2002. Inside a coherent block
every candidate is the block itself, so only sites near its border are visited.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count, islice

import numpy as np
from jaxtyping import Bool, Float32, Int32, UInt8

from texloom import draws
from texloom.arrays import Image, fours
from texloom.domain.domain import Domain
from texloom.domain.neighbourhoods import Neighbourhoods
from texloom.domain.steps import within
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.similarity import most_alike
from texloom.kernels.correction import correct_sites
from texloom.kernels.launch import launch
from texloom.progress import Report
from texloom.search.blocks import BlockSearch, readable
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

    @staticmethod
    def of(exemplar: Exemplar, image: Image, *, reach: int, alike: int = 0) -> "Correction":
        """Candidates are the texels around which a whole neighbourhood lies in the exemplar.

        ``alike`` is the k of k-coherence: so many texels like the pixel's own are tried too.
        """
        similar = np.zeros((*image.shape[:2], 0, 2), np.int32)
        if alike:
            similar = most_alike(image, alike, usable=exemplar.mask)
        return Correction(image, _usable(image, exemplar, reach), similar, reach)

    def run(
        self, canvas: Canvas, domain: Domain, sites: Int32[np.ndarray, "n"], *, passes: int, seed: int, report: Report
    ) -> list[float]:
        """Correct ``sites`` that often; returns the mean squared difference that each pass leaves."""
        energy = []
        for left in islice(self.passes(canvas, domain, sites, seed=seed), passes):
            energy.append(left)
            report("correction", len(energy) / passes)
        return energy

    def passes(self, canvas: Canvas, domain: Domain, sites: Int32[np.ndarray, "n"], *, seed: int) -> Iterator[float]:
        """Correct ``sites`` once for each value asked for: the mean squared difference that is left.

        Bare sites are no part of any neighbourhood.
        """
        around = _coloured(domain.neighbourhoods(sites, self.reach), canvas)
        visits = _Visits(np.zeros(domain.count, np.int32), np.zeros(len(sites), np.int32))
        cost = np.zeros(len(sites), np.float32)
        part = draws.bits(seed, _PART, index=sites) % _SUBPASSES
        for turn in count():
            for subpass in range(_SUBPASSES):
                chosen = np.flatnonzero(part == subpass).astype(np.int32)
                self._correct(canvas, around, visits, chosen, cost, now=1 + turn * _SUBPASSES + subpass)
            yield float(cost.mean(dtype=np.float64)) if len(sites) else 0.0

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


def _coloured(around: Neighbourhoods, canvas: Canvas) -> Neighbourhoods:
    """The same neighbourhoods without sites that show nothing."""
    if not canvas.bare().any():
        return around
    return replace(around, sites=np.where(canvas.label[around.sites] >= 0, around.sites, np.int32(-1)))


def _usable(image: Image, exemplar: Exemplar, reach: int) -> UInt8[np.ndarray, "row column"]:
    """Texels around which a whole neighbourhood, and one texel more for fractions, lies in the exemplar."""
    width = 2 * reach + 1
    usable = np.zeros(image.shape[:2], np.uint8)
    if min(image.shape[:2]) > width:
        inner = BlockSearch(image, width + 1, readable(exemplar.mask)).usable
        usable[reach : reach + inner.shape[0], reach : reach + inner.shape[1]] = inner
    return usable if exemplar.mask is None else usable * exemplar.mask


def near_borders(canvas: Canvas, domain: Domain, reach: int) -> Bool[np.ndarray, "site"]:
    """Sites within ``reach`` steps of a place where neighbouring sites came with different patches."""
    first, second = domain.edges.T
    apart = canvas.label[first] != canvas.label[second]
    near = np.zeros(domain.count, bool)
    near[first[apart]] = near[second[apart]] = True
    return within(domain, near, reach)
