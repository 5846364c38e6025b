"""Whole samples laid over each other where they fit, and grown together where they meet (key `refine-patches`)."""

import time
from dataclasses import dataclass, field, replace

from texloom.domain.domain import Domain
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.scale import dominant_scale
from texloom.progress import Report
from texloom.synthesis.growth import Grower, Grown, Growth, added, run_on_bare
from texloom.synthesis.laying import Laying
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.result import Result

_LEAST = 4  # texels: the narrowest overlap that is cut
_SHARE, _DEEPEST = 1 / 4, 64  # of the sample, and texels: the deepest
_BAND = 1 / 8  # of that depth: how far from the cut the texture is grown anew


@dataclass(frozen=True, kw_only=True)
class RefinePatches:
    """Patches placed by matching, their overlaps synthesized anew: on images without a field.

    After Shin & Shin 2004, section 5, figure 13; the placement is that of Kwatra et al. 2003, section 5. The whole
    sample is laid anywhere, then again and again where it fits what is there; last, ``fill`` grows the texture in
    bands where pieces meet.

    Departures: the paper grows the whole overlap anew, at every step. Here only a band of it is, along the line where
    the two pieces agree best, so that most things stay whole; and all bands are grown at the end, in one go. The
    sample's outermost texels, where things are cut off, are matched but not laid.
    """

    fill: Grower = field(default_factory=Optimize)
    depth: int | None = None  # texels of the overlap where pieces may meet; None: two dominant scales, within reason

    def __post_init__(self) -> None:
        if self.depth is not None and self.depth < _LEAST:
            raise ParameterError(f"depth {self.depth} is too little for pieces to meet: use {_LEAST} texels or more")

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """Cover an image; see ``synthesize``.

        Raises: ParameterError, for a surface, or an image along a field.
        """
        return run_on_bare(self, exemplar, domain, seed=seed, report=report)

    def grow(self, growth: Growth) -> Grown:
        """Pieces over what is bare, then ``fill`` where they meet; see ``Grower``.

        Of known sites among ``sites``, those near pieces are grown anew.
        """
        canvas, lattice = growth.canvas, growth.domain.lattice
        if lattice is None:
            raise ParameterError(
                "refine-patches lays samples along an image's rows and columns, which a mesh or a field has not: "
                "use optimize there"
            )
        start = time.perf_counter()
        depth = self.depth_for(growth.exemplar)
        reach = max(2, round(_BAND * depth))
        laying = Laying(
            canvas, growth.exemplar, growth.image, lattice, growth.sites, depth=depth, reach=reach, seed=growth.seed
        )
        laying.run(growth.report)
        canvas.label[laying.band] = -1
        seconds = {"placement": time.perf_counter() - start}
        grown = self.fill.grow(replace(growth, sites=growth.bare))
        return replace(grown, seconds=added(seconds, grown.seconds), patches=len(laying.pieces))

    def depth_for(self, exemplar: Exemplar) -> int:
        """Texels: as asked, or the window of Shin & Shin, section 3: twice the sample's dominant scale."""
        if self.depth is not None:
            return self.depth
        window = round(2 * dominant_scale(exemplar).scale)
        return max(_LEAST, min(window, int(_SHARE * exemplar.least_side), _DEEPEST))
