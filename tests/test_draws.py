"""Draws are a function of their key alone, and look like chance."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom import draws

integers = st.integers(-(2**63), 2**63 - 1)


def test_draws_never_change() -> None:
    """Saved results name their seed, so the numbers behind it are a promise."""
    assert draws.key(7, 1, 2) == 3084099317
    np.testing.assert_array_equal(draws.bits(7, 1, index=np.arange(3)), [1012288270, 2576459115, 2705407017])


@given(seed=integers, counters=st.lists(integers, max_size=3))
def test_any_integer_is_a_seed_and_a_counter(seed: int, counters: list[int]) -> None:
    value = draws.uniform(seed, *counters, index=np.arange(8))
    assert value.dtype == np.float32
    assert ((value >= 0) & (value < 1)).all()
    assert 0 <= draws.key(seed, *counters) < 2**32


@given(seed=st.integers(0, 10**6), count=st.integers(1, 200))
def test_a_draw_does_not_depend_on_the_others(seed: int, count: int) -> None:
    index = np.arange(count)
    whole = draws.bits(seed, 5, index=index)
    np.testing.assert_array_equal(draws.bits(seed, 5, index=index[::-1])[::-1], whole)
    np.testing.assert_array_equal(np.concatenate([draws.bits(seed, 5, index=index[k : k + 1]) for k in index]), whole)


@given(seed=st.integers(0, 10**6), count=st.integers(0, 300))
def test_a_permutation_has_everyone_once(seed: int, count: int) -> None:
    np.testing.assert_array_equal(np.sort(draws.permutation(seed, 1, count=count)), np.arange(count))


def test_uniform_draws_are_uniform() -> None:
    value = draws.uniform(3, 1, index=np.arange(100_000))
    histogram = np.histogram(value, 50, (0, 1))[0]
    assert ((histogram - 2000) ** 2 / 2000).sum() < 110  # chi-square of 49: one in a million
    assert abs(np.corrcoef(value[:-1], value[1:])[0, 1]) < 0.02


@pytest.mark.parametrize("other", [(3, 2), (4, 1), (3, 1, 0), (1, 3), (3,)])
def test_every_counter_makes_a_draw_of_its_own(other: tuple[int, ...]) -> None:
    index = np.arange(10_000)
    one, two = draws.uniform(3, 1, index=index), draws.uniform(*other, index=index)
    assert abs(np.corrcoef(one, two)[0, 1]) < 0.06
