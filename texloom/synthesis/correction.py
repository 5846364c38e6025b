"""Order-independent correction: where blocks meet, every site takes the texel that fits its surroundings.

After Lefebvre & Hoppe 2005 (§3.3), with the candidates of Ashikhmin 2001 and Tong et al. 2002. Inside a coherent block
every candidate is the block itself, so only sites near its border are visited.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np
from jaxtyping import Bool, Int32, UInt8

from texloom import draws
from texloom.arrays import Image
from texloom.domain.domain import Domain
from texloom.domain.neighbourhoods import as_stencils
from texloom.domain.steps import within
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.similarity import most_alike
from texloom.progress import Report
from texloom.search.blocks import BlockSearch, readable
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.visits import Guide, Visits

_SUBPASSES = 4  # a random quarter of the sites at a time, so that most see their neighbours corrected
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
        return Correction(image, usable_centres(image, exemplar, reach), similar, reach)

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
        around = domain.neighbourhoods(sites, self.reach)
        visits = Visits(Guide(self.image, self.usable, self.similar), canvas, around, as_stencils(around))
        part = draws.bits(seed, _PART, index=sites) % _SUBPASSES
        while True:
            for subpass in range(_SUBPASSES):
                visits.at_once(np.flatnonzero(part == subpass).astype(np.int32))
            yield visits.mean_cost


def usable_centres(image: Image, exemplar: Exemplar, reach: int) -> UInt8[np.ndarray, "row column"]:
    """1 at texels around which a whole neighbourhood, and one texel more for fractions, lies in the exemplar."""
    width = 2 * reach + 1
    usable = np.zeros(image.shape[:2], np.uint8)
    if min(image.shape[:2]) > width:
        seen = readable(exemplar.mask)
        if exemplar.parts and seen is not None:  # on coarse levels the gap between samples is as narrow as a scratch
            inside = np.zeros(image.shape[:2], bool)
            for part in exemplar.parts:
                inside[part.slices] = True
            seen &= inside
        inner = BlockSearch(image, width + 1, seen).usable
        usable[reach : reach + inner.shape[0], reach : reach + inner.shape[1]] = inner
    return usable if exemplar.mask is None else usable * exemplar.mask


def near_borders(canvas: Canvas, domain: Domain, reach: int) -> Bool[np.ndarray, "site"]:
    """Sites within ``reach`` steps of a place where neighbouring sites came with different patches."""
    first, second = domain.edges.T
    apart = canvas.label[first] != canvas.label[second]
    near = np.zeros(domain.count, bool)
    near[first[apart]] = near[second[apart]] = True
    return within(domain, near, reach)
