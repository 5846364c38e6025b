"""Pixel-based synthesis in sweeps over a hierarchy of points (key ``sweep``), after Turk's talk of 2001."""

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from jaxtyping import Int32

from texloom import draws
from texloom.arrays import Image, in_fours
from texloom.domain.domain import Domain
from texloom.domain.levels import lay_levels
from texloom.domain.neighbourhoods import Stencils
from texloom.domain.order import colour_parts, sweep_order
from texloom.domain.surface import Surface
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import LEAST_SIDE, Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.patches import whole_squares
from texloom.exemplar.pyramid import gaussian_pyramid, stack_pyramid
from texloom.exemplar.similarity import most_alike
from texloom.progress import Report
from texloom.search.window_tree import WindowTree
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.correction import usable_centres
from texloom.synthesis.growth import Growth
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.result import Result
from texloom.synthesis.visits import Guide, Visits

Start = Literal["blocks", "random"]
Shape = Literal["full", "causal", "half"]
SweepOrder = Literal["parallel", "sequential"]
SweepSearch = Literal["coherence", "tree"]

_RANDOM = 0x5E  # purpose of the draws of the random copy
_LEAST = 3  # windows across the coarsest sample: less has no texture left
_DIMENSIONS = 8  # of the tree


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """Sites on a hierarchy of even points take the texel whose neighbourhood fits theirs best, level after level.

    The coarsest level begins with blocks of the sample, or as in the talk with a random copy that is then swept along
    the field, each neighbourhood as ``shape`` says ("half" is also the far half of the site's own front). Finer levels
    continue the sources of the coarser and sweep full neighbourhoods again. ``search`` "coherence" tries what the
    neighbours continue and ``alike`` texels like the site's own; "tree" also the nearest of all windows in their first
    principal components, as the first sweep of a random copy always does.

    ``order`` "sequential" visits one site after the other along the field. "parallel" visits at once all sites of one
    of about seven colours, no two of them neighbours; a random copy begins with one sequential sweep.

    Departures from the talk: sources are carried to the finer level instead of colours, and may lie between texels, so
    that what coheres stays sharp.
    """

    levels: int = 3  # fewer where the sample or the surface is small
    window: int = 7  # texels a side of a neighbourhood, odd
    start: Start = "blocks"
    shape: Shape = "half"
    order: SweepOrder = "parallel"
    search: SweepSearch = "coherence"
    alike: int = 2  # k of k-coherence
    passes: int = 2  # sweeps of each level

    def __post_init__(self) -> None:
        for what, name, names in (
            ("start", self.start, get_args(Start)),
            ("shape", self.shape, get_args(Shape)),
            ("order", self.order, get_args(SweepOrder)),
            ("search", self.search, get_args(SweepSearch)),
        ):
            if name not in names:
                raise ParameterError(f"unknown {what} {name!r}: choose {', '.join(names[:-1])} or {names[-1]}")
        if self.window < 3 or self.window % 2 == 0:
            raise ParameterError(f"window {self.window} must be odd and 3 or more")
        if min(self.levels, self.passes) < 1 or self.alike < 0:
            raise ParameterError(
                f"levels {self.levels} and passes {self.passes} must be 1 or more, alike {self.alike} 0 or more"
            )

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """Cover the domain, level by level; see ``synthesize``.

        Raises: ParameterError, if the domain is no surface; ExemplarError, if the sample holds no neighbourhood.
        """
        if not isinstance(domain, Surface):
            raise ParameterError("sweeps go over the points of a mesh: choose another method for images")
        return _Run(self, exemplar, domain, seed, report).run()


