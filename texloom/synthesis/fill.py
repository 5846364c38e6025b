"""Holes in a picture filled with more of what is around them, or with another sample."""

import time
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Int32

from texloom.arrays import Image, in_fours
from texloom.domain.grid import Grid
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import LEAST_SIDE, Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.join import join
from texloom.progress import Report, silent
from texloom.search.blocks import BlockSearch, readable
from texloom.sources import SourceMap
from texloom.synthesis.canvas import Canvas, nearest_usable
from texloom.synthesis.growth import Grower, Growth, added, result_of
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.result import Result

_MARGIN = 128  # texels around a hole that are looked at, or as many as it is wide


@dataclass(frozen=True, eq=False)
class Filled:
    """A filled picture: ``result.sources`` speak of ``exemplar``; outside the hole every texel is its own source.

    ``texloom.output.filled`` gives its maps.
    """

    picture: Exemplar
    hole: Bool[np.ndarray, "row column"]
    exemplar: Exemplar  # the picture itself, or the picture beside the sample
    result: Result


def fill(
    picture: Exemplar,
    hole: Bool[np.ndarray, "row column"],
    *,
    sample: Exemplar | None = None,
    method: Grower | None = None,
    wrap: bool = False,
    seed: int = 0,
    report: Report = silent,
) -> Filled:
    """The picture with the texels of ``hole`` grown anew, by ``Optimize()`` unless another method is given.

    What is imitated is the rest of the picture, where its mask allows, or ``sample``. Values inside the hole do not
    matter, so that the same call regrows any part of an earlier result. With ``wrap`` the picture is a tile, and
    texture continues over its borders. Of a large picture only the surroundings of the hole are looked at: as far as
    the hole is wide, 128 texels at least. An empty hole gives the picture as it is.

    Raises: ParameterError, if the hole is of another size, or the sample lacks a map of the picture;
    ExemplarError, if nothing is known, or too little to imitate.
    """
    if hole.shape != picture.shape:
        raise ParameterError(
            f"the hole is given on {_size(hole.shape)} texels, but the picture is {_size(picture.shape)}: use its size"
        )
    if hole.all() and sample is None:
        raise ExemplarError(f"all {hole.size} texels are to be filled, so nothing is known: give a sample to fill from")
    start = time.perf_counter()
    task = _beside(picture, hole, sample) if sample is not None else _around(picture, hole, whole=wrap)
    if not hole.any():
        return Filled(picture, hole, task.vocabulary, Result(task.sources(), stopped="nothing to fill"))
    task.check()
    image = in_fours(match_image(task.learnt))
    canvas = task.canvas(image)
    domain = Grid(*task.hole.shape, wrap=wrap)
    seconds = {"analysis": time.perf_counter() - start}
    hidden = task.hole.ravel()
    grown = (method or Optimize()).grow(Growth(canvas, task.learnt, image, domain, hidden, seed, report))
    result = result_of(task.sources(canvas), replace(grown, seconds=added(seconds, grown.seconds)))
    return Filled(picture, hole, task.vocabulary, result)


@dataclass(frozen=True, eq=False)
class _Task:
    """What is grown from what, and where it lies: a window of the picture, an exemplar of the vocabulary."""

    vocabulary: Exemplar
    picture: Int32[np.ndarray, "2"]  # [row, column] of the picture in the vocabulary
    shape: tuple[int, int]  # of the picture
    learnt: Exemplar
    corner: Int32[np.ndarray, "2"]  # of the exemplar learnt from in the vocabulary
    hole: Bool[np.ndarray, "row column"]  # of the window
    window: Int32[np.ndarray, "2"]  # its [row, column] in the picture

    def check(self) -> None:
        """Raises: ExemplarError, if no block can be learnt."""
        mask = readable(self.learnt.usable)
        assert mask is not None
        if not BlockSearch(mask[..., None].astype(np.float32), LEAST_SIDE, mask).usable.any():
            raise ExemplarError(
                f"what is known holds no block of {LEAST_SIDE}x{LEAST_SIDE} texels to imitate: "
                "mark less to be filled, or give a sample"
            )

    def canvas(self, image: Image) -> Canvas:
        """The window as it is known."""
        canvas = Canvas.empty(self.hole.size, image.shape[2])
        known = ~self.hole.ravel()
        texel = np.argwhere(~self.hole).astype(np.int32) + self.window + self.picture - self.corner
        canvas.position[known] = texel
        canvas.colour[known] = image[texel[:, 0], texel[:, 1]]
        canvas.label[known] = 0
        return canvas

    def sources(self, canvas: Canvas | None = None) -> SourceMap:
        """Of the whole picture: every texel its own, but for the hole what the canvas shows there."""
        position = np.argwhere(np.ones(self.shape, bool)).astype(np.float32) + self.picture.astype(np.float32)
        if canvas is not None:
            row, column = (np.argwhere(self.hole) + self.window).T
            position[row * self.shape[1] + column] = canvas.position[self.hole.ravel()] + self.corner
        return SourceMap(position[:, None].astype(np.float32), np.ones((len(position), 1), np.float32))


def _around(picture: Exemplar, hole: Bool[np.ndarray, "row column"], *, whole: bool) -> _Task:
    """Learn from the picture around the hole; from all of it if that is too little, or ``whole``."""
    window = (slice(None), slice(None)) if whole or not hole.any() else _window(hole)
    learnt = _without(picture.crop(*window), hole[window])
    corner = np.array([part.start or 0 for part in window], np.int32)
    return _Task(picture, np.zeros(2, np.int32), picture.shape, learnt, corner, hole[window], corner)


def _beside(picture: Exemplar, hole: Bool[np.ndarray, "row column"], sample: Exemplar) -> _Task:
    """Learn from the sample."""
    clean = _without(picture, hole) if not hole.all() else picture
    joined = join([replace(clean, mask=None), sample])
    lacking = [name for name in picture.maps if name not in joined.exemplar.maps]
    if lacking:
        raise ParameterError(
            f"the sample lacks {', '.join(lacking)}, which the picture has: add it to the sample, or fill without"
        )
    part, origin = joined.parts[0], np.zeros(2, np.int32)
    place = np.array([part.row, part.column], np.int32)
    return _Task(joined.exemplar, place, picture.shape, joined.within(1), origin, hole, origin)


def _without(picture: Exemplar, hole: Bool[np.ndarray, "row column"]) -> Exemplar:
    """The picture usable outside the hole, and nothing left of what was in it."""
    if not hole.any():
        return picture
    texel = nearest_usable(np.argwhere(hole).astype(np.int32), ~hole)
    maps = {name: replace(m, image=m.image.copy()) for name, m in picture.maps.items()}
    for m in maps.values():
        m.image[hole] = m.image[texel[:, 0], texel[:, 1]]
    return replace(picture, maps=maps).with_mask(~hole)


def _window(hole: Bool[np.ndarray, "row column"]) -> tuple[slice, slice]:
    """The rectangle around the hole, and as much again on every side."""
    spans = [np.flatnonzero(hole.any(axis)) for axis in (1, 0)]
    margin = max(_MARGIN, *(int(np.ptp(span)) + 1 for span in spans))
    first = [max(int(span[0]) - margin, 0) for span in spans]
    last = [min(int(span[-1]) + 1 + margin, size) for span, size in zip(spans, hole.shape, strict=True)]
    return slice(first[0], last[0]), slice(first[1], last[1])


def _size(shape: tuple[int, ...]) -> str:
    return f"{shape[1]}x{shape[0]}"
