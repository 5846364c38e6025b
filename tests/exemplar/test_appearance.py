"""Appearance vectors keep the distances of neighbourhoods, and tell features from ground."""

import numpy as np
import pytest

from texloom.exemplar.appearance import appearance_vectors, feature_distance, feature_mask, fill_masked
from texloom.exemplar.pca import fit

RNG = np.random.default_rng(2)


def naive_neighborhoods(image):
    """Weighted 5×5 neighbourhoods, one texel after the other."""
    offset = np.arange(-2, 3)
    weight = np.exp(-0.5 * (offset[:, None] ** 2 + offset[None, :] ** 2))
    root = np.sqrt(weight / weight.sum())[..., None]
    padded = np.pad(image, ((2, 2), (2, 2), (0, 0)), mode="symmetric")
    rows, columns, _ = image.shape
    return np.array([[(padded[i : i + 5, j : j + 5] * root).ravel() for j in range(columns)] for i in range(rows)])


def test_all_components_keep_every_distance():
    image = RNG.random((12, 10, 2), np.float32)
    exact = naive_neighborhoods(image).reshape(120, -1)
    found = appearance_vectors(image, dimensions=50, feature_weight=0.0).reshape(120, -1)
    a, b = RNG.integers(0, 120, (2, 200))
    np.testing.assert_allclose(
        ((found[a] - found[b]) ** 2).sum(1), ((exact[a] - exact[b]) ** 2).sum(1), rtol=1e-3, atol=1e-6
    )


def test_four_components_hold_most_of_a_smooth_texture():
    row, column = np.indices((40, 40))
    image = np.sin(0.4 * row + 0.2 * column)[..., None].astype(np.float32)
    total = naive_neighborhoods(image).reshape(1600, -1).var(axis=0).sum()
    found = appearance_vectors(image, feature_weight=0.0)
    assert found.shape == (40, 40, 4)
    assert found.var(axis=(0, 1)).sum() > 0.999 * total


def test_the_feature_distance_is_the_fifth_component():
    image = np.zeros((20, 20, 1), np.float32)
    image[:, :8] = 1.0
    vectors = appearance_vectors(image, feature_weight=0.5)
    assert vectors.shape == (20, 20, 5)
    np.testing.assert_allclose(vectors[..., 4].std(), 0.5 * vectors[..., 0].std(), rtol=1e-4)
    steps = np.diff(vectors[10, :, 4])
    np.testing.assert_allclose(steps, steps[0], rtol=1e-3)


def test_distance_is_signed_and_measured_to_the_edge():
    mask = np.zeros((6, 10), bool)
    mask[:, :4] = True
    np.testing.assert_array_equal(feature_distance(mask)[2], [3.5, 2.5, 1.5, 0.5, -0.5, -1.5, -2.5, -3.5, -4.5, -5.5])
    assert not feature_distance(np.ones((6, 10), bool)).any()


def test_the_mask_splits_two_kinds_of_texel():
    dark = RNG.random((16, 16)) < 0.3
    image = np.where(dark, 0.2, 0.7)[..., None] + 0.05 * RNG.random((16, 16, 1))
    np.testing.assert_array_equal(feature_mask(image.astype(np.float32)), ~dark)


def test_a_constant_image_has_finite_vectors():
    vectors = appearance_vectors(np.full((10, 10, 3), 0.4, np.float32))
    np.testing.assert_allclose(vectors, 0, atol=1e-5)


def test_masked_texels_take_the_nearest_usable():
    image = np.arange(10, dtype=np.float32).reshape(1, 10, 1)
    usable = np.array([[True, False, False, True, True, True, True, True, False, False]])
    assert fill_masked(image, usable).ravel().tolist() == [0, 0, 3, 3, 4, 5, 6, 7, 7, 7]


@pytest.mark.parametrize("rows", [50, 6000])
def test_principal_axes_are_orthonormal_and_in_order(rows):
    vectors = (RNG.random((rows, 12)) * np.linspace(1, 3, 12)).astype(np.float32)
    projection = fit(vectors, 5)
    np.testing.assert_allclose(projection.axes.T @ projection.axes, np.eye(5), atol=1e-5)
    spread = projection(vectors).var(axis=0)
    assert (np.diff(spread) < 0.05 * spread[:-1]).all()
    largest = np.abs(projection.axes).argmax(axis=0)
    assert (projection.axes[largest, range(5)] > 0).all()
