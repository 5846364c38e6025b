"""Sums over all translations by Fourier transforms, against loops over sites."""

import numpy as np
import pytest
from numpy import ndarray

from texloom.domain.domain import Lattice
from texloom.synthesis.placement import Covering, Placement


def naive(masks: tuple, sample: ndarray, picture: ndarray, known: ndarray, *, wrap: bool, at: tuple) -> Covering:
    """Cost, overlap and fresh sites for every texel that may lie on one site."""
    (usable, core), (rows, columns) = masks, known.shape
    cost, overlap, fresh = np.full(usable.shape, np.inf), np.zeros(usable.shape, int), np.zeros(usable.shape, int)
    for on in np.ndindex(usable.shape):
        total = 0.0
        for texel in np.ndindex(usable.shape):
            row, column = at[0] + texel[0] - on[0], at[1] + texel[1] - on[1]
            if wrap:
                row, column = row % rows, column % columns
            elif not (0 <= row < rows and 0 <= column < columns):
                continue
            fresh[on] += core[texel] and not known[row, column]
            if usable[texel] and known[row, column]:
                overlap[on] += 1
                total += ((sample[texel].astype(float) - picture[row, column]) ** 2).sum()
        if overlap[on]:
            cost[on] = total / overlap[on]
    return Covering(cost, overlap, fresh)


@pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
@pytest.mark.parametrize("shape", [(9, 13), (3, 5), (1, 1)], ids=str)
@pytest.mark.parametrize("masked", [False, True])
def test_all_translations_are_those_of_loops(wrap: bool, shape: tuple[int, int], masked: bool) -> None:
    """Also where the sample is larger than the lattice, and after sites were added, taken away and added again."""
    rng = np.random.default_rng(sum(shape) + masked)
    sample, picture = rng.random((6, 5, 3)).astype(np.float32), rng.random((*shape, 3)).astype(np.float32)
    usable = rng.random((6, 5)) < (0.7 if masked else 2)
    core = usable & (rng.random((6, 5)) < 0.6)
    known = rng.random(shape) < 0.5
    placement = Placement(sample, usable, core, Lattice(*shape, wrap))
    before = rng.random(picture.shape).astype(np.float32)
    changed = known & (rng.random(shape) < 0.3)
    placement.add((0, 0), before, changed)
    placement.take_away((0, 0), before, changed)
    placement.add((0, 0), picture, known)
    for at in np.ndindex(min(shape[0], 3), min(shape[1], 4)):
        found, expected = placement.covering(*at), naive((usable, core), sample, picture, known, wrap=wrap, at=at)
        np.testing.assert_array_equal(found.overlap, expected.overlap)
        np.testing.assert_array_equal(found.fresh, expected.fresh)
        np.testing.assert_allclose(found.cost, expected.cost, atol=1e-9)


def test_rectangles_pass_the_border_of_a_torus() -> None:
    rng = np.random.default_rng(1)
    sample, picture = rng.random((6, 5, 2)).astype(np.float32), rng.random((8, 9, 2)).astype(np.float32)
    every = np.ones((6, 5), bool)
    one, two = (Placement(sample, every, every, Lattice(8, 9, True)) for _ in range(2))
    one.add((0, 0), picture, np.ones((8, 9), bool))
    two.add((5, 7), np.roll(picture, (-5, -7), (0, 1)), np.ones((8, 9), bool))
    np.testing.assert_allclose(two.covering(2, 8).cost, one.covering(2, 8).cost, atol=1e-9)


def test_a_sample_fits_where_it_lies() -> None:
    """Cost 0 at its own place and nowhere else."""
    sample = np.random.default_rng(2).random((12, 10, 3)).astype(np.float32)
    every = np.ones((12, 10), bool)
    placement = Placement(sample, every, every, Lattice(40, 30, False))
    placement.add((17, 9), sample, every)
    cost = placement.covering(17 + 4, 9 + 6).cost
    assert np.argwhere(cost < 1e-9).tolist() == [[4, 6]]
