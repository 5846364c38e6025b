"""How visible the border of a filled hole is."""

import numpy as np
from jaxtyping import Bool, Shaped


def border_step(image: Shaped[np.ndarray, "row column channel"], hole: Bool[np.ndarray, "row column"]) -> float:
    """Mean difference of neighbours across the hole's border, over that of neighbours inside it.

    About 1 where the border cannot be told; NaN where the hole has no border, or no step inside.
    """
    values = image.astype(np.float32)
    across, inside = [], []
    for axis in (0, 1):
        step = np.abs(np.diff(values, axis=axis)).mean(axis=2)
        one = hole[1:] if axis == 0 else hole[:, 1:]
        other = hole[:-1] if axis == 0 else hole[:, :-1]
        across.append(step[one != other])
        inside.append(step[one & other])
    outer, inner = np.concatenate(across), np.concatenate(inside)
    if not len(outer) or not inner.sum():
        return float("nan")
    return float(outer.mean() / inner.mean())
