"""Principal axes against the plain covariance, by whichever product they are found."""

import numpy as np
import pytest

from texloom.exemplar.pca import fit

SHAPES = {"tall": (300, 20), "wide": (60, 150), "wide and few": (9, 140), "square": (130, 130)}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_axes_are_those_of_the_covariance(shape: tuple[int, int]) -> None:
    rows, dim = shape
    rng = np.random.default_rng(rows)
    basis = np.linalg.qr(rng.normal(size=(dim, 6)))[0]
    values = (rng.normal(size=(rows, 6)) * 2.0 ** -np.arange(6)) @ basis.T + 3 + 1e-3 * rng.random(shape)
    vectors = values.astype(np.float32)
    projection = fit(vectors, 5)
    variance, axes = np.linalg.eigh(np.cov(vectors.T.astype(float), ddof=0))
    leading = axes[:, ::-1][:, :5]
    leading *= np.sign(leading[np.abs(leading).argmax(0), np.arange(5)])
    np.testing.assert_allclose(np.abs((projection.axes * leading).sum(0)), 1, atol=1e-4)
    assert (projection.axes[np.abs(projection.axes).argmax(0), np.arange(5)] > 0).all()
    np.testing.assert_allclose(projection.axes.T @ projection.axes, np.eye(5), atol=1e-4)
    np.testing.assert_allclose(projection.mean, vectors.mean(0), rtol=1e-5)
    np.testing.assert_allclose(projection(vectors).var(0), variance[::-1][:5], rtol=1e-3)


def test_wide_vectors_that_vary_in_few_directions_get_no_made_up_axes() -> None:
    rng = np.random.default_rng(0)
    vectors = (rng.normal(size=(40, 3)) @ rng.normal(size=(3, 300))).astype(np.float32)
    axes = fit(vectors, 8).axes
    lengths = np.linalg.norm(axes, axis=0)
    np.testing.assert_allclose(lengths[:3], 1, atol=1e-5)
    np.testing.assert_array_equal(lengths[3:], 0)


@pytest.mark.parametrize("rows", [1, 2])
def test_hardly_any_wide_vectors(rows: int) -> None:
    vectors = np.random.default_rng(1).random((rows, 300), np.float32)
    projection = fit(vectors, 8)
    assert projection.axes.shape == (300, 1)
    distance = np.linalg.norm(vectors[-1] - vectors[0])
    np.testing.assert_allclose(np.ptp(projection(vectors)), distance, rtol=1e-4, atol=1e-6)
