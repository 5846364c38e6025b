"""Texture optimization (key `optimize`), the default: coherent blocks, then discrete correction where they meet."""

import time
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Int32, UInt8

from texloom.arrays import Image, in_fours
from texloom.domain.domain import Domain
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.similarity import most_alike
from texloom.progress import Report
from texloom.search.blocks import BlockSearch
from texloom.synthesis.correction import Correction, near_borders
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.result import Result


@dataclass(frozen=True, kw_only=True)
class Optimize:
    """The energy of Chen, Liu & Dong, section 4.3, lowered from a coherent start by discrete steps.

    Departures: the start is laid from blocks of the sample instead of random texels, so whole kinds of content cannot
    get lost; each site takes a texel of the sample instead of a mean of patches, so nothing blurs; only sites near the
    blocks' borders are visited, for inside them the energy is zero. The paper's own method is ``LeastSquares``.
    """

    start: PatchSampling = field(default_factory=PatchSampling)
    width: int = 5  # texels per side of the neighbourhoods compared, odd
    alike: int = 0  # k of k-coherence: alike texels tried too; 2 lowers the energy by a tenth and doubles the time
    passes: int = 4  # the later ones visit only what changed
    reach: int = 4  # steps from the blocks' borders that are corrected

    def __post_init__(self) -> None:
        if self.width < 3 or self.width % 2 == 0:
            raise ParameterError(f"width {self.width} must be odd and 3 or more")
        if min(self.passes, self.reach, self.alike) < 0:
            raise ParameterError(f"passes {self.passes}, reach {self.reach} and alike {self.alike} must be 0 or more")

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """Cover the domain with blocks, then correct their borders; see ``synthesize``."""
        clock = [time.perf_counter()]
        image = in_fours(match_image(exemplar))
        similar = self._similar(image, exemplar)
        clock.append(time.perf_counter())
        canvas, count, seconds = self.start.lay(exemplar, image, domain, seed=seed, report=report)
        clock.append(time.perf_counter())
        correction = Correction(image, self._usable(image, exemplar), similar, self.width // 2)
        sites = np.flatnonzero(near_borders(canvas, domain, self.reach)).astype(np.int32)
        energy = correction.run(canvas, domain, sites, passes=self.passes, seed=seed, report=report)
        clock.append(time.perf_counter())
        analysis, laying, correcting = np.diff(clock).tolist()
        seconds |= {"analysis": analysis, "blocks": laying - seconds["patches"], "correction": correcting}
        return Result(canvas.sources(), tuple(energy), seconds, "passes", count)

    def _similar(self, image: Image, exemplar: Exemplar) -> Int32[np.ndarray, "row column k 2"]:
        """The k-coherence candidates of every texel; none where k is 0."""
        if self.alike == 0:
            return np.zeros((*image.shape[:2], 0, 2), np.int32)
        return most_alike(image, self.alike, usable=exemplar.mask)

    def _usable(self, image: np.ndarray, exemplar: Exemplar) -> UInt8[np.ndarray, "row column"]:
        """Texels around which a whole neighbourhood, and one texel more for fractions, lies in the exemplar."""
        reach = self.width // 2
        usable = np.zeros(image.shape[:2], np.uint8)
        if min(image.shape[:2]) > self.width:
            inner = BlockSearch(image, self.width + 1, exemplar.mask).usable
            usable[reach : reach + inner.shape[0], reach : reach + inner.shape[1]] = inner
        return usable
