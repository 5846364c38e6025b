"""Does the picture tile: is the step across its borders larger than steps inside it."""

import numpy as np
from jaxtyping import Float

from texloom.arrays import Image


def seam_ratio(image: Image) -> float:
    """Mean difference across the wrap-around over the 99th percentile of inner rows' (columns'), on the worse axis.

    At most 1: no seam to see. A picture without any inner difference has ratio 0 where its borders agree too, else
    infinity.
    """
    return max(_axis_ratio(image), _axis_ratio(image.swapaxes(0, 1)))


def _axis_ratio(image: Image) -> float:
    inner = row_steps(image)
    across = float(np.abs(image[0] - image[-1]).mean(dtype=np.float64))
    usual = float(np.percentile(inner, 99)) if len(inner) else 0.0
    if usual == 0.0:
        return 0.0 if across == 0.0 else float("inf")
    return across / usual


def row_steps(image: Image) -> Float[np.ndarray, "step"]:
    """Mean absolute difference of every row to the next."""
    return np.abs(np.diff(image, axis=0)).mean(axis=(1, 2), dtype=np.float64)
