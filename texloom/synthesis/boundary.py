"""Patch-based sampling as published: patches matched on their boundary zones, pasted in random order, blended."""

import time
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np
from jaxtyping import Int32

from texloom import draws
from texloom.arrays import in_fours
from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.patches import PatchVectors, boundary_samples
from texloom.progress import Report
from texloom.search.analysis import Analysis
from texloom.search.matching import Index, Search
from texloom.search.principal import PcaNearest
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.layers import feathered
from texloom.synthesis.least_squares import Stage, check_room, fill_unknown, known_or_new
from texloom.synthesis.pasting import Pasting
from texloom.synthesis.reading import read
from texloom.synthesis.result import Result
from texloom.synthesis.schedule import batches, breadth_first, overlaps

Order = Literal["random", "breadth-first"]

_START = 0xB0DA  # purpose of the draws of the first texels
_ORDER = 0xB0DB  # purpose of the draws of the order


@dataclass(frozen=True, eq=False)
class Laid:
    """Patches half their width apart, and the batches in which they are pasted."""

    pasting: Pasting
    groups: list[Int32[np.ndarray, "_"]]

    @property
    def patches(self) -> Patches:
        """The patches themselves."""
        return self.pasting.patches


@dataclass(frozen=True, kw_only=True)
class BoundarySampling:
    """Chen, Liu & Dong, section 5.

    Every site starts with a random texel. Each patch in turn is replaced by the patch of the exemplar whose boundary
    zone is nearest, coarse to fine, so that the untextured part of a boundary is estimated; zones are blended last.
    """

    patch: int = 32  # texels per side
    zone: int = 4  # texels: the boundary's width w_E
    steps: tuple[int, ...] = (4, 2, 1)  # reductions of the levels, coarse to fine
    order: Order = "random"
    search: Search = PcaNearest()
    dimensions: int = 4  # of appearance vectors, beside the feature distance
    analysis: Analysis | None = field(default=None, repr=False, compare=False)
    """What was learnt from the exemplar before; None: learn it."""

    def __post_init__(self) -> None:
        falling = sorted({2 ** int(step).bit_length() // 2 for step in self.steps}, reverse=True)
        if list(self.steps) != falling or self.steps[-1:] != (1,):
            raise ParameterError(f"steps {self.steps} must be falling powers of two that end at 1, as in (4, 2, 1)")
        if self.patch % self.steps[0] or self.patch // self.steps[0] < 4:
            raise ParameterError(f"patch {self.patch} must be a multiple of {self.steps[0]} and 4 times it or more")
        if not 1 <= self.zone <= self.patch // 2:
            raise ParameterError(f"zone {self.zone} must be 1 or more and at most half of patch {self.patch}")
        if self.order not in get_args(Order):
            raise ParameterError(f"unknown order {self.order!r}: choose one of {', '.join(get_args(Order))}")

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """All levels in turn; see ``synthesize``."""
        clock = [time.perf_counter()]
        analysis = self.analyse(exemplar)
        clock.append(time.perf_counter())
        laid = self.lay(domain, seed)
        clock.append(time.perf_counter())
        result = self.solve(analysis, domain, laid, seed=seed, report=report)
        clock.append(time.perf_counter())
        seconds: dict[str, float] = dict(zip(("analysis", "patches", "sampling"), np.diff(clock).tolist(), strict=True))
        return Result(result.sources, (), seconds, "done", result.patches)

    def analyse(self, exemplar: Exemplar) -> Analysis:
        """Everything learnt from the exemplar; it can be saved and used again."""
        check_room(exemplar, [Stage(step, self.patch // step) for step in self.steps])
        levels = max(self.steps).bit_length()
        analysis = known_or_new(self.analysis, exemplar, levels=levels, dimensions=self.dimensions)
        for step in self.steps:
            self._index(analysis, step)
        return analysis

    def lay(self, domain: Domain, seed: int) -> Laid:
        """The patches and their order."""
        patches = domain.patches(domain.centres(self.patch / 2, seed), self.patch)
        shared = overlaps(patches)
        order = breadth_first(shared, seed) if self.order == "breadth-first" else None
        if order is None:
            order = draws.permutation(seed, _ORDER, count=patches.count).astype(np.int32)
        return Laid(Pasting.of(patches), batches(order, shared))

    def solve(self, analysis: Analysis, domain: Domain, laid: Laid, *, seed: int, report: Report) -> Result:
        """The synthesis alone, on patches already laid and an exemplar already analysed."""
        patches = laid.patches
        anchors = np.zeros((patches.count, 2), np.int32)
        canvas = Canvas.empty(domain.count, in_fours(analysis.appearance[0]).shape[2])
        canvas.label[:] = 0
        for number, step in enumerate(self.steps):
            level = step.bit_length() - 1
            appearance = in_fours(analysis.appearance[level])
            shape = np.array(appearance.shape[:2])
            if number == 0:
                chance = np.stack([draws.uniform(seed, _START, i, index=np.arange(domain.count)) for i in (0, 1)], 1)
                texel = (chance * shape).astype(np.int32)
            else:
                canvas.position[:] *= self.steps[number - 1] / step
                texel = np.clip(np.rint(canvas.position).astype(np.int32), 0, shape - 1)
            canvas.colour[:] = appearance[texel[:, 0], texel[:, 1]]
            self._lay_level(analysis, laid, canvas, appearance, anchors, step)
            report("sampling", (number + 1) / len(self.steps))
        rank = np.empty(patches.count, np.int32)
        rank[np.concatenate(laid.groups)] = np.arange(patches.count, dtype=np.int32)
        return Result(
            feathered(domain, patches, anchors, rank, self.zone, analysis.appearance[0].shape[:2]),
            patches=patches.count,
        )

    def _lay_level(self, analysis: Analysis, laid: Laid, canvas: Canvas, appearance, anchors, step: int) -> None:
        """Match and paste every batch on one level."""
        vectors, index = self._index(analysis, step)
        samples = self._samples(step) @ np.array([self.patch, 1], np.int32) * np.int32(step)
        channels = analysis.appearance[0].shape[2]
        for chosen in laid.groups:
            values, known = read(canvas, laid.patches, chosen, samples)
            queries = fill_unknown(values[..., :channels], known).reshape(len(chosen), -1)
            anchors[chosen] = vectors.anchors[index.nearest(queries).index]
            own = laid.pasting.own(chosen)
            laid.pasting.paste(canvas, appearance, chosen, anchors[chosen], own, scale=1.0 / step)

    def _samples(self, step: int) -> Int32[np.ndarray, "sample 2"]:
        """The boundary zone of a level's patches, in texels of that level."""
        return boundary_samples(self.patch // step, max(1, self.zone // step))

    def _index(self, analysis: Analysis, step: int) -> tuple[PatchVectors, Index]:
        return analysis.index(self.search, step.bit_length() - 1, self.patch // step, self._samples(step))
