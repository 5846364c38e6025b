"""Triangle quilting: every patch of a mesh gets the place in the sample that fits its neighbours.

After Magda & Kriegman 2003, section 3.2.2; ``docs/papers/texton.md`` says where the default departs from it.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float32, Int32, Int64

from texloom import draws
from texloom.domain.faces import Faces
from texloom.errors import ParameterError
from texloom.kernels.growth import colour_patches, growth_order
from texloom.kernels.launch import Repeated, launch, thread_count
from texloom.kernels.quilting import COUNT_BITS, choose_places
from texloom.progress import Report, silent
from texloom.search.textons import Textons

Order = Literal["constrained", "random"]
Match = Literal["colours", "textons"]

_FIRST, _CHANCE, _PLACE = 0x71F1, 0x71F2, 0x71F3  # purposes of the draws: where growth begins, its order, equal places
_PER_SEED = 512  # patches to a seed: more fronts at once fit as well, and more patches can be placed side by side
_TEXTON_SHARE = 0.5  # of a texton's difference beside that of the colours on the edge itself
_MOST_POINTS = 96  # of a whole rim, where colours decide: twice as many cost twice the time and fit as well
_THIN = 2  # every so many points vote where colours decide: beside it shows the same textons
_SEARCHES = 1 << (31 - COUNT_BITS)  # told apart in a vote
_MOST_VOTES = (1 << (COUNT_BITS - 1)) - 3  # counted in a vote
_MOST_TEXTONS = (1 << 15) - 1
_MOST_LANES = 16  # each has working arrays as large as the sample,
_MOST_WORK = 1 << 27  # of so many texels in all (1 GB), or there is a single one
_HANDING_OVER = 2e5  # ns a thread should have to do; a vote takes some 2 ns, comparing a point 3, a patch at least 3000
_AT_ONCE = 1024  # patches a thread places before progress is told


@dataclass(frozen=True, kw_only=True)
class Quilting:
    """Patches grown over the mesh from seeds, each where bucket voting and eq. 2 find that it fits what is there.

    ``order`` is the patch next: the one of whose rim the largest share is known ("constrained"), or any on the front
    ("random", from a single seed). ``match`` compares the ``candidates`` most voted by textons alone, as published, or
    by the colours on the edge as well; then the continuations of the neighbours compete too, and the best place is
    moved between texels. After growth, ``rounds`` choose anew for the ``share`` of the patches that fit worst.
    """

    order: Order = "constrained"
    match: Match = "colours"
    candidates: int = 32
    rounds: int = 2
    share: float = 0.5

    def __post_init__(self) -> None:
        if self.candidates < 1 or self.rounds < 0 or not 0 < self.share <= 1:
            raise ParameterError(
                f"{self.candidates} candidates, {self.rounds} rounds, a share of {self.share:g}: "
                "give 1 candidate or more, 0 rounds or more, and a share above 0 and up to 1"
            )

    def run(self, textons: Textons, faces: Faces, *, seed: int = 0, report: Report = silent) -> "Quilted":
        """Quilt ``faces`` from a sample.

        The mean error of the patches is that of when each was placed last: of textons as squared differences, of
        colours as differences, channels in [0, 1]. Time is O(face · edge · (texel / texton + candidates)), edges in
        texels.

        Raises: ParameterError, if a patch has no place in the sample.
        """
        _check_room(textons, faces)
        started = time.perf_counter()
        chooser = _Chooser(self, textons, faces, seed)
        energy, stopped = [], "rounds"
        chooser.place_all(*_growth(faces, self.order, seed), report=_part(report, 0, self.rounds))
        energy.append(float(chooser.error.mean(dtype=np.float64)))
        seconds = {"growth": time.perf_counter() - started}
        for number in range(self.rounds):
            before = chooser.place.copy()
            chooser.place_worst(self.share, report=_part(report, 1 + number, self.rounds))
            energy.append(float(chooser.error.mean(dtype=np.float64)))
            if np.array_equal(before, chooser.place):
                stopped = "no patch moved"
                break
        seconds["rounds"] = time.perf_counter() - started - seconds["growth"]
        return Quilted(faces, chooser.coordinates, tuple(energy), seconds, stopped)


@dataclass(frozen=True, eq=False)
class Quilted:
    """Texture coordinates into the sample, for every corner of every face: no new texture is made."""

    faces: Faces
    coordinates: Float32[np.ndarray, "face 3 2"]  # [row, column] exemplar texels, affine inside a face
    energy: tuple[float, ...]  # mean error of the patches after growth and after each round
    seconds: dict[str, float]
    stopped: str


class _Chooser:
    """Places of all patches while they are chosen."""

    def __init__(self, method: Quilting, textons: Textons, faces: Faces, seed: int) -> None:
        self.faces = faces
        self.place = np.zeros((faces.count, 2), np.float32)  # (column, row) of each patch's origin
        self.branch = np.full(faces.count, -1, np.int32)  # which of the field's symmetries; -1: not placed
        self.error = np.zeros(faces.count, np.float32)
        self._todo = np.empty(faces.count, np.int32)
        rows, columns, channels = textons.image.shape
        self._lanes = min(thread_count(), _MOST_LANES, max(_MOST_WORK // (rows * columns), 1))
        self._at_once = self._lanes * min(_AT_ONCE, (_SEARCHES - 1) // faces.order)
        self._searched = 0
        by_colour = method.match == "colours"
        owner = faces.patch[faces.rim[1] // 3]
        rim = np.bincount(owner, faces.border_length, minlength=faces.count)
        spacing = np.maximum(rim / _MOST_POINTS, 1.0) if by_colour else np.ones(faces.count)
        points = np.bincount(owner, np.ceil(faces.border_length / spacing[owner]) + 1, minlength=1)
        longest = int(points.max())
        self._votes = np.zeros(self._lanes * rows * columns, np.int32)
        scratch = [
            self._votes,
            np.empty(self._lanes * rows * columns, np.int32),
            np.empty((self._lanes, longest + 3), np.int32),
            np.empty(self._lanes * longest, np.int32),
            np.empty((self._lanes * longest, 2), np.int32),
            np.empty(self._lanes * longest * channels, np.float32),
        ]
        layout = np.ascontiguousarray(faces.layout).view(np.float32).reshape(-1, 3, 2)
        rims = [*faces.rim, faces.mesh.twins, faces.patch, layout, *faces.bounds]
        thin = max(_THIN if by_colour else 1, -(-longest // _MOST_VOTES))
        chance = draws.bits(seed, _PLACE, index=np.arange(faces.count))
        work = points.mean() * (2.0 * len(textons.bucket) / textons.count / thin + 3.0 * method.candidates) + 3000.0
        self._few = max(ceil(_HANDING_OVER / work), 1)
        numbers = [thin, method.candidates, int(by_colour), spacing.astype(np.float32), chance, longest]
        self._choose = Repeated(
            choose_places,
            5,
            inputs=[self._todo, *rims, *_sample(textons, by_colour=by_colour), *numbers],
            outputs=[*scratch, self.place, self.branch, self.error],
        )

    def place_all(
        self, order: Int32[np.ndarray, "patch"], starts: list[int], *, keep: bool = False, report: Report = silent
    ) -> None:
        """Place the patches batch by batch, ``order[starts[i]:starts[i + 1]]`` side by side."""
        self._todo[: len(order)] = order
        for begin, end, lanes in self._runs(starts):
            for first in range(begin, end, self._at_once):
                last = min(first + self._at_once, end)
                self._place(first, last, lanes, keep=keep)
                report("quilting", last / len(order))

    def _runs(self, starts: list[int]) -> Iterator[tuple[int, int, int]]:
        """Batches and the lanes they are worth; small ones in a row go together on one: they are in order anyway."""
        small = 0
        for begin, end in zip(starts[:-1], starts[1:], strict=True):
            lanes = min(self._lanes, (end - begin) // self._few)
            if lanes > 1:
                if small < begin:
                    yield small, begin, 1
                yield begin, end, lanes
                small = end
        if small < starts[-1]:
            yield small, starts[-1], 1

    def _place(self, first: int, last: int, lanes: int, *, keep: bool) -> None:
        """Place patches that do not touch, or on one lane any."""
        searches = -(-(last - first) // lanes) * self.faces.order
        if self._searched + searches >= _SEARCHES:
            self._votes[...] = 0
            self._searched = 0
        self._choose.run(lanes, first, last, lanes, self._searched, int(keep))
        self._searched += searches

    def place_worst(self, share: float, *, report: Report) -> None:
        """Choose anew for the patches with the greatest errors; none gets a worse place than it has."""
        worst = np.argsort(-self.error, kind="stable")[: max(round(share * self.faces.count), 1)].astype(np.int32)
        colour = self._colour[worst]
        order = worst[np.argsort(colour, kind="stable")]
        self.place_all(order, _starts(colour), keep=True, report=report)

    @cached_property
    def _colour(self) -> Int32[np.ndarray, "patch"]:
        """Colours such that neighbours differ: patches of one colour can be placed side by side."""
        colour = np.full(self.faces.count, -1, np.int32)
        launch(colour_patches, 1, inputs=[self.faces.rim[0], self.faces.across], outputs=[colour])
        return colour

    @property
    def coordinates(self) -> Float32[np.ndarray, "face 3 2"]:
        """[row, column] of every corner."""
        turn = np.exp(2j * np.pi * self.branch / self.faces.order).astype(np.complex64)
        place = self.place.view(np.complex64)[:, 0]
        patch = self.faces.patch
        corners = place[patch, None] + turn[patch, None] * self.faces.layout
        return np.stack([corners.imag, corners.real], axis=-1)


def _sample(textons: Textons, *, by_colour: bool) -> list:
    """The sample and its textons as the kernel takes them: image, labels, buckets, distances, masked texels."""
    if textons.count > _MOST_TEXTONS:
        raise ParameterError(f"{textons.count} textons are more than {_MOST_TEXTONS}: learn fewer (count=, --count)")
    _, columns, channels = textons.image.shape
    labels = textons.labels.astype(np.int16)
    packed = (textons.bucket // columns << 16) | textons.bucket % columns
    distance = np.float32(_TEXTON_SHARE) * np.sqrt(textons.distance) if by_colour else textons.distance
    image = np.ascontiguousarray(textons.image, np.float32).reshape(-1)
    buckets = [textons.bucket_start, packed.astype(np.int32), np.ascontiguousarray(distance, np.float32)]
    return [image, channels, labels, labels[0].reshape(-1), *buckets, _hidden(textons)]


def _hidden(textons: Textons) -> Int32[np.ndarray, "row column"]:
    """Masked texels above and left of each corner of a texel; (1, 1) where none is masked."""
    usable = textons.exemplar.mask
    if usable is None:
        return np.zeros((1, 1), np.int32)
    return np.pad((~usable).cumsum(0).cumsum(1), ((1, 0), (1, 0))).astype(np.int32)


def _growth(faces: Faces, order: Order, seed: int) -> tuple[Int32[np.ndarray, "patch"], list[int]]:
    """Patches in the order of growth, in batches of patches that do not touch, and where the batches begin."""
    count = faces.count
    step, grown = np.empty(count, np.int32), np.empty(count, np.int32)
    first = draws.permutation(seed, _FIRST, count=count).astype(np.int32)
    chance = draws.bits(seed, _CHANCE, index=np.arange(count))
    seeds = max(count // _PER_SEED, 1) if order == "constrained" else 1
    size = len(faces.across) + seeds
    work = [np.empty(size, np.int64), np.empty(size, np.int32), np.empty(count, np.float32)]
    inputs = [first, faces.rim[0], faces.across, faces.border_length, chance, seeds, int(order == "constrained")]
    launch(growth_order, 1, inputs=inputs, outputs=[*work, step, grown])
    at = step[grown]
    return grown[np.argsort(at, kind="stable")], _starts(at)


def _starts(batch: Int32[np.ndarray, "member"]) -> list[int]:
    """Where each batch begins once its members are sorted together, and the end; empty ones are left out."""
    size = np.bincount(batch)
    return [0, *np.cumsum(size[size > 0]).tolist()]


def _part(report: Report, number: int, rounds: int) -> Report:
    """Progress of one pass over the patches; growth is pass 0, and takes about as long as two rounds."""
    whole = 2 + rounds
    begin, length = (0, 2) if number == 0 else (1 + number, 1)
    return lambda stage, done: report(stage, (begin + length * done) / whole)


def _check_room(textons: Textons, faces: Faces) -> None:
    """Raises: ParameterError, if a patch fits nowhere in the usable part of the sample, however it is turned."""
    mask = textons.exemplar.mask
    rows, columns = textons.exemplar.shape
    least, greatest = faces.bounds
    size = np.ceil(greatest) - np.floor(least) + 1  # texels under a patch at a whole place, by each turn
    width = np.minimum(size[..., 0], columns + 1).astype(int)
    fits = (size[..., 1] <= _tallest(mask, (rows, columns), int(width.max(initial=0)))[width]).any(1)
    if not fits.all():
        smallest = size[~fits, size[~fits].max(-1).argmin(1)]
        across, down = smallest[smallest.prod(1).argmax()]
        sample = f"the sample of {columns}x{rows}{'' if mask is None else ' and its mask'}"
        raise ParameterError(
            f"{np.count_nonzero(~fits)} of {faces.count} patches, up to {across:.0f}x{down:.0f} texels, have no place "
            f"in {sample}: use fewer repeats or a larger texel, narrower patches,"
            " or split the faces (most=; --as atlas does)"
        )


def _tallest(
    mask: Bool[np.ndarray, "row column"] | None, shape: tuple[int, int], widest: int
) -> Int64[np.ndarray, "width"]:
    """Rows of the tallest box without masked texels, of each width from 0 to ``widest``; 0 beyond the sample."""
    rows, columns = shape
    if mask is None:
        return np.where(np.arange(widest + 1) <= columns, rows, 0)
    row = np.arange(rows)[:, None]
    above = row - np.maximum.accumulate(np.where(mask, -1, row), axis=0)  # usable texels up from each, with itself
    box, tallest = above, [rows]
    for width in range(1, widest + 1):
        tallest.append(box.max(initial=0))
        box = np.minimum(box[:, :-1], above[:, width:])
    return np.array(tallest)
