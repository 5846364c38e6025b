"""Regions of a height map: where water gathers, joined across low saddles."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float, Int

Joins = Callable[[float, float, float, int, int], bool]
"""Whether two neighbours are one: the saddle between, the lowest point of each, the texels of each; deeper first."""


def basins(height: Float[np.ndarray, "row column"], joins: Joins) -> Int[np.ndarray, "row column"]:
    """A region for every texel, numbered from 0: basins of steepest descent, joined where ``joins`` says so.

    Saddles are taken from the lowest up, so a basin's depth is known when it first meets a neighbour (persistence).
    Equal heights fall to the lower index.
    """
    basin, count = _descend(height)
    a, b, saddle = _saddles(height, basin, count)
    group = list(range(count))
    low = np.full(count, np.inf)
    np.minimum.at(low, basin.ravel(), height.ravel())
    lowest, texels = low.tolist(), np.bincount(basin.ravel(), minlength=count).tolist()

    def root(i: int) -> int:
        while group[i] != i:
            group[i] = i = group[group[i]]
        return i

    for i, j, pass_height in zip(a.tolist(), b.tolist(), saddle.tolist(), strict=True):
        i, j = root(i), root(j)
        if i == j:
            continue
        if (lowest[j], j) < (lowest[i], i):
            i, j = j, i
        if joins(pass_height, lowest[i], lowest[j], texels[i], texels[j]):
            group[j] = i
            texels[i] += texels[j]
    roots = np.array([root(i) for i in range(count)])
    return np.unique(roots, return_inverse=True)[1].reshape(-1)[basin]


def _descend(height: np.ndarray) -> tuple[np.ndarray, int]:
    """The basin each texel drains to, by its lowest of eight neighbours."""
    rows, columns = height.shape
    rank = np.empty(height.size, np.int64)
    rank[np.argsort(height, axis=None, kind="stable")] = np.arange(height.size)
    rank = rank.reshape(height.shape)
    padded = np.pad(rank, 1, constant_values=height.size)
    lowest, target = rank.copy(), np.arange(height.size).reshape(height.shape)
    for down in (-1, 0, 1):
        for across in (-1, 0, 1):
            beside = padded[1 + down : 1 + down + rows, 1 + across : 1 + across + columns]
            lower = beside < lowest
            lowest[lower] = beside[lower]
            target[lower] = (np.arange(height.size).reshape(height.shape) + down * columns + across)[lower]
    to = target.ravel()
    while (to[to] != to).any():
        to = to[to]
    sinks, basin = np.unique(to, return_inverse=True)
    return basin.reshape(height.shape), len(sinks)


def _saddles(height: np.ndarray, basin: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pairs of neighbouring basins and the lowest pass between them, from the lowest up."""
    pairs, passes = [], []
    for one, other in (
        ((slice(None, -1), slice(None)), (slice(1, None), slice(None))),
        ((slice(None), slice(None, -1)), (slice(None), slice(1, None))),
    ):
        a, b = basin[one], basin[other]
        border = a != b
        pairs.append(np.minimum(a, b)[border] * count + np.maximum(a, b)[border])
        passes.append(np.maximum(height[one], height[other])[border])
    pair, height_of = np.concatenate(pairs), np.concatenate(passes)
    order = np.lexsort((height_of, pair))
    lowest = order[np.flatnonzero(np.diff(pair[order], prepend=-1))]
    lowest = lowest[np.lexsort((pair[lowest], height_of[lowest]))]
    return pair[lowest] // count, pair[lowest] % count, height_of[lowest]
