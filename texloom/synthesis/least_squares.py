"""Texture optimization as published: nearest patches and least squares by turns, coarse to fine."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float32, Int32

from texloom import draws
from texloom.arrays import fours, in_fours
from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.patches import PatchVectors, even_samples
from texloom.kernels.averaging import average_patches
from texloom.kernels.launch import launch
from texloom.progress import Report
from texloom.search.analysis import Analysis, analyse, fingerprint
from texloom.search.matching import Index, Search
from texloom.search.principal import PcaNearest
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.layers import heaviest
from texloom.synthesis.reading import read
from texloom.synthesis.result import Result

_START = 0x57A7  # purpose of the draws of the first anchors
_ROBUST = -0.4  # power of the squared mismatch: |X - Z|^-0.8


@dataclass(frozen=True)
class Stage:
    """Patches of ``width × width`` texels of the level reduced ``step`` times (1, 2, 4, ...)."""

    step: int
    width: int

    def __post_init__(self) -> None:
        if self.step < 1 or self.step & (self.step - 1) or self.width < 1:
            raise ParameterError(
                f"a stage of step {self.step}, width {self.width}: use step 1, 2, 4, ... and width 1 or more"
            )

    @property
    def extent(self) -> int:
        """Texels of the finest level a patch spans."""
        return self.step * self.width


def stages(largest: int = 32) -> tuple[Stage, ...]:
    """The schedule of section 4.4: ¼:8, ½:16, ½:8, 1:32, 1:16, 1:8 for the paper's 32; 40 serves large structure."""
    if largest % 4 or largest < 8:
        raise ParameterError(f"the largest patch is {largest} texels, but must be a multiple of 4, 8 or more")
    half, quarter = largest // 2, largest // 4
    return (
        *(Stage(4, quarter), Stage(2, half), Stage(2, quarter)),
        *(Stage(1, largest), Stage(1, half), Stage(1, quarter)),
    )


