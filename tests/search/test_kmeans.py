"""Clusters: the nearest centre by another route, and steps that stop where they say."""

import numpy as np
import pytest

from texloom.kernels.launch import use
from texloom.search.kmeans import lloyd, nearest_centre, settle

RNG = np.random.default_rng(11)


def squares(vectors, centres):
    return ((vectors[:, None].astype(float) - centres) ** 2).sum(2)


@pytest.mark.parametrize("count", [1, 5, 16, 37])
def test_the_nearest_centre_is_the_nearest(count):
    vectors = RNG.standard_normal((5000, 9)).astype(np.float32) + 3
    centres = vectors[RNG.permutation(5000)[:count]]
    np.testing.assert_array_equal(nearest_centre(vectors, centres), squares(vectors, centres).argmin(1))
    assert len(nearest_centre(vectors[:0], centres)) == 0


def test_equal_centres_take_the_lowest():
    centres = np.repeat(RNG.standard_normal((7, 4)).astype(np.float32), 3, axis=0)
    label = nearest_centre(RNG.standard_normal((900, 4)).astype(np.float32), centres)
    assert set(label) == set(range(0, 21, 3))


def test_steps_stop_at_the_share_asked_for():
    vectors = RNG.standard_normal((9000, 6)).astype(np.float32)
    found = settle(vectors, 20, kept=0.99)
    assert found.kept >= 0.99 and found.passes < 100
    np.testing.assert_array_equal(found.label, squares(vectors, found.centres).argmin(1))
    before = lloyd(vectors, found.centres, passes=1)
    assert before.kept < 1.0  # 99 % is not all
    settled = settle(vectors, 20, kept=1.0, passes=400)
    assert settled.kept == 1.0 and settled.passes > found.passes
    for i, centre in enumerate(settled.centres):
        np.testing.assert_allclose(centre, vectors[settled.label == i].mean(axis=0), atol=1e-5)


def test_few_different_vectors_make_few_clusters():
    places = RNG.standard_normal((30, 5)).astype(np.float32)
    vectors = places[RNG.integers(0, 30, 4000)]
    found = settle(vectors, 50, kept=0.99)
    assert len(found.centres) == 30 and squares(vectors, found.centres).min(1).max() < 1e-9
    assert len(settle(vectors[:1].repeat(100, axis=0), 10, kept=0.99).centres) == 1


def test_rounding_makes_no_clusters():
    """Five vectors, each many times over and a last bit more or less."""
    five = RNG.standard_normal((5, 8)).astype(np.float32)
    which = np.arange(2000) % 5
    vectors = five[which] * (1 + RNG.integers(-1, 2, (2000, 1)) * np.float32(2**-23)).astype(np.float32)
    found = settle(vectors, 20, kept=1.0)
    assert len(found.centres) == 5
    np.testing.assert_array_equal(found.label, found.label[:5][which])


def test_threads_and_seed():
    vectors = RNG.standard_normal((20000, 6)).astype(np.float32)
    found = []
    for threads in (1, 3):
        use(threads=threads)
        found.append(settle(vectors, 40, kept=0.99, seed=5))
    use(threads=2)
    np.testing.assert_array_equal(found[0].label, found[1].label)
    np.testing.assert_array_equal(found[0].centres, found[1].centres)
    assert (settle(vectors, 40, kept=0.99, seed=6).centres != found[0].centres).any()
