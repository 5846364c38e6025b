"""Windows in a tree: each finds itself, and the nearest in the reduced space is nearest of all."""

import numpy as np
import pytest
from numpy import ndarray

from tests import naive
from tests.synthesis.samples import blobs
from texloom.arrays import in_fours
from texloom.search.window_tree import WindowTree

IMAGE = in_fours(blobs(30).astype(np.float32) / np.float32(255))
HALF = np.stack(np.divmod(np.arange(25), 5), 1).astype(np.int32)[:15] - 2  # rows above and the middle one


def usable(every: int = 1) -> ndarray:
    """Where whole windows lie; of the texels there each ``every``-th."""
    inside = np.zeros(IMAGE.shape[:2], np.uint8)
    inside[2:-2, 2:-2] = 1
    inside.ravel()[np.flatnonzero(inside)[np.arange(np.count_nonzero(inside)) % every > 0]] = 0
    return inside


def windows(centre: ndarray, steps: ndarray) -> ndarray:
    return IMAGE[tuple(np.moveaxis(centre[:, None] + steps, 2, 0))]


def projected(tree: WindowTree, steps: ndarray) -> ndarray:
    flat = tree.axes.reshape(-1, tree.axes.shape[-1])
    return ((windows(tree.centre, steps) - tree.mean).reshape(len(tree.centre), -1) @ flat).astype(np.float32)


@pytest.mark.parametrize("dimensions", [1, 6, 8])
def test_a_window_of_the_sample_is_nearest_to_itself(dimensions: int) -> None:
    tree = WindowTree.of(IMAGE, usable(), HALF, dimensions)
    assert tree.axes.shape == (15, 4, -(-dimensions // 4) * 4)
    np.testing.assert_array_equal(tree.centre, np.argwhere(usable()))
    found, cost = tree.tree.nearest(projected(tree, HALF), 1)
    np.testing.assert_allclose(cost, 0, atol=1e-6)
    if dimensions > 1:
        np.testing.assert_array_equal(found[:, 0], np.arange(len(tree.centre)))


def test_the_axes_are_those_of_greatest_variance() -> None:
    """Orthonormal over samples and channels; no other eight keep more of the windows' variance."""
    tree = WindowTree.of(IMAGE, usable(), HALF, 8)
    flat = tree.axes.reshape(-1, 8)
    np.testing.assert_allclose(flat.T @ flat, np.eye(8), atol=1e-5)
    whole = windows(tree.centre, HALF).reshape(len(tree.centre), -1)
    np.testing.assert_allclose(tree.mean.ravel(), whole.mean(axis=0), atol=1e-5)
    best = np.linalg.svd(whole - whole.mean(axis=0), compute_uv=False)
    kept = (projected(tree, HALF) ** 2).sum()
    assert kept == pytest.approx((best[:8] ** 2).sum(), rel=1e-3)


def test_brute_force_in_the_reduced_space_agrees() -> None:
    tree = WindowTree.of(IMAGE, usable(), HALF, 8)
    rng = np.random.default_rng(1)
    seen = rng.random((40, 15, 4)).astype(np.float32)
    flat = tree.axes.reshape(-1, 8)
    queries = ((seen - tree.mean).reshape(40, -1) @ flat).astype(np.float32)
    found, _ = tree.tree.nearest(queries, 1)
    every = windows(tree.centre, HALF)
    expected = [naive.nearest_window(every, tree.mean, tree.axes, wanted) for wanted in seen]
    np.testing.assert_array_equal(found[:, 0], expected)


@pytest.mark.parametrize("every", [7, 100, 400])
def test_few_windows_are_found_too(every: int) -> None:
    """Even fewer than there are components."""
    tree = WindowTree.of(IMAGE, usable(every), HALF, 8)
    count = -(-26 * 26 // every)
    assert len(tree.centre) == count
    assert {name: len(part) for name, part in tree.arrays.items()}["centre"] == count
    found, _ = tree.tree.nearest(projected(tree, HALF), 1)
    np.testing.assert_array_equal(found[:, 0], np.arange(count))
    assert tree.arrays["axes"].shape[2] == tree.arrays["points"].shape[1]