@dataclass(frozen=True, kw_only=True)
class LeastSquares:
    """Chen, Liu & Dong, section 4.

    E-step: every site takes the weighted mean of the patches over it, weights |X_p - Z_p|^-0.8. M-step: every patch
    takes its nearest in the exemplar, in appearance space, on ``samples × samples`` representative texels.

    Departures: a site keeps its four heaviest patches instead of all sixteen, which blurs less.
    """

    schedule: tuple[Stage, ...] = stages()
    iterations: int = 10  # at most, a stage
    search: Search = PcaNearest()
    samples: int = 8
    dimensions: int = 4  # of appearance vectors, beside the feature distance
    analysis: Analysis | None = field(default=None, repr=False, compare=False)
    """What was learnt from the exemplar before; None: learn it."""

    def __post_init__(self) -> None:
        if not self.schedule:
            raise ParameterError("an empty schedule has nothing to do: give one stage or more")
        if self.iterations < 1 or self.samples < 1:
            raise ParameterError(f"iterations {self.iterations} and samples {self.samples} must be 1 or more")

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """All stages in turn; see ``synthesize``."""
        clock = time.perf_counter()
        analysis = self.analyse(exemplar)
        seconds = {"analysis": time.perf_counter() - clock}
        clock = time.perf_counter()
        laid = {extent: lay(domain, extent, seed) for extent in sorted({stage.extent for stage in self.schedule})}
        seconds["patches"] = time.perf_counter() - clock
        clock = time.perf_counter()
        result = self.solve(analysis, domain, laid, seed=seed, report=report)
        return Result(
            result.sources,
            result.energy,
            seconds | {"optimization": time.perf_counter() - clock},
            result.stopped,
            result.patches,
        )

    def analyse(self, exemplar: Exemplar) -> Analysis:
        """Everything learnt from the exemplar, indices of all stages included; it can be saved and used again."""
        check_room(exemplar, self.schedule)
        levels = max(stage.step for stage in self.schedule).bit_length()
        analysis = known_or_new(self.analysis, exemplar, levels=levels, dimensions=self.dimensions)
        for stage in self.schedule:
            self._index(analysis, stage)
        return analysis

    def solve(
        self, analysis: Analysis, domain: Domain, laid: dict[int, Patches], *, seed: int, report: Report
    ) -> Result:
        """The synthesis alone, on patches already laid (by extent) and an exemplar already analysed."""
        canvas = Canvas.empty(domain.count, in_fours(analysis.appearance[0]).shape[2])
        fits = [self._fit(analysis, laid[stage.extent], stage) for stage in self.schedule]
        found, weight = fits[0].chance(seed)
        energy: list[float] = []
        stopped = "iterations"
        for number, fit in enumerate(fits):
            if number > 0:
                found, weight, _ = fit.maximize(canvas)
            fit.mark_covered(canvas)
            stopped = "iterations"
            for iteration in range(self.iterations):
                fit.expect(canvas, found, weight)
                before = found
                found, weight, cost = fit.maximize(canvas)
                energy.append(cost / len(fit.samples))
                report("optimization", (number + (iteration + 1) / self.iterations) / len(fits))
                if np.array_equal(found, before):
                    stopped = "converged"
                    break
        last = fits[-1]
        anchors = last.anchors(found) * np.int32(last.step)
        sources = heaviest(domain, last.patches, anchors, weight, analysis.appearance[0].shape[:2])
        return Result(sources, tuple(energy), {}, stopped, sum(fit.patches.count for fit in fits))

    def _fit(self, analysis: Analysis, patches: Patches, stage: Stage) -> "_Fit":
        vectors, index = self._index(analysis, stage)
        samples = np.ascontiguousarray(self._samples(stage) @ [stage.extent, 1] * stage.step, dtype=np.int32)
        return _Fit(stage.step, patches, vectors, index, samples, analysis)

    def _samples(self, stage: Stage) -> Int32[np.ndarray, "sample 2"]:
        """Representative texels of a stage's patches [row, column], in texels of its level."""
        return even_samples(stage.width, min(self.samples, stage.width))

    def _index(self, analysis: Analysis, stage: Stage) -> tuple[PatchVectors, Index]:
        return analysis.index(self.search, stage.step.bit_length() - 1, stage.width, self._samples(stage))


@dataclass(frozen=True, eq=False)
class _Fit:
    """What a stage works on: the domain's patches and their samples, the exemplar's and the search among them."""

    step: int
    patches: Patches
    vectors: PatchVectors
    index: Index
    samples: Int32[np.ndarray, "sample"]
    analysis: Analysis

    def chance(self, seed: int) -> tuple[Int32[np.ndarray, "patch"], Float32[np.ndarray, "patch"]]:
        """Random patches of the exemplar, all of one weight: where algorithm 1 begins."""
        choice = draws.uniform(seed, _START, index=np.arange(self.patches.count)) * len(self.vectors.anchors)
        return choice.astype(np.int32), np.ones(self.patches.count, np.float32)

    def mark_covered(self, canvas: Canvas) -> None:
        """Sites that no patch of this stage covers are unknown to it."""
        canvas.label[:] = np.where(np.diff(self.patches.cover_start) > 0, 0, -1)

    def anchors(self, found: Int32[np.ndarray, "patch"]) -> Int32[np.ndarray, "patch 2"]:
        """Where the patches found lie in the exemplar's level."""
        return np.ascontiguousarray(self.vectors.anchors[found])

    def expect(self, canvas: Canvas, found: Int32[np.ndarray, "patch"], weight: Float32[np.ndarray, "patch"]) -> None:
        """The E-step on the stage's level."""
        appearance = in_fours(self.analysis.appearance[self.step.bit_length() - 1])
        _expect(canvas, self.patches, self.anchors(found), weight, appearance, self.step)

    def maximize(self, canvas: Canvas) -> tuple[Int32[np.ndarray, "patch"], Float32[np.ndarray, "patch"], float]:
        """The M-step on the stage's samples."""
        return _maximize(canvas, self.patches, self.samples, self.index, self.analysis)


