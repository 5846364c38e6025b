"""Levels lie on every other texel of the finer one, and masked texels never bleed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.exemplar.join import join
from texloom.exemplar.pyramid import gaussian_pyramid, halve, stack_pyramid

RNG = np.random.default_rng(1)


def naive_halve(image):
    """The binomial at every texel by its definition, then every other row and column."""
    rows, columns, _ = image.shape
    weight = np.outer([1, 4, 6, 4, 1], [1, 4, 6, 4, 1]) / 256
    padded = np.pad(image.astype(float), ((2, 2), (2, 2), (0, 0)), mode="reflect")
    full = [[np.tensordot(weight, padded[i : i + 5, j : j + 5], 2) for j in range(columns)] for i in range(rows)]
    return np.array(full)[::2, ::2]


@settings(max_examples=20, deadline=None)
@given(st.integers(3, 21), st.integers(3, 40), st.integers(1, 3))
def test_halving_is_the_binomial(rows, columns, channels):
    image = RNG.random((rows, columns, channels), np.float32)
    np.testing.assert_allclose(halve(image), naive_halve(image), atol=1e-6)


@given(st.integers(1, 40), st.integers(1, 40))
@settings(max_examples=20, deadline=None)
def test_odd_sizes_round_up_and_constants_stay(rows, columns):
    coarse = halve(np.full((rows, columns, 2), 0.3, np.float32))
    assert coarse.shape == ((rows + 1) // 2, (columns + 1) // 2, 2)
    np.testing.assert_allclose(coarse, 0.3, rtol=1e-6)


def test_a_ramp_keeps_its_place():
    """Coarse texel i lies on fine texel 2i: a linear ramp stays itself away from the border."""
    ramp = np.broadcast_to(np.arange(32, dtype=np.float32)[:, None, None], (32, 16, 1))
    np.testing.assert_allclose(halve(ramp)[1:-1, 0, 0], np.arange(32)[::2][1:-1], rtol=1e-6)


def test_masked_texels_count_for_nothing():
    image = np.full((20, 20, 1), 0.25, np.float32)
    usable = RNG.random((20, 20)) > 0.4
    image[~usable] = 1e6
    for level in gaussian_pyramid(image, 3, usable=usable):
        assert level.usable is not None
        np.testing.assert_allclose(level.image[level.usable], 0.25, rtol=1e-4)


def test_levels_are_counted():
    sizes = [level.image.shape[:2] for level in gaussian_pyramid(RNG.random((33, 18, 1), np.float32), 4)]
    assert sizes == [(33, 18), (17, 9), (9, 5), (5, 3)]
    with pytest.raises(ParameterError, match="not 0"):
        gaussian_pyramid(np.zeros((8, 8, 1), np.float32), 0)


def test_a_stack_is_halved_map_by_map_with_its_mask_and_parts():
    samples = [
        Exemplar(from_array(RNG.random((rows, columns, 3), np.float32)).maps | height(rows, columns))
        for rows, columns in ((33, 18), (21, 40))
    ]
    joined = join(samples)
    whole = joined.exemplar
    stacks = stack_pyramid(whole, 3)
    assert stacks[0] is whole and len(stacks) == 3
    for level, stack in enumerate(stacks):
        assert list(stack.maps) == ["basecolor", "height"] and stack.maps["height"].kind == "data"
        for name, m in stack.maps.items():
            expected = gaussian_pyramid(whole.maps[name].image, 3, usable=whole.mask)[level]
            np.testing.assert_array_equal(m.image, expected.image)
            assert stack.mask is not None and expected.usable is not None
            np.testing.assert_array_equal(stack.mask, expected.usable)
        inside = np.zeros(stack.shape, int)
        for part, sample in zip(stack.parts, samples, strict=True):
            assert (part.rows, part.columns) == tuple(-(-length >> level) for length in sample.shape)
            inside[part.slices] += 1
        np.testing.assert_array_equal(inside == 1, stack.mask)  # nothing but the gap is masked here
        np.testing.assert_array_equal(inside <= 1, True)


def height(rows, columns):
    return from_array(RNG.random((rows, columns, 1), np.float32), name="height").maps


def test_a_stack_without_a_mask_has_none():
    stacks = stack_pyramid(from_array(RNG.random((17, 20, 3), np.float32)), 2)
    assert stacks[1].mask is None and stacks[1].parts == () and stacks[1].shape == (9, 10)