@dataclass(frozen=True, eq=False)
class _Run:
    """One synthesis, step by step."""

    method: Sweep
    exemplar: Exemplar
    domain: Surface
    seed: int
    report: Report

    def run(self) -> Result:
        """All levels, and home."""
        clock = _Clock()
        image = in_fours(match_image(self.exemplar))
        count = self._fitting()
        levels = lay_levels(self.domain, count, seed=self.seed, report=self.report)
        clock.lap("points")
        count = len(levels.domains)
        images = gaussian_pyramid(image, count, usable=self.exemplar.mask)[::-1]
        stacks = stack_pyramid(self.exemplar, count)[::-1]
        clock.lap("analysis")
        canvas, energy = Canvas.empty(0, image.shape[2]), list[float]()
        for number, (surface, stack, level) in enumerate(zip(levels.domains, stacks, images, strict=True)):
            if number == 0:
                canvas = self._begin(surface, stack, level.image)
                clock.lap("start")
            else:
                canvas = canvas.continued(levels.onto[number - 1], level.image, 2.0, stack.mask)
            bare = number == 0 and self.method.start == "random"
            for left in self._sweeps(surface, stack, level.image, canvas, clock, bare=bare):
                energy.append(left)
                self.report("sweeps", len(energy) / (self.method.passes * count))
        canvas = canvas.continued(levels.onto[-1], image, 1.0, self.exemplar.mask)
        clock.lap("sweeps")
        return Result(canvas.sources(), tuple(energy), clock.seconds, "passes")

    def _fitting(self) -> int:
        """As many levels as asked, or as the sample and its mask have room for neighbourhoods and blocks on."""
        least, window = self.exemplar.least_side, self.method.window
        for count in range(self.method.levels, 0, -1):
            step = 2 ** (count - 1)
            roomy = count == 1 or least >= _LEAST * window * step
            if roomy and whole_squares(self.exemplar.usable[::step, ::step], max(window + 1, LEAST_SIDE)).any():
                return count
        raise ExemplarError(
            f"the sample is {least} texels across where it is used, and holds no whole neighbourhood of {window}: "
            "use a larger sample or mask, or a smaller window"
        )

    def _begin(self, surface: Surface, stack: Exemplar, image: Image) -> Canvas:
        """Blocks of the sample, or its texels at random."""
        canvas = Canvas.empty(surface.count, image.shape[2])
        if self.method.start == "blocks":
            PatchSampling().grow(Growth(canvas, stack, image, surface, seed=self.seed, report=self.report))
        else:
            centre = np.argwhere(usable_centres(image, stack, self.method.window // 2))
            drawn = draws.bits(self.seed, _RANDOM, index=np.arange(surface.count)) % np.uint32(len(centre))
            canvas.position[:] = centre[drawn]
            canvas.colour[:] = image[centre[drawn, 0], centre[drawn, 1]]
        canvas.label[:] = 0
        return canvas

    def _sweeps(
        self, surface: Surface, stack: Exemplar, image: Image, canvas: Canvas, clock: "_Clock", *, bare: bool
    ) -> Iterator[float]:
        """The mean squared difference that each sweep of a level leaves; ``bare`` sites show what is random yet."""
        method = self.method
        stencils = surface.stencils(method.window)
        around = surface.neighbourhoods(np.arange(surface.count, dtype=np.int32), 1)
        clock.lap("stencils")
        sequential = method.order == "sequential"
        order = sweep_order(surface) if sequential or bare else np.empty(0, np.int32)
        parts = [] if sequential else colour_parts(surface)
        clock.lap("order")
        usable = usable_centres(image, stack, method.window // 2)
        similar = np.zeros((*image.shape[:2], 0, 2), np.int32)
        if method.alike:
            similar = most_alike(image, method.alike, usable=stack.mask)
        guide = Guide(image, usable, similar)
        clock.lap("analysis")
        if bare:
            samples = in_shape(stencils, method.shape)
            tree = WindowTree.of(image, usable, stencils.offset[0, samples].astype(np.int32), _DIMENSIONS)
            visits = Visits(replace(guide, tree=tree), canvas, around, stencils, samples)
            visits.in_order(order)
            yield visits.mean_cost
        if method.search == "tree":
            guide = replace(guide, tree=WindowTree.of(image, usable, stencils.offset[0].astype(np.int32), _DIMENSIONS))
        visits = Visits(guide, canvas, around, stencils)
        for _ in range(method.passes - bare):
            if sequential:
                visits.in_order(order)
            for part in parts:
                visits.at_once(part)
            yield visits.mean_cost
        clock.lap("sweeps")


def in_shape(stencils: Stencils, shape: Shape) -> Int32[np.ndarray, "sample"]:
    """The samples of a neighbourhood that count, where the sweep comes along the columns.

    "full" is all of them; "causal" what a scan has visited already, after Wei & Levoy: the columns behind and, of the
    own one, the rows above; "half" the columns behind and the whole of the own one but for the middle.
    """
    row, column = stencils.offset[0].T
    chosen = np.ones(len(row), bool)
    if shape != "full":
        own = (column == 0) & (row < 0 if shape == "causal" else row != 0)
        chosen = (column < 0) | own
    return np.flatnonzero(chosen).astype(np.int32)


class _Clock:
    """Seconds by stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, stage: str) -> None:
        """What passed since the last lap belongs to this stage."""
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self._last
        self._last = now
