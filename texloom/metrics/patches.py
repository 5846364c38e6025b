"""All square patches of an image as vectors: what the scores compare."""

import numpy as np
from jaxtyping import Float32, Shaped

from texloom.arrays import Image
from texloom.errors import ParameterError

Picture = Float32[np.ndarray, "row2 column2 channel"]
"""The second of two pictures that are compared: as many channels, its own size."""

SIDE = 7  # texels; every score looks through 7×7 windows


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


def patch_vectors(image: Image) -> Float32[np.ndarray, "patch dim"]:
    """Every whole patch as one row, in reading order of its top left texel."""
    view = windows(image)
    return view.reshape(view.shape[0] * view.shape[1], -1)
