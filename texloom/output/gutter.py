"""Gutters: texels beyond a chart's border take the value of the nearest covered one, so that filtering finds no gap."""

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom.kernels import raster as kernels
from texloom.kernels.launch import launch


def nearest_texels(covered: Bool[np.ndarray, "row column"], width: int) -> Int32[np.ndarray, "row column"]:
    """Flat index of the nearest covered texel (its own if covered), -1 where none lies within ``width`` texels.

    Euclidean distance, by columns and then along rows; ties go to the left, then up. O(texels · width).
    """
    rows = len(covered)
    step, nearest = np.empty(covered.shape, np.int32), np.empty(covered.shape, np.int32)
    launch(kernels.gap_in_column, rows, inputs=[covered.astype(np.uint8), width], outputs=[step])
    launch(kernels.nearest_covered, rows, inputs=[step, width], outputs=[nearest])
    return nearest


def fill(
    values: Float32[np.ndarray, "texel channel"], nearest: Int32[np.ndarray, "row column"]
) -> Float32[np.ndarray, "row column channel"]:
    """An image from the values of the covered texels (in row order), gutters filled, the rest their mean."""
    flat = nearest.reshape(-1)
    covered = flat == np.arange(flat.size, dtype=np.int32)
    place = np.cumsum(covered, dtype=np.int32) - 1
    image = np.empty((flat.size, values.shape[1]), np.float32)
    image[:] = values.mean(axis=0, dtype=np.float64) if len(values) else 0.0
    reached = np.flatnonzero(flat >= 0)
    image[reached] = values[place[flat[reached]]]
    return image.reshape(*nearest.shape, -1)
