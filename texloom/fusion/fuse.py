"""Several samples over one domain, each where its label says, joined without seams (texture fusion).

After Shin & Shin 2004, section 4: regions first, each from its own sample, then belts along their borders. By default
both neighbours are grown through the belt and the least-cost cut decides where each ends (Kwatra et al. 2003), which
keeps things whole and follows their outlines; the paper's belts, filled from a sample cut together of the two, are
kept as ``belts="sample"``.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Literal, get_args

import numpy as np
from jaxtyping import Bool, Float, Int32

from texloom import draws
from texloom.arrays import in_fours
from texloom.domain.domain import Domain
from texloom.domain.steps import within
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.join import Joined, join
from texloom.exemplar.scale import dominant_scale
from texloom.fusion.belt_samples import belt_sample
from texloom.fusion.belts import Belts, lay_belts, pairs_of
from texloom.fusion.borders import cut_border
from texloom.progress import Report, silent
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.growth import Grower, Grown, Growth, added, result_of
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.result import Result

Filling = Literal["cut", "sample"]
BeltMethod = Callable[[float, float], Grower]
"""The method for a belt, from the dominant scales of the two samples beside it, the smaller first."""


@dataclass(frozen=True, eq=False)
class Fused:
    """A fusion: the samples joined, sources that speak of them, and the sample each site shows at last."""

    joined: Joined
    result: Result
    labels: Int32[np.ndarray, "site"]

    @property
    def exemplar(self) -> Exemplar:
        """The samples side by side, as one exemplar."""
        return self.joined.exemplar


def fuse(
    samples: Sequence[Exemplar],
    labels: Int32[np.ndarray, "site"],
    domain: Domain,
    *,
    method: Grower | None = None,
    belts: Filling = "cut",
    belt_method: BeltMethod | None = None,
    scales: Sequence[float] | None = None,
    seed: int = 0,
    report: Report = silent,
) -> Fused:
    """Texture like ``samples[k]`` where ``labels`` is k, over any domain; where labels meet, within a belt's width.

    Maps that not all samples have are dropped. ``scales`` (texels, one a sample) set the width of belts; None: the
    dominant scales. ``belt_method`` fills belts where ``belts`` is "sample"; None: ``method`` does. Growing costs what
    a single sample would, and the belts once more.

    Raises: ParameterError, if labels do not fit the domain and the samples; ExemplarError, if a sample cannot be used
    or no map is common to all.
    """
    labels = np.asarray(labels, np.int32)
    _check(samples, labels, domain, belts)
    clock = time.perf_counter()
    widths = np.array([dominant_scale(sample).scale for sample in samples] if scales is None else scales, np.float64)
    laid = lay_belts(domain, labels, widths)
    growing = _Growing(domain, method or Optimize(), seed, report)
    growing.took("belts", clock)
    if belts == "cut":
        return _by_cuts(samples, laid, growing)
    return _by_samples(samples, laid, growing, belt_method, widths)


class _Growing:
    """Growths on one domain, each from one part of a vocabulary, that count as one run."""

    def __init__(self, domain: Domain, method: Grower, seed: int, report: Report) -> None:
        self.domain, self.method, self.seed, self.report = domain, method, seed, report
        self._all: list[Grown] = []
        self._seconds: dict[str, float] = {}

    def speak(self, joined: Joined) -> None:
        """The vocabulary of the growths that follow."""
        clock = time.perf_counter()
        self.joined, self._image = joined, in_fours(match_image(joined.exemplar))
        self.took("analysis", clock)

    def bare(self) -> Canvas:
        """A canvas without anything."""
        return Canvas.empty(self.domain.count, self._image.shape[2])

    def grow(self, canvas: Canvas, part: int, sites: Bool[np.ndarray, "site"], method: Grower | None = None) -> None:
        """Colour ``sites`` from one part, if there are any."""
        if not sites.any():
            return
        sample, seed = self.joined.within(part), draws.key(self.seed, part)
        grower = method or self.method
        grown = grower.grow(Growth(canvas, sample, self._image, self.domain, sites, seed, self.report))
        self._all.append(grown)
        self._seconds = added(self._seconds, grown.seconds)

    def took(self, stage: str, since: float) -> None:
        """Count the time since then."""
        self._seconds = added(self._seconds, {stage: time.perf_counter() - since})

    def grown(self) -> Grown:
        """How it went in all: the mean energy of each pass, and why the first growth stopped."""
        passes = zip_longest(*(grown.energy for grown in self._all))
        energy = tuple(float(np.mean([e for e in of_pass if e is not None])) for of_pass in passes)
        return Grown(energy, self._seconds, self._all[0].stopped, sum(grown.patches for grown in self._all))


def _by_cuts(samples: Sequence[Exemplar], belts: Belts, growing: _Growing) -> Fused:
    """Every texture through its belts, then a cut for each pair of labels that meet."""
    growing.speak(join(samples))
    layers: list[Canvas] = []
    for label, allowed in enumerate(belts.allowed):
        # One step more than may show, so that both pictures are known at both ends of all edges that may be cut.
        layers.append(growing.bare())
        if (belts.labels == label).any():
            growing.grow(layers[label], label, within(growing.domain, allowed, 1))

    clock = time.perf_counter()
    shown = belts.labels.copy()
    pairs = pairs_of(belts.labels, belts.nearest())
    for number, (one, other) in enumerate(pairs.tolist()):
        cut_border(shown, belts, (one, other), layers, growing.domain)
        growing.report("cut", (number + 1) / len(pairs))
    canvas = growing.bare()
    for label, layer in enumerate(layers):
        _take(canvas, layer, shown == label)
    growing.took("cut", clock)
    return Fused(growing.joined, result_of(canvas.sources(), growing.grown()), shown)


def _by_samples(
    samples: Sequence[Exemplar],
    belts: Belts,
    growing: _Growing,
    belt_method: BeltMethod | None,
    scales: Float[np.ndarray, "sample"],
) -> Fused:
    """Regions without their belts, then each pair's belt from a sample of both; sources are of the originals alone."""
    clock = time.perf_counter()
    count, other = len(samples), belts.nearest()
    pairs = pairs_of(belts.labels, other)
    mixed = [belt_sample(samples[a], samples[b], seed=draws.key(growing.seed, a, b)) for a, b in pairs.tolist()]
    kept = join(samples)
    growing.took("belt samples", clock)

    growing.speak(join([*samples, *(belt.exemplar for belt in mixed)]))
    part = np.where(other < 0, belts.labels, np.int32(-1))  # of the vocabulary, that each site is grown from
    for number, pair in enumerate(pairs):
        part[(np.sort(np.stack([belts.labels, other], 1), 1) == pair).all(1)] = count + number
    canvas = growing.bare()
    for label in range(count):
        layer = growing.bare()
        growing.grow(layer, label, part == label)
        _take(canvas, layer, part == label)
    for number, pair in enumerate(pairs):
        method = None if belt_method is None else belt_method(*np.sort(scales[pair]).tolist())
        growing.grow(canvas, count + number, part == count + number, method)

    # Belt samples are themselves of the originals.
    corner = np.array([(p.row, p.column) for p in growing.joined.parts], np.float32)
    position = canvas.position - corner[part]
    shown = belts.labels.copy()
    for number, pair in enumerate(pairs):
        sites = np.flatnonzero(part == count + number)
        second, position[sites] = mixed[number].origin(position[sites])
        shown[sites] = pair[second.astype(np.int32)]
    canvas.position[:] = position + np.array([(p.row, p.column) for p in kept.parts], np.float32)[shown]
    return Fused(kept, result_of(canvas.sources(), growing.grown()), shown)


def _take(canvas: Canvas, layer: Canvas, sites: Bool[np.ndarray, "site"]) -> None:
    """Show what the layer shows at ``sites``, as patches of its own."""
    first = canvas.next_label
    for ours, theirs in ((canvas.position, layer.position), (canvas.colour, layer.colour), (canvas.turn, layer.turn)):
        ours[sites] = theirs[sites]
    canvas.label[sites] = layer.label[sites] + first


def _check(samples: Sequence[Exemplar], labels: np.ndarray, domain: Domain, belts: str) -> None:
    """Raises: ParameterError, unless every site asks for a sample that there is."""
    if belts not in get_args(Filling):
        raise ParameterError(f"unknown belts {belts!r}: choose {' or '.join(get_args(Filling))}")
    if labels.shape != (domain.count,):
        raise ParameterError(f"{labels.size} labels for {domain.count} sites: give one a site")
    if len(samples) == 1:
        raise ParameterError("a fusion of 1 sample is no fusion: give two samples or more, or synthesize that one")
    if not len(samples) or labels.min() < 0 or labels.max() >= len(samples):
        held = f"labels go from {labels.min()} to {labels.max()}"
        raise ParameterError(f"{held}, but there are {len(samples)} samples: count labels from 0, one a sample")
