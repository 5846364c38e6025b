"""Corners that can share one vertex of a file: those equal in every attribute."""

import numpy as np
from jaxtyping import Int, Shaped


def shared_corners(
    *attributes: Shaped[np.ndarray, "corner ..."],
) -> tuple[Int[np.ndarray, "vertex"], Int[np.ndarray, "corner"]]:
    """The first corner of each group of equal corners, groups in order of first appearance, and each corner's group.

    Attributes are compared bit by bit (0 and −0 are one).
    """
    count = len(attributes[0])
    group = np.zeros(count, np.int64)
    for attribute in attributes:
        for column in _wide_columns(attribute):
            number = np.unique(column, return_inverse=True)[1]
            group = np.unique(group * (int(number.max(initial=0)) + 1) + number, return_inverse=True)[1]
    _, first, group = np.unique(group, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    return first[order], rank[group]


def _wide_columns(attribute: Shaped[np.ndarray, "corner ..."]) -> list[Int[np.ndarray, "corner"]]:
    """An attribute as 64-bit integers, two floats to a column: fewer columns to sort."""
    flat = np.asarray(attribute).reshape(len(attribute), -1)
    if flat.dtype.kind in "iu":
        return [flat[:, column].astype(np.int64) for column in range(flat.shape[1])]
    padded = np.zeros((len(flat), -(-flat.shape[1] // 2) * 2), np.float32)
    padded[:, : flat.shape[1]] = flat
    padded += np.float32(0)
    wide = padded.view(np.int64)
    return [wide[:, column] for column in range(wide.shape[1])]
