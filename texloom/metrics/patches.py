"""All square patches of an image as vectors: what the scores compare."""

import numpy as np
from jaxtyping import Bool, Float32, Int, Shaped

from texloom.arrays import Image
from texloom.errors import ParameterError
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.patches import whole_squares

Picture = Float32[np.ndarray, "row2 column2 channel"]
"""The second of two pictures that are compared: as many channels, its own size."""

Usable = Bool[np.ndarray, "row column"] | None
"""True where the first picture, the sample, may be looked at; None: everywhere."""

SIDE = 7  # texels; every score looks through 7×7 windows
_BLOCK = 2048  # patches gathered at once


def encoded(image: Shaped[np.ndarray, "..."]) -> Image:
    """An image as it is stored (sRGB for colours), as floats in [0, 1] with a channel axis.

    Integers are divided by their type's largest value; floats are taken as they are.

    Raises: ParameterError, if it is smaller than one patch or not a picture.
    """
    if image.ndim not in (2, 3) or min(image.shape[:2]) < SIDE:
        raise ParameterError(f"scores need pictures of {SIDE}×{SIDE} texels or more, this array is {image.shape}")
    values = image.reshape(*image.shape[:2], -1)
    if np.issubdtype(values.dtype, np.integer):
        return values.astype(np.float32) / np.float32(np.iinfo(values.dtype).max)
    return np.ascontiguousarray(values, np.float32)


def windows(image: Shaped[np.ndarray, "row column channel"]) -> Shaped[np.ndarray, "row2 column2 channel side side"]:
    """A view of every whole patch, at its top left texel; copies nothing."""
    return np.lib.stride_tricks.sliding_window_view(image, (SIDE, SIDE), axis=(0, 1))


def patch_vectors(image: Image, usable: Usable = None, most: int | None = None) -> Float32[np.ndarray, "patch dim"]:
    """Every whole patch as one row, in reading order of its top left texel; of many ``most``, evenly spaced."""
    return patches_at(image, evenly(patch_places(image, usable), most))


def patches_at(image: Image, places: Int[np.ndarray, "patch 2"]) -> Float32[np.ndarray, "patch dim"]:
    """The patches at those top left texels: channel by channel, then row by row."""
    values = np.ascontiguousarray(np.moveaxis(image, -1, 0))
    texel = np.arange(values.size).reshape(values.shape)
    offset, corner = texel[:, :SIDE, :SIDE].ravel(), texel[0][places[:, 0], places[:, 1]]
    vectors = np.empty((len(places), len(offset)), np.float32)

    def gather(first: int, last: int) -> None:
        values.ravel().take(corner[first:last, None] + offset, out=vectors[first:last], mode="clip")

    over_blocks(gather, len(places), _BLOCK)
    return vectors


def patch_places(image: Image, usable: Usable = None) -> Int[np.ndarray, "patch 2"]:
    """The top left texel of every patch that is wholly inside, and usable, in reading order."""
    if usable is None:
        return np.argwhere(np.ones(windows(image).shape[:2], bool))
    return np.argwhere(whole_squares(usable, SIDE))


def evenly(rows: Shaped[np.ndarray, "n dim"], most: int | None) -> Shaped[np.ndarray, "few dim"]:
    """At most so many of the rows, in the middles of equal shares."""
    if most is None or len(rows) <= most:
        return rows
    return rows[((2 * np.arange(most) + 1) * len(rows)) // (2 * most)]
