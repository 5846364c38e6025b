"""The border of a square patch, unrolled: where a seam may run."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Int32


@dataclass(frozen=True, eq=False)
class Ring:
    """The outer ``depth`` samples of a ``width × width`` patch as a band around it.

    ``samples[t, d]`` is the sample [row, column] at step t around the border and d samples deep, on the ray from the
    border's sample t to the centre; ``place[sample]`` is the (t, depth) of every sample, the inverse.
    """

    samples: Int32[np.ndarray, "perimeter depth 2"]
    place: Int32[np.ndarray, "sample 2"]


@lru_cache(maxsize=16)
def ring(width: int, depth: int) -> Ring:
    """The band of ``depth`` samples around a patch of ``width``; clockwise from the upper left corner."""
    side = width - 1
    along = np.arange(side)
    border = np.concatenate(
        [
            np.stack([0 * along, along], 1),
            np.stack([along, 0 * along + side], 1),
            np.stack([0 * along + side, side - along], 1),
            np.stack([side - along, 0 * along], 1),
        ]
    )
    centre = side / 2
    shrink = 1 - np.arange(depth) / centre
    samples = np.rint(centre + (border[:, None] - centre) * shrink[:, None]).astype(np.int32)

    row, column = (axis.ravel() for axis in np.mgrid[:width, :width])
    deep = np.minimum(np.minimum(row, column), np.minimum(side - row, side - column))
    # Push every sample out to the border along its ray from the centre.
    offset = np.stack([row, column], 1) - centre
    offset *= centre / np.maximum(np.abs(offset).max(1, keepdims=True), 0.5)
    out = np.clip(np.rint(centre + offset), 0, side).astype(np.int64)
    step = np.zeros((width, width), np.int32)
    step[border[:, 0], border[:, 1]] = np.arange(len(border))
    return Ring(samples, np.ascontiguousarray(np.stack([step[out[:, 0], out[:, 1]], deep], 1).astype(np.int32)))
