"""Samples that show how two textures meet, cut together of the two."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Float32, Int64

from texloom import draws
from texloom.arrays import Image
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import LEAST_SIDE, Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.join import Joined, join
from texloom.synthesis.cuts import cheapest_cut, seam_costs

_PLACE = 0xBE17  # purpose of the draws that lay the two samples over each other
_TRIED = 24  # ways to lay them, of which the one that differs least along the cut is taken
_SHARE = 7 / 8  # of the smaller sides: leaves room to choose a way
_INNER, _OUTER = 0.35, 0.95  # of the half sides: the cut runs around the middle between these


@dataclass(frozen=True, eq=False)
class BeltSample:
    """A sample in which two meet along a closed line, so that borders of every direction occur.

    ``second`` is True where the second sample shows, ``texel`` the [row, column] of its own sample that each shows.
    """

    exemplar: Exemplar
    second: Bool[np.ndarray, "row column"]
    texel: Int64[np.ndarray, "row column 2"]

    def origin(self, position: Float32[np.ndarray, "n 2"]) -> tuple[Bool[np.ndarray, "n"], Float32[np.ndarray, "n 2"]]:
        """Whether positions show the second sample, and where in its own sample each lies."""
        at = np.clip(np.rint(position).astype(np.int64), 0, np.array(self.second.shape) - 1)
        shown = self.texel[at[:, 0], at[:, 1]]
        return self.second[at[:, 0], at[:, 1]], (shown + (position - at)).astype(np.float32)


def belt_sample(first: Exemplar, second: Exemplar, *, seed: int = 0) -> BeltSample:
    """Two samples laid over each other and cut by the least-cost closed line, the first inside, the second outside.

    Of some random ways to lay them, the one in which they differ least around the middle is cut. The sample is a
    little smaller than both. Departure from Shin & Shin 2004, section 4, who do not say how the cut runs: a closed one
    has borders of every direction. O(texel^1.5) time or so.
    """
    joined = join([first, second])
    rows, columns = (max(LEAST_SIDE, int(min(sides) * _SHARE)) for sides in zip(first.shape, second.shape, strict=True))
    shape = rows, columns
    away = _from_middle(shape)
    between = (away > _INNER) & (away < _OUTER)
    image = match_image(joined.exemplar)
    corners = [_corners(joined, shape, seed, way) for way in range(_TRIED)]
    differ = [float(((_crop(image, a, shape) - _crop(image, b, shape))[between] ** 2).mean()) for a, b in corners]
    corner = corners[int(np.argmin(differ))]

    one, two = (_crop(image, at, shape).reshape(-1, image.shape[2]) for at in corner)
    edges = Grid(rows, columns).edges
    inside = cheapest_cut(
        edges, seam_costs(one, two, edges), one=(away <= _INNER).ravel(), other=(away >= _OUTER).ravel()
    ).reshape(shape)
    texel = np.stack(np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"), -1)
    shown = np.where(inside[..., None], texel + corner[0], texel + corner[1])
    stack = joined.exemplar
    maps = {name: replace(m, image=m.image[shown[..., 0], shown[..., 1]]) for name, m in stack.maps.items()}
    origin = np.array([(part.row, part.column) for part in joined.parts])
    mask = None if stack.mask is None else stack.mask[shown[..., 0], shown[..., 1]]
    return BeltSample(Exemplar(maps, mask), ~inside, shown - origin[(~inside).astype(int)])


def _corners(joined: Joined, shape: tuple[int, int], seed: int, way: int) -> Int64[np.ndarray, "2 2"]:
    """The upper left texel of a rectangle at random in each of the two parts."""
    free = np.array([(part.rows, part.columns) for part in joined.parts]) - shape + 1
    drawn = draws.uniform(seed, _PLACE, way, index=np.arange(4)).reshape(2, 2)
    return np.array([(p.row, p.column) for p in joined.parts]) + (drawn * free).astype(np.int64)


def _crop(image: Image, corner: Int64[np.ndarray, "2"], shape: tuple[int, int]) -> Image:
    return image[corner[0] : corner[0] + shape[0], corner[1] : corner[1] + shape[1]]


def _from_middle(shape: tuple[int, int]) -> Float[np.ndarray, "row column"]:
    """Distance from the middle in half sides: 1 at the middle of each border."""
    row, column = (np.abs(np.arange(size) - (size - 1) / 2) / (size / 2) for size in shape)
    return np.hypot(row[:, None], column)
