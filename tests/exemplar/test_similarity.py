"""Alike texels are alike, apart, usable, and the same on any number of threads."""

import numpy as np
import pytest

from texloom.errors import ParameterError
from texloom.exemplar.appearance import neighborhood_vectors
from texloom.exemplar.similarity import most_alike
from texloom.kernels.launch import use

RNG = np.random.default_rng(6)


def costs(image, alike):
    vectors = neighborhood_vectors(image, width=7, dimensions=6)
    there = vectors[alike[..., 0], alike[..., 1]]
    return ((there - vectors[:, :, None]) ** 2).sum(axis=-1)


def chebyshev(a, b):
    return np.abs(a - b).max(axis=-1)


def test_a_repeated_image_finds_its_repeats():
    tile = RNG.random((16, 16, 3), np.float32)
    image = np.tile(tile, (3, 3, 1))
    alike = most_alike(image, 2)
    inner = slice(4, -4)
    difference = (alike - np.stack(np.indices((48, 48)), axis=-1)[:, :, None])[inner, inner]
    assert (difference % 16 == 0).all(axis=(2, 3)).mean() > 0.95
    assert np.median(costs(image, alike)[inner, inner]) < 1e-9


def test_the_alike_are_apart_and_near_the_best():
    image = RNG.random((40, 36, 1), np.float32)
    for _ in range(3):
        image = (image + np.roll(image, 1, 0) + np.roll(image, 1, 1)) / 3
    alike = most_alike(image, 4, apart=3)
    here = np.stack(np.indices((40, 36)), axis=-1)
    assert (chebyshev(alike, here[:, :, None]) >= 3).all()
    for a in range(4):
        for b in range(a):
            assert (chebyshev(alike[:, :, a], alike[:, :, b]) >= 3).mean() > 0.99
    vectors = neighborhood_vectors(image, width=7, dimensions=6).reshape(-1, 6)
    gaps = ((vectors[:, None] - vectors) ** 2).sum(axis=-1)
    flat = here.reshape(-1, 2)
    gaps[chebyshev(flat[:, None], flat) < 3] = np.inf
    assert costs(image, alike)[..., 0].mean() < 2.0 * gaps.min(axis=1).mean()


def test_masked_texels_are_never_named():
    usable = RNG.random((24, 24)) > 0.2
    alike = most_alike(RNG.random((24, 24, 2), np.float32), 3, usable=usable)[usable]
    assert usable[alike[..., 0], alike[..., 1]].all()


def test_threads_do_not_matter():
    image = RNG.random((70, 66, 2), np.float32)
    try:
        use(threads=1)
        one = most_alike(image, 4)
        use(threads=2)
        np.testing.assert_array_equal(one, most_alike(image, 4))
    finally:
        use(threads=2)


def test_a_constant_image_is_alike_everywhere():
    assert (
        costs(np.full((12, 12, 1), 0.3, np.float32), most_alike(np.full((12, 12, 1), 0.3, np.float32), 3)).max() < 1e-9
    )


def test_counts_are_checked():
    with pytest.raises(ParameterError, match="count 0"):
        most_alike(np.zeros((8, 8, 1), np.float32), 0)
