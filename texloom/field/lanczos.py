"""Powers of an inverse at the price of a few solves."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Complex128, Float64, Int

_FIRST_LOOK = 6  # steps
_NEGLIGIBLE = 1e-10  # of the vector's length: a coordinate so small ends the steps


def iterated_inverse(
    solve: Callable[[Complex128[np.ndarray, "n"]], Complex128[np.ndarray, "n"]],
    start: Complex128[np.ndarray, "n"],
    *,
    mass: Float64[np.ndarray, "n"],
    part: Int[np.ndarray, "n"],
    steps: int,
) -> Complex128[np.ndarray, "n"]:
    """What so many steps of inverse power iteration lead to, every part at unit length, for a third of the solves.

    That vector lies all but in the span of the first few powers, in whose orthonormal basis the inverse is tridiagonal
    (Lanczos; Saad 2011, "Numerical methods for large eigenvalue problems", algorithm 6.5): there the iteration is run.
    """
    weight = mass / mass.max()  # lengths of any unit
    basis = [normalized(start, weight, part)]
    diagonal: list[np.ndarray] = []
    beside: list[np.ndarray] = []
    while True:
        weighted = weight * basis[-1]
        image = solve(weighted)
        diagonal.append(np.bincount(part, weights=_real_products(weighted, image)))
        if len(basis) > steps or (len(basis) >= _FIRST_LOOK and len(basis) % 2 == 0):
            power = _tridiagonal_power(diagonal, beside, steps)
            if len(basis) > steps or (np.abs(power[-1]) <= _NEGLIGIBLE).all():
                break
        image -= diagonal[-1][part] * basis[-1]
        if beside:
            image -= beside[-1][part] * basis[-2]
        beside.append(np.sqrt(np.bincount(part, weights=weight * _real_products(image, image))))
        image *= (1.0 / np.maximum(beside[-1], 1e-300))[part]
        basis.append(image)
    vector = np.zeros_like(start)
    for along, direction in zip(power, basis, strict=True):
        vector += along[part] * direction
    return normalized(vector, mass, part)


def normalized(
    vector: Complex128[np.ndarray, "n"], mass: Float64[np.ndarray, "n"], part: Int[np.ndarray, "n"]
) -> Complex128[np.ndarray, "n"]:
    """Every part at length 1 under the mass."""
    squared = np.bincount(part, weights=mass * _real_products(vector, vector))
    return vector / np.sqrt(np.maximum(squared, 1e-300))[part]


def _tridiagonal_power(
    diagonal: list[np.ndarray], beside: list[np.ndarray], steps: int
) -> Float64[np.ndarray, "step part"]:
    """First columns of the parts' matrices to the power of ``steps``, at unit length."""
    size, parts = len(diagonal), len(diagonal[0])
    matrix = np.zeros((parts, size, size))
    row = np.arange(size)
    matrix[:, row, row] = np.transpose(diagonal)
    if beside:
        matrix[:, row[1:], row[:-1]] = matrix[:, row[:-1], row[1:]] = np.transpose(beside)
    matrix /= np.maximum(np.abs(matrix).sum(axis=1).max(axis=1), 1e-300)[:, None, None]
    column = np.linalg.matrix_power(matrix, steps)[:, :, 0].T
    return column / np.maximum(np.sqrt((column**2).sum(axis=0)), 1e-300)


def _real_products(a: np.ndarray, b: np.ndarray) -> Float64[np.ndarray, "n"]:
    """Real parts of conj(a) b."""
    return np.real(a) * np.real(b) + np.imag(a) * np.imag(b)
