"""Kinds of cells, from colours laid over them, and which of the sample's cells each cell of a texture shows."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int32

from texloom import draws
from texloom.errors import ExemplarError
from texloom.kernels import sketch_cells as kernels
from texloom.kernels.launch import launch
from texloom.sketch.cells import Cells
from texloom.sketch.filling.shapes import CellShapes
from texloom.sketch.graph import CellGraph

_LEVELS = 16  # of each channel: colours that fall together count as one
_SAME = 0.15  # in [0, 1]: colours that near are one kind
_SCALES = (0.3, 0.25, 0.35, 1.5)  # log area, elongation, turn (radians by elongation), corners: what counts as unlike
_MOST = 12.0  # squares of those: what is unlike altogether costs no more
_EVEN = 2.0  # what a share used up costs, in squares of those
_LUCK = 2.0  # up to that much is drawn
_TURNED = 0.25  # elongation from which a cell has a direction


@dataclass(frozen=True, eq=False)
class Kinds:
    """The kinds of a sample's cells, the one that covers most first, and the colour of each."""

    of_cell: Int32[np.ndarray, "cell"]
    palette: Float32[np.ndarray, "kind channel"]


@dataclass(frozen=True, eq=False)
class Assignment:
    """For every cell of a texture the cell of the sample that it shows, and how that is turned.

    ``turn`` (radians) is as in ``SourceMap``: the sample lies turned by it under the texture's axes.
    """

    source: Int32[np.ndarray, "cell"]
    turn: Float32[np.ndarray, "cell"]


def kinds_of(
    cell: Int32[np.ndarray, "row column"], colours: Float32[np.ndarray, "height width channel"], count: int
) -> Kinds:
    """Kinds of a sample's cells from its colour map: the colour most of a cell's texels have.

    ``cell`` is the cell of each texel (``FeatureMaps.cell``), of ``count``; colours are stored values in [0, 1], as the
    map is painted, stretched over the sample. A cell without texels is of the first kind.
    """
    colours = _over(colours, cell.shape)
    inside = cell >= 0
    of, colour = cell[inside], colours[inside]
    level = np.minimum((colour * _LEVELS).astype(np.int64), _LEVELS - 1)
    code = level @ (_LEVELS ** np.arange(colour.shape[1]))
    codes, named = np.unique(code, return_inverse=True)
    votes = np.zeros((count, max(len(codes), 1)), np.int64)
    np.add.at(votes, (of, named), 1)
    most = votes.argmax(axis=1)
    size = np.bincount(named, minlength=votes.shape[1])
    mean = (
        np.stack([np.bincount(named, channel, votes.shape[1]) for channel in colour.T], axis=1)
        / np.maximum(size, 1)[:, None]
    )
    covered = np.bincount(most, votes.sum(axis=1), votes.shape[1])
    palette: list[np.ndarray] = []
    kind = np.zeros(votes.shape[1], np.int32)
    for name in np.argsort(-covered, kind="stable"):
        if covered[name] > 0:
            apart = [float(np.hypot.reduce(mean[name] - other)) for other in palette]
            if not apart or min(apart) > _SAME:
                palette.append(mean[name])
                apart.append(0.0)
            kind[name] = np.argmin(apart)
    shown = np.array(palette or np.zeros((1, colours.shape[2])), np.float32)
    return Kinds(np.where(votes.any(axis=1), kind[most], 0).astype(np.int32), shown)


def painted(
    cell: Int32[np.ndarray, "row column"],
    pattern: Float32[np.ndarray, "height width channel"],
    *,
    palette: Float32[np.ndarray, "kind channel"],
    count: int,
) -> Int32[np.ndarray, "cell"]:
    """Kinds of a texture's cells from an image stretched over it: of its texels' nearest colours the most frequent.

    A cell without texels is of the first kind, as is any where kinds are equally frequent.
    """
    inside = cell >= 0
    colour = _over(pattern, cell.shape)[inside]
    nearest = ((colour[:, None] - palette) ** 2).sum(axis=2).argmin(axis=1)
    votes = np.bincount(cell[inside] * len(palette) + nearest, minlength=count * len(palette))
    return votes.reshape(count, len(palette)).argmax(axis=1).astype(np.int32)


def _over(image: Float32[np.ndarray, "height width channel"], shape: tuple[int, ...]) -> np.ndarray:
    """An image stretched over so many rows and columns, nearest texels."""
    index = [
        ((np.arange(side) + 0.5) * have / side).astype(int) for side, have in zip(shape, image.shape, strict=False)
    ]
    return image[index[0][:, None], index[1]]


def neighbours(graph: CellGraph, cells: Cells) -> tuple[Int32[np.ndarray, "cells_plus_one"], Int32[np.ndarray, "n"]]:
    """The cells across the edges of each, in compressed rows."""
    sides = cells.of_halfedge(len(graph.edges)).reshape(-1, 2)
    sides = sides[(sides >= 0).all(axis=1) & (sides[:, 0] != sides[:, 1])].astype(np.int64)
    pairs = np.unique(np.concatenate([sides, sides[:, ::-1]]) @ np.array([len(cells), 1]))
    start = np.searchsorted(pairs, np.arange(len(cells) + 1) * len(cells))
    return start.astype(np.int32), (pairs % max(len(cells), 1)).astype(np.int32)


