"""Means and layers of overlapping patches against their oracles."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import ndarray

from tests import naive
from texloom.arrays import fours
from texloom.kernels import averaging as kernels
from texloom.kernels.launch import launch

FEW = settings(max_examples=12, deadline=None)
seeds = st.integers(0, 10**6)
SITES, PATCHES, WIDTH, MOST = 14, 7, 8, 4


def cover(rng: np.random.Generator) -> tuple[ndarray, ndarray, ndarray]:
    """Start, patch and position of some patches over every site, none over some, each patch once a site."""
    lists = [np.sort(rng.permutation(PATCHES)[: rng.integers(0, PATCHES + 1)]) for _ in range(SITES)]
    start = np.cumsum([0, *map(len, lists)]).astype(np.int32)
    position = rng.random((start[-1], 2)) * (WIDTH - 1)
    whole = rng.random(start[-1]) < 0.5
    position[whole] = np.rint(position[whole])
    return start, np.concatenate(lists).astype(np.int32), position.astype(np.float32)


def by_site(start: ndarray, patch: ndarray, position: ndarray) -> list[list[tuple[int, float, float]]]:
    entries = [(int(p), float(r), float(c)) for p, (r, c) in zip(patch, position, strict=True)]
    return [entries[a:b] for a, b in zip(start[:-1], start[1:], strict=True)]


@FEW
@given(seed=seeds, scale=st.sampled_from([1.0, 0.5, 0.25]))
def test_averages_are_weighted_means_and_bare_sites_keep_their_colour(seed: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    start, patch, position = cover(rng)
    image, colour = rng.random((20, 18, 4), np.float32), rng.random((SITES, 4), np.float32)
    before = colour.copy()
    anchors = rng.integers(0, 11, (PATCHES, 2)).astype(np.int32)
    weight = rng.random(PATCHES, np.float32) + np.float32(0.01)
    inputs = [start, patch, position, anchors, weight, scale, fours(image)]
    launch(kernels.average_patches, SITES, inputs=inputs, outputs=[fours(colour)])

    lists = by_site(start, patch, position)
    covered = np.diff(start) > 0
    expected = naive.average_patches([entries for entries in lists if entries], anchors, weight, scale, image)
    np.testing.assert_allclose(colour[covered], expected.reshape(-1, 4), atol=1e-5)
    np.testing.assert_array_equal(colour[~covered], before[~covered])


@FEW
@given(seed=seeds, ties=st.booleans())
def test_the_heaviest_patches_come_first(seed: int, ties: bool) -> None:
    rng = np.random.default_rng(seed)
    start, patch, position = cover(rng)
    weight = rng.integers(1, 3, PATCHES).astype(np.float32) if ties else rng.random(PATCHES, np.float32)
    entry, share = np.empty((SITES, MOST), np.int32), np.empty((SITES, MOST), np.float32)
    launch(kernels.heaviest_patches, SITES, inputs=[start, patch, weight], outputs=[entry, share])

    lists = [[p for p, _, _ in entries] for entries in by_site(start, patch, position)]
    expected_entry, expected_share = naive.heaviest_patches(lists, weight, MOST)
    np.testing.assert_array_equal(entry, expected_entry)
    np.testing.assert_allclose(share, expected_share, atol=1e-6)


@FEW
@given(seed=seeds, zone=st.sampled_from([0.5, 2.0, 4.0]))
def test_feathered_layers_show_through_from_the_latest_down(seed: int, zone: float) -> None:
    rng = np.random.default_rng(seed)
    start, patch, position = cover(rng)
    rank = rng.permutation(PATCHES).astype(np.int32)
    entry, share = np.empty((SITES, MOST), np.int32), np.empty((SITES, MOST), np.float32)
    inputs = [start, patch, position, rank, WIDTH, zone]
    launch(kernels.feather_layers, SITES, inputs=inputs, outputs=[entry, share])

    expected_entry, expected_share = naive.feather_layers(by_site(start, patch, position), rank, WIDTH, zone, MOST)
    np.testing.assert_array_equal(entry, expected_entry)
    np.testing.assert_allclose(share, expected_share, atol=1e-5)
    np.testing.assert_allclose(share.sum(1), np.diff(start) > 0, atol=1e-5)
