"""Growing texture on a canvas that may hold some already: what fills, fusions and whole results have in common."""

import time
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
from jaxtyping import Bool

from texloom.arrays import Image, in_fours
from texloom.domain.domain import Domain
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.progress import Report, silent
from texloom.sources import SourceMap
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.result import Result


@dataclass(frozen=True, eq=False)
class Grown:
    """How it went: ``energy`` by pass (squared encoded colour units), ``seconds`` by stage, number of patches laid."""

    energy: tuple[float, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict)
    stopped: str = "done"
    patches: int = 0
    curves: dict[str, tuple[float, ...]] = field(default_factory=dict)  # by name, a value a pass


@dataclass(frozen=True, eq=False)
class Growth:
    """What is to be grown, and from what.

    ``image`` is ``in_fours(match_image(exemplar))``, made once where several growths differ in their masks only;
    ``exemplar.mask`` tells the texels that may be used. Sites outside ``sites`` (None: there are none) are never
    written.
    """

    canvas: Canvas
    exemplar: Exemplar
    image: Image
    domain: Domain
    sites: Bool[np.ndarray, "site"] | None = None
    seed: int = 0
    report: Report = silent

    @property
    def writable(self) -> Bool[np.ndarray, "site"]:
        """The sites that may change, written out."""
        return np.ones(self.domain.count, bool) if self.sites is None else self.sites

    @property
    def bare(self) -> Bool[np.ndarray, "site"]:
        """Those of them that show nothing yet."""
        return self.canvas.bare(self.sites)

    @property
    def known(self) -> Bool[np.ndarray, "site"]:
        """All sites that show something."""
        return self.canvas.label >= 0


class Grower(Protocol):
    """A method that can continue what a canvas shows."""

    def grow(self, growth: Growth) -> Grown:
        """Colour every bare site that may change, in place; what is known is matched, and stays.

        Raises: ExemplarError, if the mask is too small for the method.
        """
        ...


def run_on_bare(method: Grower, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
    """The whole domain, from a bare canvas."""
    start = time.perf_counter()
    image = in_fours(match_image(exemplar))
    seconds = {"analysis": time.perf_counter() - start}
    canvas = Canvas.empty(domain.count, image.shape[2])
    grown = method.grow(Growth(canvas, exemplar, image, domain, seed=seed, report=report))
    return result_of(canvas.sources(), replace(grown, seconds=added(seconds, grown.seconds)))


def result_of(sources: SourceMap, grown: Grown) -> Result:
    """What is shown at the end, and how it went."""
    return Result(sources, grown.energy, grown.seconds, grown.stopped, grown.patches, grown.curves)


def added(first: dict[str, float], second: dict[str, float]) -> dict[str, float]:
    """Seconds by stage, stages of the same name added up."""
    return first | {name: first.get(name, 0.0) + value for name, value in second.items()}
