"""Principal components: the few directions in which vectors differ most."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

from texloom.exemplar.blas import over_blocks, single_threaded

_MOST_ROWS = 4096  # a covariance of this many even picks is as good as that of all, and does not grow with the sample
_BLOCK = 4096  # rows projected at once
_SMALL = 128  # dimensions: up to these NumPy finds all axes sooner than SciPy is imported


@dataclass(frozen=True, eq=False)
class Projection:
    """``(vector - mean) @ axes``; the axes are orthonormal columns, the direction of greatest variance first."""

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
    dim = centred.shape[1]
    covariance = (centred.T @ centred).astype(np.float64)
    if dim <= _SMALL:
        return np.linalg.eigh(covariance)[1][:, ::-1][:, :count]
    from scipy.linalg import eigh

    return eigh(covariance, subset_by_index=(dim - count, dim - 1))[1][:, ::-1]
