"""Colours of a graph."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import ndarray

from texloom.kernels.cover import colour_greedily
from texloom.kernels.launch import launch


def coloured(edges: ndarray, count: int) -> ndarray:
    """Colours of ``count`` sites, of which the pairs of ``edges`` are neighbours."""
    pairs = np.unique(np.concatenate([edges, edges[:, ::-1]]), axis=0)
    start = np.searchsorted(pairs[:, 0], np.arange(count + 1)).astype(np.int32)
    colour = np.full(count, -7, np.int32)
    launch(colour_greedily, 1, inputs=[start, np.ascontiguousarray(pairs[:, 1], np.int32)], outputs=[colour])
    return colour


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6), count=st.integers(1, 60), dense=st.floats(0, 1))
def test_every_site_takes_the_lowest_colour_that_is_free(seed: int, count: int, dense: float) -> None:
    rng = np.random.default_rng(seed)
    edges = np.argwhere(np.triu(rng.random((count, count)) < dense, 1))
    colour, expected = coloured(edges, count), list[int]()
    for site in range(count):
        taken = {expected[other] for other, own in edges if own == site}
        expected.append(min(set(range(count + 1)) - taken))
    np.testing.assert_array_equal(colour, expected)
    assert (colour[edges[:, 0]] != colour[edges[:, 1]]).all()


@pytest.mark.parametrize("count", [63, 64])
def test_as_many_colours_as_there_are(count: int) -> None:
    """Where all are neighbours of all, each has its own."""
    edges = np.argwhere(np.triu(np.ones((count, count), bool), 1))
    np.testing.assert_array_equal(coloured(edges, count), np.arange(count))