def known_or_new(known: Analysis | None, exemplar: Exemplar, *, levels: int, dimensions: int) -> Analysis:
    """The analysis known before, or a new one.

    Raises: ExemplarError, if it is of other pixels; ParameterError, if it has fewer levels or other dimensions.
    """
    if known is None:
        return analyse(exemplar, levels=levels, dimensions=dimensions)
    if known.fingerprint != fingerprint(exemplar):
        raise ExemplarError("the analysis is of other pixels than this exemplar's: analyse it again")
    held = known.appearance[0].shape[2] - 1
    if len(known.levels) < levels or held != dimensions:
        raise ParameterError(
            f"the analysis has {len(known.levels)} levels of {held} dimensions, but this method needs {levels} of "
            f"{dimensions}: analyse the exemplar with this method"
        )
    return known


def check_room(exemplar: Exemplar, schedule: Sequence[Stage]) -> None:
    """Raises: ExemplarError, unless the patches of all stages fit into the exemplar's levels."""
    side = exemplar.least_side
    for stage in schedule:
        if -(-side // stage.step) < stage.width:
            raise ExemplarError(
                f"{_room(exemplar)}, but a patch needs {stage.extent}x{stage.extent}: "
                "use smaller patches or a larger sample"
            )


def _room(exemplar: Exemplar) -> str:
    """What there is to use, in words."""
    if exemplar.parts:
        return f"the smallest of {len(exemplar.parts)} samples is {exemplar.least_side} texels across where it is used"
    size = f"{exemplar.shape[1]}x{exemplar.shape[0]} texels"
    if exemplar.least_side < min(exemplar.shape):
        return f"the exemplar is {size}, {exemplar.least_side} across where its mask allows"
    return f"the exemplar is {size}"


def lay(domain: Domain, extent: int, seed: int) -> Patches:
    """Patches a quarter of their extent apart (section 4.2), sixteen over each site."""
    return domain.patches(domain.centres(max(extent / 4, 1.0), seed), extent)


def _expect(
    canvas: Canvas,
    patches: Patches,
    anchors: Int32[np.ndarray, "patch 2"],
    weight: Float32[np.ndarray, "patch"],
    appearance: Float32[np.ndarray, "row column channel"],
    step: int,
) -> None:
    """The E-step: weighted means."""
    launch(
        average_patches,
        len(canvas.colour),
        inputs=[
            *(patches.cover_start, patches.cover_patch, patches.cover_position),
            *(anchors, weight, 1.0 / step, fours(appearance)),
        ],
        outputs=[fours(canvas.colour)],
    )


def _maximize(
    canvas: Canvas, patches: Patches, samples: Int32[np.ndarray, "sample"], index: Index, analysis: Analysis
) -> tuple[Int32[np.ndarray, "patch"], Float32[np.ndarray, "patch"], float]:
    """The M-step: the nearest patch of each, its weight for the next E-step, and the mean mismatch."""
    channels = analysis.appearance[0].shape[2]
    values, known = read(canvas, patches, np.arange(patches.count, dtype=np.int32), samples)
    queries = fill_unknown(values[..., :channels], known).reshape(patches.count, -1)
    match = index.nearest(queries)
    weight = np.maximum(match.cost, 1e-6) ** np.float32(_ROBUST)
    return match.index, weight.astype(np.float32), float(match.cost.mean(dtype=np.float64))


def fill_unknown(
    values: Float32[np.ndarray, "patch sample channel"], known: Float32[np.ndarray, "patch sample"]
) -> Float32[np.ndarray, "patch sample channel"]:
    """Samples out of reach take the mean of the patch's others, where they pull the match nowhere in particular."""
    values = np.ascontiguousarray(values)
    if known.all():
        return values
    mean = values.sum(1, keepdims=True) / np.maximum(known.sum(1), 1)[:, None, None]
    return np.where(known[:, :, None] > 0, values, mean).astype(np.float32)
