"""Several samples as one exemplar: side by side in one image a map, with gaps between them that are never used.

A source is then a position in that one image, so kernels, gathers and searches serve several samples as they serve one.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Int64

from texloom.arrays import Image
from texloom.errors import ExemplarError
from texloom.exemplar.exemplar import Exemplar, Map, Part

__all__ = ["Joined", "Part", "arrange", "join"]

_GAP = 4  # texels between samples at least: two repeat either's border, so reads between texels never mix samples
_GRID = 8  # texels: samples begin at multiples, so that coarse candidates and pyramids begin where they do in one alone


@dataclass(frozen=True, eq=False)
class Joined:
    """Samples as one exemplar, the rectangle of each in their order, and the maps left out since not all have them."""

    exemplar: Exemplar
    parts: tuple[Part, ...]
    dropped: tuple[str, ...] = ()

    def within(self, *parts: int) -> Exemplar:
        """The same stack, used only inside these samples (and where their own masks allow).

        Raises: ExemplarError, if no part is given.
        """
        inside = _inside([self.parts[number] for number in parts], self.exemplar.shape)
        return self.exemplar if inside.all() else self.exemplar.with_mask(inside)


def join(samples: Sequence[Exemplar]) -> Joined:
    """The samples side by side, in rows where that is more compact; their sizes alone decide where each lies.

    Maps are those that all samples have, in the first's order, as deep as the deepest; grey is widened to colour where
    another has colour. Where some samples have an "alpha", the others are opaque. One sample is given back as it is.

    Raises: ExemplarError, if there is no sample, no map in common, or a map has channels or a kind that do not agree.
    """
    return arrange(samples, layout([sample.shape for sample in samples]))


def arrange(samples: Sequence[Exemplar], parts: Sequence[Part]) -> Joined:
    """``join`` with the place of every sample given; places must be apart as ``join`` makes them."""
    if not samples:
        raise ExemplarError("there is no sample to join: give one or more")
    parts = tuple(parts)
    if len(samples) == 1:
        return Joined(samples[0], parts)
    kept, dropped = _shared_names(samples)
    shape = max(p.row + p.rows for p in parts), max(p.column + p.columns for p in parts)
    usable = np.zeros(shape, bool)
    for sample, part in zip(samples, parts, strict=True):
        usable[part.slices] = sample.usable
    gap = np.argwhere(~_inside(parts, shape))
    border = _nearest(gap, parts)
    maps = {}
    for name in kept:
        of_samples = _alike(name, [_map_of(sample, name) for sample in samples])
        maps[name] = _side_by_side(of_samples, parts, shape, (gap, border))
    return Joined(Exemplar(maps, usable, _leaves(samples, parts)), parts, dropped)


def layout(sizes: Sequence[tuple[int, int]]) -> tuple[Part, ...]:
    """Where samples of these sizes (rows, columns) lie: in order, in shelves of the width that keeps the whole small.

    Small is the sum of both sides, then the area, then the number of shelves.
    """
    widths = np.cumsum([_ceil(columns + _GAP) for _, columns in sizes])
    tried = [_shelves(sizes, int(width)) for width in widths[::-1]]
    return min(tried, key=_extent, default=())


def _shelves(sizes: Sequence[tuple[int, int]], width: int) -> tuple[Part, ...]:
    """Samples from left to right with their tops in line, on a new shelf where one would pass ``width``."""
    parts: list[Part] = []
    row = column = 0
    tallest = 0
    for rows, columns in sizes:
        if column and column + columns > width:
            row, column, tallest = row + _ceil(tallest + _GAP), 0, 0
        parts.append(Part(row, column, rows, columns))
        column += _ceil(columns + _GAP)
        tallest = max(tallest, rows)
    return tuple(parts)


def _extent(parts: Sequence[Part]) -> tuple[int, int]:
    """How large the whole is: both sides together, and the area."""
    rows, columns = max(p.row + p.rows for p in parts), max(p.column + p.columns for p in parts)
    return rows + columns, rows * columns


def _ceil(length: int) -> int:
    return -(-length // _GRID) * _GRID


def _leaves(samples: Sequence[Exemplar], parts: Sequence[Part]) -> tuple[Part, ...]:
    """The rectangles of single samples, also of those that were joined before."""
    leaves: list[Part] = []
    for sample, part in zip(samples, parts, strict=True):
        moved = [replace(leaf, row=part.row + leaf.row, column=part.column + leaf.column) for leaf in sample.parts]
        leaves += moved or [part]
    return tuple(leaves)


def _shared_names(samples: Sequence[Exemplar]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Maps that all samples have, in the first's order, and those that only some have.

    Opacity is kept beside others where any sample has it.
    """
    names = tuple(dict.fromkeys(name for sample in samples for name in sample.maps))
    kept = tuple(name for name in names if all(name in sample.maps for sample in samples))
    if not kept:
        held = "; ".join(f"sample {number + 1} has {', '.join(sample.maps)}" for number, sample in enumerate(samples))
        raise ExemplarError(f"the samples have no map in common: {held}")
    kept = tuple(name for name in names if name in kept or name == "alpha")
    return kept, tuple(name for name in names if name not in kept)


def _map_of(sample: Exemplar, name: str) -> Map:
    """The sample's map; full opacity where it has none."""
    return sample.maps[name] if name in sample.maps else Map(np.ones((*sample.shape, 1), np.float32), "data", 8)


def _alike(name: str, maps: Sequence[Map]) -> list[Map]:
    """The maps with one kind, depth and number of channels."""
    channels = {m.image.shape[2] for m in maps}
    most = max(channels)
    if channels - {1, most} or len({m.kind for m in maps}) > 1:
        told = ", ".join(f"{m.image.shape[2]} of {m.kind}" for m in maps)
        raise ExemplarError(f"{name} differs between samples in channels or kind ({told}): convert them to one kind")
    bits = max(m.bits for m in maps)
    return [Map(np.broadcast_to(m.image, (*m.image.shape[:2], most)), m.kind, bits) for m in maps]


def _side_by_side(
    maps: Sequence[Map],
    parts: Sequence[Part],
    shape: tuple[int, int],
    gap: tuple[Int64[np.ndarray, "texel 2"], Int64[np.ndarray, "texel 2"]],
) -> Map:
    """One map that holds all; texels of the gap repeat those they are nearest to."""
    image: Image = np.empty((*shape, maps[0].image.shape[2]), np.float32)
    for m, part in zip(maps, parts, strict=True):
        image[part.slices] = m.image
    texel, border = gap
    image[texel[:, 0], texel[:, 1]] = image[border[:, 0], border[:, 1]]
    return Map(image, maps[0].kind, maps[0].bits)


def _inside(parts: Sequence[Part], shape: tuple[int, int]) -> Bool[np.ndarray, "row column"]:
    """True in the rectangles."""
    inside = np.zeros(shape, bool)
    for part in parts:
        inside[part.slices] = True
    return inside


def _nearest(texel: Int64[np.ndarray, "texel 2"], parts: Sequence[Part]) -> Int64[np.ndarray, "texel 2"]:
    """The texel of any part that is nearest to each texel; ties take the first part."""
    best, least = np.zeros_like(texel), np.full(len(texel), np.inf)
    for part in parts:
        last = part.row + part.rows - 1, part.column + part.columns - 1
        near = np.clip(texel, (part.row, part.column), last)
        distance = ((texel - near) ** 2).sum(1)
        closer = distance < least
        best[closer], least[closer] = near[closer], distance[closer]
    return best
