"""Reading, matching, cutting and pasting blocks: every kernel against its oracle."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import ndarray

from tests import naive
from texloom.arrays import fours
from texloom.kernels import patches as kernels
from texloom.kernels.launch import launch
from texloom.synthesis.seams import ring

FLOOR = 1e-4  # what a seam pays even between equal colours
FEW = settings(max_examples=12, deadline=None)
seeds = st.integers(0, 10**6)


def colours(rng: np.random.Generator, *shape: int) -> ndarray:
    return rng.random(shape, np.float32)


@FEW
@given(seed=seeds, corners=st.sampled_from([1, 3]), groups=st.integers(1, 2))
def test_reading_is_the_mean_of_coloured_corners(seed: int, corners: int, groups: int) -> None:
    rng = np.random.default_rng(seed)
    sites = rng.integers(-1, 30, (6, 16, corners)).astype(np.int32)
    weights = rng.dirichlet(np.ones(corners), (6, 16)).astype(np.float32)
    colour, label = colours(rng, 30, 4 * groups), rng.integers(-1, 3, 30).astype(np.int32)
    chosen, samples = np.array([4, 0, 5], np.int32), np.array([3, 0, 15, 7, 8], np.int32)
    values, known = np.full((3, 5, 4 * groups), np.nan, np.float32), np.full((3, 5), np.nan, np.float32)
    dummy = np.ones((1, 1, 1), np.float32)
    inputs = [chosen, samples, sites, weights if corners > 1 else dummy, fours(colour), label]
    launch(kernels.read_patches, known.size, inputs=inputs, outputs=[fours(values), known])

    asked = np.ix_(chosen, samples)
    expected, expected_known = naive.read_patches(sites[asked], weights[asked], colour, label)
    np.testing.assert_array_equal(known, expected_known)
    np.testing.assert_allclose(values, expected, atol=1e-6)


@FEW
@given(seed=seeds, width=st.integers(2, 6), stride=st.integers(1, 3), reach=st.integers(0, 2))
def test_refining_finds_the_cheapest_usable_anchor_nearby(seed: int, width: int, stride: int, reach: int) -> None:
    rng = np.random.default_rng(seed)
    image = colours(rng, 12, 11, 4)
    usable = (rng.random((13 - width, 12 - width)) < 0.7).astype(np.uint8)
    places = np.argwhere(usable)
    anchors = places[rng.integers(0, len(places), (2, 3))].astype(np.int32)
    values, known = colours(rng, 2, width**2, 4), (rng.random((2, width**2)) < 0.6).astype(np.float32)
    known[:, 0] = 1
    best, cost = np.empty((2, 3, 2), np.int32), np.empty((2, 3), np.float32)
    inputs = [anchors, reach, width, stride, fours(values), known, fours(image), usable]
    launch(kernels.refine_anchors, 6, inputs=inputs, outputs=[best, cost])

    for p, k in np.ndindex(2, 3):
        squares = values[p].reshape(width, width, 4), known[p].reshape(width, width)
        place, least = naive.refine_anchor(image, usable, anchors[p, k], reach, *squares, stride)
        np.testing.assert_array_equal(best[p, k], place)
        np.testing.assert_allclose(cost[p, k], least, rtol=1e-5)


def test_equal_anchors_keep_the_first_in_scan_line_order() -> None:
    best, cost = np.empty((1, 1, 2), np.int32), np.empty((1, 1), np.float32)
    values, known, image = np.ones((1, 4, 4), np.float32), np.ones((1, 4), np.float32), np.ones((8, 8, 4), np.float32)
    usable = np.ones((7, 7), np.uint8)
    usable[1] = 0
    inputs = [np.array([[[3, 3]]], np.int32), 2, 2, 1, fours(values), known, fours(image), usable]
    launch(kernels.refine_anchors, 1, inputs=inputs, outputs=[best, cost])
    np.testing.assert_array_equal(best[0, 0], [2, 1])
    assert cost[0, 0] == 0


def cut(image: ndarray, width: int, depth: int, values: ndarray, known: ndarray) -> tuple[ndarray, float, ndarray]:
    """The seam of one patch shown with the block at (1, 2), its cost, and the costs of all places of the ring."""
    band = ring(width, depth).samples
    around, anchor = len(band), np.array([[[1, 2]]], np.int32)
    seam, cost = np.empty((1, 1, around), np.int32), np.empty((1, 1), np.float32)
    scratch = np.empty((1, 2, depth), np.float32), np.empty((1, 2 * around, depth), np.int8)
    inputs = [band, anchor, width, fours(values.reshape(1, -1, 4)), known.reshape(1, -1), fours(image)]
    launch(kernels.cut_seams, 1, inputs=inputs, outputs=[*scratch, seam, cost])
    return seam[0, 0], float(cost[0, 0]), naive.seam_costs(image, band, (1, 2), values, known, FLOOR)


@FEW
@given(seed=seeds, width=st.integers(6, 10), depth=st.integers(2, 3), share=st.floats(0.3, 1))
def test_a_seam_is_the_cheapest_path_around(seed: int, width: int, depth: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    known = (rng.random((width, width)) < share).astype(np.float32)
    seam, cost, places = cut(colours(rng, 14, 14, 4), width, depth, colours(rng, width, width, 4), known)
    laps, path = naive.cheapest_path(np.tile(places, (2, 1)))
    around = len(places)
    middle = np.roll(path[around // 2 : around // 2 + around], around // 2)
    np.testing.assert_allclose(cost, laps / 2, rtol=1e-4, atol=1e-6)
    np.testing.assert_array_equal(seam, middle)
    assert np.abs(np.diff(seam))[np.arange(around - 1) != around // 2 - 1].max() <= 1
    # No dearer than the best path that closes, and so than any straight cut.
    assert cost <= naive.cheapest_closed_path(places) + 1e-4 <= places.sum(0).min() + 2e-4


def test_where_costs_are_plain_the_seam_closes_and_costs_what_it_says() -> None:
    """One cheap groove around the patch, stepping inwards on one side."""
    width, depth = 10, 3
    image, values, known = np.ones((14, 14, 4), np.float32), np.zeros((width, width, 4), np.float32), np.ones((10, 10))
    groove = np.zeros(len(ring(width, depth).samples), int)
    groove[5:12] = 1
    place = ring(width, depth).samples[np.arange(len(groove)), groove]
    values[place[:, 0], place[:, 1]] = 1
    seam, cost, places = cut(image, width, depth, values, known.astype(np.float32))
    assert cost == pytest.approx(FLOOR * len(groove), rel=1e-4)
    assert places[np.arange(len(seam)), seam].sum() == pytest.approx(cost, rel=1e-4)
    assert abs(int(seam[0]) - int(seam[-1])) <= 1


@FEW
@given(seed=seeds, turned=st.booleans(), scale=st.sampled_from([1.0, 0.5]))
def test_pasting_takes_sites_inside_the_seam_or_bare(seed: int, turned: bool, scale: float) -> None:
    rng = np.random.default_rng(seed)
    width, count = 6, 20
    image = colours(rng, 16, 15, 4)
    site = rng.permutation(count).astype(np.int32)  # of every entry: each once, as patches of a batch share none
    entry = rng.permutation(count)[:12].astype(np.int32)
    owner = rng.integers(0, 2, 12).astype(np.int32)
    at = (rng.random((count, 2)) * width - 0.5).astype(np.float32)
    turn = rng.random(count if turned else 1).astype(np.float32)
    chosen, anchors = np.array([7, 3], np.int32), np.array([[0, 9], [4, 2]], np.int32)
    band = ring(width, 2)
    seam = rng.integers(0, 3, (2, len(band.samples))).astype(np.int32)
    label, position = rng.integers(-1, 1, count).astype(np.int32), colours(rng, count, 2)
    site_turn, colour, pasted = np.zeros(count, np.float32), colours(rng, count, 4), np.empty(12, np.uint8)
    was = [a.copy() for a in (label, position, site_turn, colour)]
    inputs = [entry, owner, site, at, turn, chosen, anchors, scale, width, band.place, seam, fours(image), 5]
    outputs = [label, position, site_turn, fours(colour), pasted]
    launch(kernels.paste_blocks, 12, inputs=inputs, outputs=outputs)

    for i, e in enumerate(entry):
        s, p = site[e], owner[i]
        sample = np.clip(np.floor(at[e] + 0.5), 0, width - 1).astype(int) @ [width, 1]
        around, depth = band.place[sample]
        took = was[0][s] < 0 or depth >= seam[p, around]
        assert pasted[i] == took
        where = anchors[p] + np.float32(scale) * at[e]
        assert label[s] == (5 + chosen[p] if took else was[0][s])
        np.testing.assert_allclose(position[s], where if took else was[1][s], rtol=1e-6)
        assert site_turn[s] == (turn[e] if took and turned else 0)
        np.testing.assert_allclose(colour[s], naive.bilinear(image, *position[s]) if took else was[3][s], atol=1e-5)
    untouched = np.setdiff1d(np.arange(count), site[entry])
    for now, before in zip((label, position, site_turn, colour), was, strict=True):
        np.testing.assert_array_equal(now[untouched], before[untouched])
