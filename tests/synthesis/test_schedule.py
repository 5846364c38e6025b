"""Order: overlaps by brute force, batches that keep what matters, hops counted."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import ndarray

from tests.synthesis.samples import ball
from texloom.domain.grid import Grid
from texloom.domain.patches import Patches
from texloom.synthesis.schedule import batches, breadth_first, overlaps


def brute_force(patches: Patches) -> ndarray:
    site = np.repeat(np.arange(len(patches.cover_start) - 1), np.diff(patches.cover_start))
    covers = np.zeros((patches.count, len(patches.cover_start) - 1), bool)
    covers[patches.cover_patch, site] = True
    return (covers[:, None] & covers).any(2) & ~np.eye(patches.count, dtype=bool)


@settings(max_examples=15, deadline=None)
@given(wrap=st.booleans(), width=st.integers(3, 12), pitch=st.floats(2, 8), seed=st.integers(0, 99))
def test_overlaps_are_shared_sites(wrap: bool, width: int, pitch: float, seed: int) -> None:
    grid = Grid(17, 14, wrap)
    patches = grid.patches(grid.centres(pitch, seed), width)
    np.testing.assert_array_equal(overlaps(patches), brute_force(patches))


def test_overlaps_on_a_surface_are_shared_sites() -> None:
    surface = ball()
    patches = surface.patches(surface.centres(6, 0), 9)
    np.testing.assert_array_equal(overlaps(patches), brute_force(patches))


def random_graph(seed: int, count: int, degree: float) -> ndarray:
    shared = np.random.default_rng(seed).random((count, count)) < degree / count
    return (shared | shared.T) & ~np.eye(count, dtype=bool)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 999), count=st.integers(1, 40), degree=st.floats(0, 8))
def test_batches_share_no_site_and_keep_the_order_of_neighbours(seed: int, count: int, degree: float) -> None:
    shared = random_graph(seed, count, degree)
    order = np.random.default_rng(seed).permutation(count).astype(np.int32)
    groups = batches(order, shared)
    np.testing.assert_array_equal(np.sort(np.concatenate(groups)), np.arange(count))
    when, turn = np.empty(count, int), np.empty(count, int)
    turn[order] = np.arange(count)
    for number, group in enumerate(groups):
        assert len(group) and not shared[np.ix_(group, group)].any()
        assert (np.diff(turn[group]) > 0).all()
        when[group] = number
    first, second = np.nonzero(shared)
    np.testing.assert_array_equal(when[first] < when[second], turn[first] < turn[second])
    for patch in np.flatnonzero(when):  # none could have been laid earlier
        assert when[patch] - 1 in when[np.flatnonzero(shared[patch])]


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 999), count=st.integers(1, 40), degree=st.floats(0, 4))
def test_breadth_first_goes_by_hops_from_the_first_patch_of_every_part(seed: int, count: int, degree: float) -> None:
    from scipy.sparse.csgraph import connected_components, shortest_path

    shared = random_graph(seed, count, degree)
    order = breadth_first(shared, seed)
    np.testing.assert_array_equal(np.sort(order), np.arange(count))
    part = connected_components(shared, directed=False)[1]
    starts = np.array([np.flatnonzero(part == p)[0] for p in part])
    hops = shortest_path(shared, unweighted=True)[starts, np.arange(count)]
    keys = np.stack([starts[order], hops[order]], 1).tolist()
    assert keys == sorted(keys)


def test_scan_lines_of_a_plane_run_in_parallel() -> None:
    grid = Grid(64, 64)
    patches = grid.patches(grid.centres(8, 0), 12)
    groups = batches(np.arange(patches.count, dtype=np.int32), overlaps(patches))
    assert len(groups) < patches.count / 2
