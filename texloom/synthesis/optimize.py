"""Texture optimization (key `optimize`), the default: coherent blocks, then discrete correction where they meet."""

import time
from dataclasses import dataclass, field

import numpy as np

from texloom.domain.domain import Domain
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.progress import Report
from texloom.synthesis.correction import Correction, near_borders
from texloom.synthesis.growth import Grown, Growth, run_on_bare
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.result import Result

_BESIDE = 3  # the most beside what was known: seams are cheapest already, wider neighbourhoods would smooth them over


@dataclass(frozen=True, kw_only=True)
class Optimize:
    """The energy of Chen, Liu & Dong, section 4.3, lowered from a coherent start by discrete steps.

    Departures: the start is laid from blocks of the sample instead of random texels, so whole kinds of content cannot
    get lost; each site takes a texel of the sample instead of a mean of patches, so nothing blurs; only sites near the
    blocks' borders are visited, for inside them the energy is zero. The paper's own method is ``LeastSquares``.
    """

    start: PatchSampling = field(default_factory=PatchSampling)
    width: int = 5  # texels per side of the neighbourhoods compared, odd; 3 at most where a canvas is continued
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
        return run_on_bare(self, exemplar, domain, seed=seed, report=report)

    def grow(self, growth: Growth) -> Grown:
        """Blocks over what is bare, then correction near all borders, those of what was known included."""
        width = min(self.width, _BESIDE) if growth.known.any() else self.width
        laid = self.start.grow(growth)
        clock = [time.perf_counter()]
        correction = Correction.of(growth.exemplar, growth.image, reach=width // 2, alike=self.alike)
        clock.append(time.perf_counter())
        near = near_borders(growth.canvas, growth.domain, self.reach)
        visited = np.flatnonzero(near & growth.writable).astype(np.int32)
        energy = correction.run(
            growth.canvas, growth.domain, visited, passes=self.passes, seed=growth.seed, report=growth.report
        )
        clock.append(time.perf_counter())
        analysis, correcting = np.diff(clock).tolist()
        seconds = laid.seconds | {"analysis": analysis, "correction": correcting}
        return Grown(tuple(energy), seconds, "passes", laid.patches)
