"""The sliced Wasserstein distance against a plain one, and its laws."""

import numpy as np
import pytest

from texloom.metrics.distribution import _directions, halve, sliced_wasserstein


def _image(seed: int, shape: tuple[int, ...] = (40, 36, 3)) -> np.ndarray:
    return np.random.default_rng(seed).random(shape, np.float32)


def _naive_level(sample: np.ndarray, result: np.ndarray) -> float:
    """Patch by patch, quantiles by numpy's Hazen rule: the same middles of equal shares."""

    def vectors(image: np.ndarray) -> np.ndarray:
        rows, columns = image.shape[0] - 6, image.shape[1] - 6
        patches = [image[r : r + 7, c : c + 7].transpose(2, 0, 1).ravel() for r in range(rows) for c in range(columns)]
        return np.array(patches, np.float64)

    at = (np.arange(1024) + 0.5) / 1024
    ours, theirs = vectors(result), vectors(sample)
    directions = _directions(ours.shape[1]).astype(np.float64)
    distances = [
        np.abs(np.quantile(ours @ d, at, method="hazen") - np.quantile(theirs @ d, at, method="hazen")).mean()
        for d in directions
    ]
    return float(np.mean(distances))


def test_equals_the_plain_sum() -> None:
    sample, result = _image(1), _image(2, (30, 44, 3)) * 0.8
    levels = [(sample, result)]
    for _ in range(2):
        levels.append((halve(levels[-1][0]), halve(levels[-1][1])))
    levels = [(a, b) for a, b in levels if min(a.shape[:2] + b.shape[:2]) >= 7]
    assert len(levels) == 3
    expected = 100.0 * np.mean([_naive_level(a, b) for a, b in levels])
    assert sliced_wasserstein(sample, result) == pytest.approx(expected, rel=1e-4)


def test_a_shift_of_all_values_is_seen_whole() -> None:
    sample = _image(3)
    shift = 0.125
    expected = 100.0 * shift * np.abs(_directions(147).sum(1)).mean()
    assert sliced_wasserstein(sample, sample + np.float32(shift)) == pytest.approx(expected, rel=1e-3)


def test_is_symmetric_and_zero_on_itself() -> None:
    sample, result = _image(4), _image(5, (50, 21, 3))
    assert sliced_wasserstein(sample, sample) == 0.0
    assert sliced_wasserstein(sample, result) == pytest.approx(sliced_wasserstein(result, sample), rel=1e-6)


def test_where_patches_are_does_not_matter() -> None:
    """Repeating a whole torus permutes patches and multiplies all alike."""
    tile = np.pad(_image(6, (16, 16, 3)), ((0, 6), (0, 6), (0, 0)), mode="wrap")
    rolled = np.pad(np.roll(tile[:16, :16], (5, 11), (0, 1)), ((0, 6), (0, 6), (0, 0)), mode="wrap")
    # The first level only: halving a padded torus pairs other texels.
    from texloom.metrics.distribution import projected_wasserstein
    from texloom.metrics.patches import patch_vectors

    assert projected_wasserstein(patch_vectors(tile), patch_vectors(rolled)) < 1e-6


def test_grows_with_noise() -> None:
    sample = _image(7, (64, 64, 3)) * 0.2 + 0.4
    noise = np.random.default_rng(8).standard_normal(sample.shape).astype(np.float32)
    distances = [sliced_wasserstein(sample, sample + np.float32(amount) * noise) for amount in (0.0, 0.05, 0.1, 0.2)]
    assert distances == sorted(distances) and distances[0] == 0.0 and distances[-1] > 0.5


def test_halving_means_squares_of_four() -> None:
    image = np.arange(15, dtype=np.float32).reshape(3, 5, 1)
    np.testing.assert_allclose(halve(image)[..., 0], [[3.0, 5.0]])
