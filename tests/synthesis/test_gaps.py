"""Sites that no patch reached: the texture is continued over them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.synthesis.samples import ball
from texloom.domain.grid import Grid
from texloom.synthesis.gaps import fill_gaps

WIDE = (1 << 20, 1 << 20)  # an exemplar whose border is out of reach


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 999), share=st.floats(0.02, 1), wrap=st.booleans())
def test_a_copy_with_gaps_is_made_whole_again(seed: int, share: float, wrap: bool) -> None:
    rng = np.random.default_rng(seed)
    grid = Grid(11, 9, wrap)
    known = rng.random(grid.count) < share
    known[rng.integers(grid.count)] = True
    place = np.stack(np.divmod(np.arange(grid.count), 9), 1) + np.float32(
        [400, 700]
    )  # far from every border of the exemplar
    position = np.where(known[:, None], place, 0).astype(np.float32)
    before = known.copy()
    fill_gaps(grid, known, position, np.zeros(grid.count, np.float32), WIDE)
    np.testing.assert_array_equal(known, before)
    apart = (position - place) / ([11, 9] if wrap else [1, 1])  # across a torus's border the copy goes on
    np.testing.assert_array_equal(apart, np.rint(apart) if wrap else np.zeros_like(apart))


def test_at_the_border_of_the_exemplar_what_is_continued_stands_still() -> None:
    grid, known = Grid(8, 8), np.zeros(64, bool)
    known[27] = True  # (3, 3), shown from texel (1, 6) of a 4 × 8 exemplar
    position = np.zeros((64, 2), np.float32)
    position[27] = 1, 6
    fill_gaps(grid, known, position, np.zeros(64, np.float32), (4, 8))
    wanted = np.clip(np.stack(np.divmod(np.arange(64), 8), 1) + [-2, 3], 0, [3, 7])
    np.testing.assert_array_equal(position, wanted)


def test_where_nothing_is_known_nothing_changes() -> None:
    position, turn = np.full((12, 2), 5, np.float32), np.zeros(12, np.float32)
    fill_gaps(Grid(3, 4), np.zeros(12, bool), position, turn, WIDE)
    np.testing.assert_array_equal(position, 5)


def test_on_a_surface_gaps_follow_the_frames() -> None:
    """Seen from a filled site, by the rule of ``SourceMap``, a neighbour shows just what its own source says."""
    surface = ball()
    rng = np.random.default_rng(0)
    known = np.ones(surface.count, bool)
    known[rng.permutation(surface.count)[:9]] = False
    position = (20 + 20 * rng.random((surface.count, 2))).astype(np.float32)
    turn = (rng.integers(-1, 3, surface.count) * np.pi / 2).astype(np.float32)
    fill_gaps(surface, known, position, turn, WIDE)
    gaps = np.flatnonzero(~known).astype(np.int32)
    around = surface.neighbourhoods(gaps, 1)
    for i, site in enumerate(gaps):
        fits = []
        for k in np.flatnonzero((around.sites[i] >= 0) & (around.sites[i] != site)):
            other = around.sites[i, k]
            assert around.turn is not None
            same_axes = np.cos(turn[site] - turn[other] + around.turn[i, k]) > 0.999
            (row, column), (c, s) = around.offset[i, k], (np.cos(turn[site]), np.sin(turn[site]))
            seen = position[site] + [row * c + column * s, column * c - row * s]
            fits.append(same_axes and np.abs(seen - position[other]).max() < 1e-3)
        assert any(fits)


@pytest.mark.parametrize("wrap", [False, True])
def test_ties_do_not_depend_on_chance(wrap: bool) -> None:
    grid, known = Grid(6, 6, wrap), np.zeros(36, bool)
    known[[0, 5, 30, 35]] = True
    results = []
    for _ in range(2):
        position = np.arange(72, dtype=np.float32).reshape(36, 2).copy()
        fill_gaps(grid, known, position, np.zeros(36, np.float32), WIDE)
        results.append(position)
    np.testing.assert_array_equal(*results)
