"""Principal components: the few directions in which vectors differ most."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

from texloom.exemplar.blas import over_blocks, single_threaded

_MOST_ROWS = 4096  # a covariance of this many even picks is as good as that of all, and does not grow with the sample
_BLOCK = 4096  # rows projected at once
_NOTHING = 1e-6  # of the greatest variance: what is less is rounding
_SMALL = 128  # dimensions: up to these NumPy finds all axes sooner than SciPy is imported


@dataclass(frozen=True, eq=False)
class Projection:
    """``(vector - mean) @ axes``; the axes are orthonormal columns, the direction of greatest variance first.

    Of vectors that vary in fewer directions than there are axes, the last axes may be 0.
    """

    mean: Float32[np.ndarray, "dim"]
    axes: Float32[np.ndarray, "dim component"]

    def __call__(self, vectors: Float32[np.ndarray, "row dim"]) -> Float32[np.ndarray, "row component"]:
        """Coordinates along the axes."""
        projected = np.empty((len(vectors), self.axes.shape[1]), np.float32)
        offset = self.mean @ self.axes

        def project(first: int, last: int) -> None:
            projected[first:last] = vectors[first:last] @ self.axes - offset

        over_blocks(project, len(vectors), _BLOCK)
        return projected


def fit(vectors: Float32[np.ndarray, "row dim"], dimensions: int) -> Projection:
    """The ``dimensions`` leading principal axes (all of them, where the vectors have no more).

    At most 4096 evenly picked rows are looked at. An axis points so that its largest entry is positive: signs do not
    depend on the linear algebra library.
    """
    rows = vectors if len(vectors) <= _MOST_ROWS else vectors[np.arange(_MOST_ROWS) * len(vectors) // _MOST_ROWS]
    mean = rows.mean(axis=0, dtype=np.float64).astype(np.float32)
    centred = rows - mean
    with single_threaded():
        axes = _leading_axes(centred, min(dimensions, vectors.shape[1]))
    largest = axes[np.abs(axes).argmax(axis=0), np.arange(axes.shape[1])]
    return Projection(mean, np.ascontiguousarray(axes * np.where(largest < 0, -1.0, 1.0), np.float32))


def _leading_axes(centred: Float32[np.ndarray, "row dim"], count: int) -> np.ndarray:
    """Eigenvectors of the covariance with the greatest eigenvalues, in falling order."""
    rows, dim = centred.shape
    if dim > max(rows, _SMALL):  # the axes lie in the span of the rows: the smaller product finds them
        from scipy.linalg import eigh

        count = min(count, max(rows - 1, 1))
        products = (centred @ centred.T).astype(np.float64)
        values, shares = eigh(products, subset_by_index=(rows - count, rows - 1))
        axes = centred.T @ shares[:, ::-1]
        varies = values[::-1] > _NOTHING * max(values[-1], 0.0)
        return np.where(varies, axes / np.maximum(np.linalg.norm(axes, axis=0), 1e-30), 0.0)
    covariance = (centred.T @ centred).astype(np.float64)
    if dim <= _SMALL:
        return np.linalg.eigh(covariance)[1][:, ::-1][:, :count]
    from scipy.linalg import eigh

    return eigh(covariance, subset_by_index=(dim - count, dim - 1))[1][:, ::-1]
