"""Corners that can share one vertex of a file: those equal in every attribute."""

from math import prod

import numpy as np
from jaxtyping import Bool, Int, Shaped, UInt64

_ROUNDS = 16  # of looking for equal corners in a table; each settles over three quarters of what is left
_SLOTS = 4  # of the table, for each corner
_MIX = np.uint64(0x9E3779B97F4A7C15)  # odd, its bits evenly mixed: 2^64 over the golden ratio


def shared_corners(
    *attributes: Shaped[np.ndarray, "corner ..."],
) -> tuple[Int[np.ndarray, "vertex"], Int[np.ndarray, "corner"]]:
    """The first corner of each group of equal corners, groups in order of first appearance, and each corner's group.

    Attributes are compared bit by bit (0 and −0 are one), floats in single precision. O(corner).
    """
    columns = [column for attribute in attributes for column in _wide_columns(attribute)]
    lowest = _lowest_equal(columns, len(attributes[0]))
    first = lowest == np.arange(len(lowest))
    return np.flatnonzero(first), (np.cumsum(first) - 1)[lowest]


def unshared_corners(count: int) -> tuple[Int[np.ndarray, "corner"], Int[np.ndarray, "corner"]]:
    """As ``shared_corners``, of corners that are known to differ: each is a vertex of its own."""
    every = np.arange(count)
    return every, every


def _lowest_equal(columns: list[UInt64[np.ndarray, "corner"]], count: int) -> Int[np.ndarray, "corner"]:
    """The lowest corner equal to each.

    Equal corners meet in one slot of a table, which keeps the lowest of all that come there. Those that find an unequal
    one look again among themselves, in another table; what is left after a few is sorted.
    """
    lowest = np.arange(count, dtype=np.int32)
    left = lowest.copy()
    mixed = _mixed(columns, count)
    for _ in range(_ROUNDS):
        if not len(left):
            return lowest
        bits = max(_SLOTS * len(left) - 1, 1).bit_length()
        slot = (mixed[left] >> np.uint64(64 - bits)).view(np.int64)
        table = np.empty(1 << bits, left.dtype)
        table[slot[::-1]] = left[::-1]  # the last to come stays
        found = table[slot]
        others = np.flatnonzero(found != left)
        equal = _equal(columns, left[others], found[others])
        lowest[left[others[equal]]] = found[others[equal]]
        left = left[others[~equal]]
        mixed *= _MIX
        mixed ^= mixed >> np.uint64(32)
    if len(left):
        rest = np.stack([column[left] for column in columns], axis=1)
        _, first, group = np.unique(rest, axis=0, return_index=True, return_inverse=True)
        lowest[left] = left[first[group.reshape(-1)]]
    return lowest


def _equal(
    columns: list[UInt64[np.ndarray, "corner"]], one: Int[np.ndarray, "pair"], other: Int[np.ndarray, "pair"]
) -> Bool[np.ndarray, "pair"]:
    """Whether two corners are equal in every column."""
    equal = np.ones(len(one), bool)
    for column in columns:
        equal &= column[one] == column[other]
    return equal


def _mixed(columns: list[UInt64[np.ndarray, "corner"]], count: int) -> UInt64[np.ndarray, "corner"]:
    """One number for all columns of a corner, its high bits as good as random."""
    mixed = np.zeros(count, np.uint64)
    for column in columns:
        mixed ^= column
        mixed *= _MIX
        mixed ^= mixed >> np.uint64(32)
    mixed *= _MIX
    return mixed


def _wide_columns(attribute: Shaped[np.ndarray, "corner ..."]) -> list[UInt64[np.ndarray, "corner"]]:
    """An attribute as 64-bit numbers, two floats to a column: fewer columns to compare."""
    flat = np.asarray(attribute).reshape(len(attribute), prod(attribute.shape[1:]))
    if flat.dtype.kind in "iu":
        return [flat[:, column].astype(np.int64).view(np.uint64) for column in range(flat.shape[1])]
    single = np.asarray(flat.T, np.float32, order="C") + np.float32(0)
    bits = [column.view(np.uint32).astype(np.uint64) for column in single]
    for low, high in zip(bits[::2], bits[1::2], strict=False):
        low |= high << np.uint64(32)
    return bits[::2]
