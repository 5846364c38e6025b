"""Bounded search finds exactly what looking at every pair finds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom.kernels import launch
from texloom.metrics.nearest import nearest


def _naive(queries: np.ndarray, targets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    squared = np.square(queries[:, None].astype(np.float64) - targets[None]).sum(-1)
    return squared.argmin(1), squared.min(1)


@given(st.integers(1, 40), st.integers(1, 90), st.sampled_from([3, 28, 29, 60]), st.integers(0, 99))
def test_nearest_equals_looking_at_every_pair(query: int, target: int, dim: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    queries = random.random((query, dim), np.float32)
    targets = random.random((target, dim), np.float32)
    index, squared = _naive(queries, targets)
    found = nearest(queries, targets)
    np.testing.assert_array_equal(found.index, index)
    np.testing.assert_allclose(found.squared, squared, rtol=1e-4)


def test_many_blocks_of_close_targets() -> None:
    random = np.random.default_rng(1)
    targets = np.cumsum(random.standard_normal((5000, 147)).astype(np.float32) * 0.01, axis=0)
    queries = targets[::9] + random.standard_normal((556, 147)).astype(np.float32) * 0.03
    index, squared = _naive_in_parts(queries, targets)
    found = nearest(queries, targets)
    np.testing.assert_array_equal(found.index, index)
    np.testing.assert_allclose(found.squared, squared, rtol=1e-4)


def _naive_in_parts(queries: np.ndarray, targets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    parts = [_naive(part, targets) for part in np.array_split(queries, 100)]
    return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])


def test_ties_keep_the_lowest_index() -> None:
    targets = np.repeat(np.eye(40, dtype=np.float32), 60, axis=0)
    found = nearest(np.eye(40, dtype=np.float32), targets)
    np.testing.assert_array_equal(found.index, 60 * np.arange(40))
    np.testing.assert_array_equal(found.squared, 0.0)


@pytest.mark.parametrize("threads", [1, 2])
def test_threads_do_not_change_the_answer(threads: int) -> None:
    random = np.random.default_rng(2)
    queries, targets = (random.random((count, 50)).astype(np.float32) for count in (700, 900))
    before = launch.thread_count()
    launch.use(threads=threads)
    found = nearest(queries, targets)
    launch.use(threads=before)
    np.testing.assert_array_equal(found.index, _naive_in_parts(queries, targets)[0])
