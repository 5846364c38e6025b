"""Gaussian pyramid of any image: each level half the size of the one before."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float32

from texloom.arrays import Image
from texloom.errors import ParameterError
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.exemplar import Exemplar, Part

_BLOCK = 16  # coarse rows blurred at once


@dataclass(frozen=True, eq=False)
class Level:
    """An image at one resolution; ``usable`` is None where every texel is."""

    image: Image
    usable: Bool[np.ndarray, "row column"] | None = None


def gaussian_pyramid(image: Image, levels: int, *, usable: Bool[np.ndarray, "row column"] | None = None) -> list[Level]:
    """``levels`` images, finest first, the first as given.

    The blur is the binomial 1 4 6 4 1 (Burt & Adelson 1983), mirrored at the border. Texel (i, j) of a level lies on
    texel (2i, 2j) of the finer one, so n texels become (n + 1) // 2. Masked texels count for nothing; a coarse texel is
    usable where the texel it lies on is.
    """
    if levels < 1:
        raise ParameterError(f"a pyramid has 1 level or more, not {levels}")
    pyramid = [Level(np.ascontiguousarray(image, np.float32), usable)]
    while len(pyramid) < levels:
        pyramid.append(coarser(pyramid[-1]))
    return pyramid


def stack_pyramid(exemplar: Exemplar, levels: int) -> list[Exemplar]:
    """``levels`` stacks, finest first, the first as given: every map as in ``gaussian_pyramid``, mask and parts too."""
    maps = {name: gaussian_pyramid(m.image, levels, usable=exemplar.mask) for name, m in exemplar.maps.items()}
    stacks = [exemplar]
    for level in range(1, levels):
        smaller = {name: replace(exemplar.maps[name], image=pyramid[level].image) for name, pyramid in maps.items()}
        parts = tuple(_smaller(part, 2**level) for part in exemplar.parts)
        stacks.append(Exemplar(smaller, next(iter(maps.values()))[level].usable, parts))
    return stacks


def coarser(level: Level) -> Level:
    """The next level of the pyramid."""
    if level.usable is None:
        return Level(halve(level.image))
    weight = level.usable[..., None].astype(np.float32)
    total = halve(weight)
    mean = halve(level.image * weight) / np.maximum(total, np.float32(1e-6))
    return Level(mean, np.ascontiguousarray(level.usable[::2, ::2]))


def _smaller(part: Part, times: int) -> Part:
    """The rectangle in an image so many times smaller."""
    return Part(part.row // times, part.column // times, -(-part.rows // times), -(-part.columns // times))


def halve(image: Image) -> Image:
    """Blurred by the binomial and read at every other texel of every other row."""
    rows, columns, channels = image.shape
    padded = _mirrored(_mirrored(image, 0), 1)
    half = np.empty(((rows + 1) // 2, (columns + 1) // 2, channels), np.float32)

    def blur(first: int, last: int) -> None:
        across = _every_other(padded[2 * first : 2 * last + 3], 0, last - first)
        half[first:last] = _every_other(across, 1, half.shape[1])

    over_blocks(blur, len(half), _BLOCK)
    return half


def _mirrored(image: Image, axis: int) -> Image:
    """Two more lines at both ends of an axis, mirrored at the texels of the border."""
    around = [(0, 0)] * 3
    around[axis] = (2, 2)
    return np.pad(image, around, mode="reflect" if image.shape[axis] > 2 else "edge")


def _every_other(padded: Float32[np.ndarray, "..."], axis: int, count: int) -> Float32[np.ndarray, "..."]:
    """The binomial along an axis, at every other line."""

    def lines(tap: int) -> np.ndarray:
        place: list[slice] = [slice(None)] * 3
        place[axis] = slice(tap, tap + 2 * count - 1, 2)
        return padded[tuple(place)]

    total = lines(1) + lines(3)
    total *= np.float32(4 / 16)
    total += (lines(0) + lines(4)) * np.float32(1 / 16)
    total += lines(2) * np.float32(6 / 16)
    return total
