"""A patch vector is the patch; masked patches are left out."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.patches import boundary_samples, even_samples, patch_vectors

RNG = np.random.default_rng(4)


@settings(max_examples=25, deadline=None)
@given(st.integers(8, 16), st.integers(8, 16), st.integers(1, 8), st.integers(1, 3), st.integers(1, 3))
def test_each_row_reads_its_patch(rows, columns, width, step, channels):
    image = RNG.random((rows, columns, channels), np.float32)
    usable = RNG.random((rows, columns)) > 0.01
    usable[:width, :width] = True
    samples = even_samples(width, min(3, width))
    found = patch_vectors(image, width, samples, step=step, usable=usable)
    expected = [
        (i, j)
        for i in range(0, rows - width + 1, step)
        for j in range(0, columns - width + 1, step)
        if usable[i : i + width, j : j + width].all()
    ]
    assert found.anchors.tolist() == [list(anchor) for anchor in expected]
    for (i, j), vector in zip(expected, found.vectors, strict=True):
        np.testing.assert_array_equal(vector.reshape(-1, channels), image[i + samples[:, 0], j + samples[:, 1]])


def test_even_samples_are_spread_and_all_at_full_width():
    assert even_samples(32, 8)[:9, 1].tolist() == [2, 6, 10, 14, 18, 22, 26, 30, 2]
    np.testing.assert_array_equal(even_samples(5, 5), np.indices((5, 5)).reshape(2, -1).T)


@given(st.integers(1, 12), st.integers(1, 12))
def test_the_zone_is_a_ring(width, zone):
    zone = min(zone, width)
    inner = max(width - 2 * zone, 0)
    samples = boundary_samples(width, zone)
    assert len(np.unique(samples, axis=0)) == len(samples) == width**2 - inner**2
    inside = samples[(samples >= zone).all(axis=1) & (samples < width - zone).all(axis=1)]
    assert len(inside) == 0
    assert abs(len(boundary_samples(width, zone, step=2)) - len(samples) / 2) <= 0.5


def test_what_does_not_fit_is_refused():
    image = np.zeros((20, 10, 1), np.float32)
    with pytest.raises(ExemplarError, match="10x20 texels, but a patch needs 16x16"):
        patch_vectors(image, 16, even_samples(16, 4))
    holes = np.ones((20, 10), bool)
    holes[::4, ::4] = False
    with pytest.raises(ExemplarError, match="no 8x8 patch lies inside the mask, which keeps 185 of 200"):
        patch_vectors(image, 8, even_samples(8, 4), usable=holes)
    with pytest.raises(ParameterError, match="9x9 samples"):
        even_samples(8, 9)
    with pytest.raises(ParameterError, match="9 texels"):
        boundary_samples(8, 9)