@dataclass(frozen=True, kw_only=True)
class Deal:
    """Which of the sample's cells each cell of the texture shows.

    ``alike``: ours. Of the cells of the same kind one that is much like it in area (by that of typical ones),
    elongation, direction and number of corners, not shown by a neighbour, and shown no more often than others, the rest
    left to a draw. ``random``: the paper's, any cell of the same kind, as it lies.
    """

    by: Literal["alike", "random"] = "alike"

    def run(
        self,
        sample: CellShapes,
        texture: CellShapes,
        beside: tuple[Int32[np.ndarray, "cells_plus_one"], Int32[np.ndarray, "n"]],
        *,
        kinds: tuple[Int32[np.ndarray, "sample_cell"], Int32[np.ndarray, "texture_cell"]] | None = None,
        owner: Int32[np.ndarray, "sample_cell"] | None = None,
        usable: Bool[np.ndarray, "sample_cell"] | None = None,
        seed: int,
    ) -> Assignment:
        """One cell of the sample for each of the texture's; ``beside`` are those ``neighbours``.

        Of several samples (``owner``) each is shown as often, whether its cells are many or few.

        Cells cut by the sample's border, seen whole from no centre, or not ``usable``, are shown only where no other of
        their kind is; where there is none of the kind at all, any is taken.

        Raises: ExemplarError, if the sample has no cells.
        """
        if not len(sample):
            raise ExemplarError("the sample has no cells: give it a sketch that closes some")
        of_sample, of_texture = kinds or (np.zeros(len(sample), np.int32), np.zeros(len(texture), np.int32))
        fit = sample.whole & (sample.depth == 0)
        good = fit if usable is None else fit & usable
        allowed = _allowed(of_sample, of_texture, good)
        if self.by == "random" or not len(texture):
            source = _drawn(allowed, seed)
            return Assignment(source, np.zeros(len(texture), np.float32))
        used_up = _used_up(allowed, np.zeros(len(sample), np.int32) if owner is None else owner)
        source = _dealt(_unlike(sample, texture), allowed, beside, used_up=used_up, seed=seed)
        return Assignment(source, _turns(sample, texture)[np.arange(len(texture)), source].astype(np.float32))


def _allowed(
    of_sample: Int32[np.ndarray, "s"], of_texture: Int32[np.ndarray, "t"], good: Bool[np.ndarray, "s"]
) -> Bool[np.ndarray, "t s"]:
    """Which cells of the sample each kind may show, then each cell of the texture."""
    kinds = np.arange(max(of_sample.max(initial=0), of_texture.max(initial=0)) + 1)
    same = of_sample == kinds[:, None]
    best = same & good
    best = np.where(best.any(axis=1, keepdims=True), best, same)
    any_at_all = good if good.any() else np.ones_like(good)
    return np.where(best.any(axis=1, keepdims=True), best, any_at_all)[of_texture]


def _drawn(allowed: Bool[np.ndarray, "t s"], seed: int) -> Int32[np.ndarray, "t"]:
    """One of those allowed each, all alike."""
    luck = draws.uniform(seed, index=np.arange(allowed.size)).reshape(allowed.shape)
    return np.where(allowed, luck, -1).argmax(axis=1).astype(np.int32)


def _turns(sample: CellShapes, texture: CellShapes) -> Float64[np.ndarray, "t s"]:
    """The least turn that lays a cell's length along the other's, within a quarter; 0 where either has no direction."""
    turn = sample.axis - texture.axis[:, None]
    turn -= np.rint(turn / np.pi) * np.pi
    both = np.minimum(sample.elongation, texture.elongation[:, None]) > _TURNED
    return np.where(both, turn, 0.0)


def _unlike(sample: CellShapes, texture: CellShapes) -> Float32[np.ndarray, "t s"]:
    """How unlike cells are, in squares of what counts as unlike; less and less beyond a dozen."""
    area, longer, turned, corners = _SCALES
    size = [np.log(shapes.relative) for shapes in (sample, texture)]
    apart = ((size[0] - size[1][:, None]) / area) ** 2
    apart += ((sample.elongation - texture.elongation[:, None]) / longer) ** 2
    both = np.minimum(sample.elongation, texture.elongation[:, None])
    apart += (_turns(sample, texture) * both / turned) ** 2
    apart += ((sample.corners - texture.corners[:, None]) / corners) ** 2
    return (_MOST * apart / (apart + _MOST)).astype(np.float32)


def _used_up(allowed: Bool[np.ndarray, "t s"], owner: Int32[np.ndarray, "s"]) -> Float32[np.ndarray, "t s"]:
    """What showing a cell once takes of its fair share: its sample's choices times samples to choose from, by cells."""
    choices = allowed @ (owner[:, None] == np.arange(owner.max(initial=0) + 1)).astype(np.float32)
    samples = (choices > 0).sum(axis=1, keepdims=True)
    return (choices * samples / max(len(allowed), 1)).astype(np.float32).take(owner, axis=1)


def _dealt(
    unlike: Float32[np.ndarray, "t s"],
    allowed: Bool[np.ndarray, "t s"],
    beside: tuple[Int32[np.ndarray, "cells_plus_one"], Int32[np.ndarray, "n"]],
    *,
    used_up: Float32[np.ndarray, "t s"],
    seed: int,
) -> Int32[np.ndarray, "t"]:
    """One cell after the other, in a drawn order, each the cheapest left by its neighbours."""
    cells, choices = unlike.shape
    order = draws.permutation(seed, 0, count=cells).astype(np.int32)
    luck = draws.uniform(seed, 1, index=np.arange(unlike.size)).reshape(unlike.shape)
    cost = np.where(allowed, unlike + _LUCK * luck, np.float32(np.inf)).astype(np.float32)
    source, used = np.full(cells, -1, np.int32), np.zeros(choices, np.int32)
    inputs = [order, cost, _EVEN, used_up, *beside]
    launch(kernels.deal, 1, inputs=inputs, outputs=[source, used], grain=1)
    return source
