"""The grid's patches are index arithmetic: what they read and cover can be counted by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from texloom.domain.domain import Lattice
from texloom.domain.grid import Grid
from texloom.errors import FieldError, ParameterError
from texloom.sources import SourceMap

sizes = st.integers(1, 20)


@settings(max_examples=30, deadline=None)
@given(rows=sizes, columns=sizes, width=st.integers(1, 12), wrap=st.booleans(), centre=st.integers(0, 10**6))
def test_patches_are_windows_of_the_site_numbers(rows: int, columns: int, width: int, wrap: bool, centre: int) -> None:
    grid = Grid(rows, columns, wrap)
    row, column = divmod(centre % grid.count, columns)
    patches = grid.patches(np.array([row * columns + column], np.int32), width)

    numbers = np.pad(
        np.arange(grid.count).reshape(rows, columns), width, **({"mode": "wrap"} if wrap else {"constant_values": -1})
    )
    top, left = row + width - width // 2, column + width - width // 2
    np.testing.assert_array_equal(patches.sites.reshape(width, width), numbers[top : top + width, left : left + width])


@settings(max_examples=30, deadline=None)
@given(rows=sizes, columns=sizes, width=st.integers(1, 24), wrap=st.booleans(), seed=st.integers(0, 99))
def test_cover_is_the_inverse_of_reading(rows: int, columns: int, width: int, wrap: bool, seed: int) -> None:
    grid = Grid(rows, columns, wrap)
    centres = np.random.default_rng(seed).integers(0, grid.count, 5).astype(np.int32)
    patches = grid.patches(centres, width)
    site = np.repeat(np.arange(grid.count), np.diff(patches.cover_start))
    sample = (patches.cover_position @ [width, 1]).astype(int)
    np.testing.assert_array_equal(patches.sites[patches.cover_patch, sample, 0], site)
    # every (site, patch) once, patches increasing within a site, none forgotten
    pairs = site * len(centres) + patches.cover_patch
    assert np.all(np.diff(pairs) > 0)
    seen = [np.unique(row[row >= 0]) * len(centres) + patch for patch, row in enumerate(patches.sites[..., 0])]
    np.testing.assert_array_equal(pairs, np.sort(np.concatenate(seen)))


@pytest.mark.parametrize("wrap", [False, True])
def test_centres_cover_the_whole_grid(wrap: bool) -> None:
    grid = Grid(50, 71, wrap)
    for pitch in (5.0, 8.0, 24.0):
        patches = grid.patches(grid.centres(pitch, seed=3), int(pitch) + 2)
        assert np.diff(patches.cover_start).min() >= 1


def test_rolling_the_centres_of_a_torus_rolls_the_patches() -> None:
    grid = Grid(16, 20, wrap=True)
    centres = grid.centres(6, seed=0)
    row, column = np.divmod(centres, 20)
    moved = (((row + 5) % 16) * 20 + (column + 7) % 20).astype(np.int32)
    numbers = np.arange(grid.count).reshape(16, 20)
    rolled = np.roll(numbers, (-5, -7), axis=(0, 1)).ravel()
    np.testing.assert_array_equal(grid.patches(moved, 8).sites, rolled[grid.patches(centres, 8).sites])


@pytest.mark.parametrize("wrap", [False, True])
def test_a_constant_field_gives_the_plain_patches(wrap: bool) -> None:
    plain, along = Grid(24, 31, wrap), Grid(24, 31, wrap, field=np.tile([0.0, 2.0], (24, 31, 1)))
    centres = plain.centres(9, seed=1)
    a, b = plain.patches(centres, 10), along.patches(centres, 10)
    value = np.random.default_rng(0).random(plain.count)
    assert b.weights is not None
    np.testing.assert_array_equal(a.sites[..., 0] >= 0, b.sites[..., 0] >= 0)
    read = np.where(b.sites[..., 0] >= 0, (value[b.sites] * b.weights).sum(axis=-1), 0)
    np.testing.assert_allclose(read, np.where(a.sites[..., 0] >= 0, value[a.sites[..., 0]], 0), atol=1e-4)
    if wrap:
        np.testing.assert_array_equal(a.cover_start, b.cover_start)
        np.testing.assert_array_equal(a.cover_patch, b.cover_patch)
        np.testing.assert_allclose(a.cover_position, b.cover_position, atol=1e-4)


def test_magnitude_spreads_samples_and_thins_centres() -> None:
    field = np.tile([0.0, 1.0], (64, 64, 1))
    small = Grid(64, 64, True, field=field, magnitude=np.ones((64, 64)))
    large = Grid(64, 64, True, field=field, magnitude=np.full((64, 64), 2.0))
    assert 3.0 < len(small.centres(5, 0)) / len(large.centres(5, 0)) < 5.0
    np.testing.assert_allclose(large.area, 0.25)
    patches = large.patches(np.array([32 * 64 + 32], np.int32), 8)
    assert patches.weights is not None
    column = (np.arange(64 * 64) % 64)[patches.sites[0]]
    position = (column * patches.weights[0]).sum(axis=-1).reshape(8, 8)
    np.testing.assert_allclose(position, np.tile(32 + 2 * (np.arange(8) - 4), (8, 1)), atol=1e-4)


def test_radial_network_follows_rays_and_circles() -> None:
    row, column = np.mgrid[:64, :64]
    outward = np.stack([row + 60.0, column + 60.0], axis=-1)  # rays from a point off the grid
    grid = Grid(64, 64, field=outward)
    patches = grid.patches(np.array([32 * 64 + 32], np.int32), 16)
    assert patches.weights is not None
    place = (outward.reshape(-1, 2)[patches.sites[0]] * patches.weights[0][..., None]).sum(axis=1).reshape(16, 16, 2)
    radius, angle = np.hypot(*place.T).T, np.arctan2(*place.T).T
    np.testing.assert_allclose(np.diff(radius, axis=1), 1, atol=0.01)
    np.testing.assert_allclose(np.ptp(radius, axis=0), 0, atol=0.01)
    assert np.ptp(angle, axis=1).max() < 0.05  # half way between a ray and equal steps along circles


def test_bad_grids_are_refused() -> None:
    with pytest.raises(ParameterError, match="no site"):
        Grid(0, 5)
    with pytest.raises(FieldError, match="directions are 0"):
        Grid(4, 4, field=np.zeros((4, 4, 2)))
    with pytest.raises(FieldError, match="shape"):
        Grid(4, 4, field=np.ones((4, 5, 2)))
    with pytest.raises(ParameterError, match="too thin"):
        Grid(2, 4, field=np.ones((2, 4, 2)))
    with pytest.raises(FieldError, match="above 0"):
        Grid(4, 4, field=np.ones((4, 4, 2)), magnitude=np.zeros((4, 4)))


def test_sources_of_a_field_are_told_in_image_axes() -> None:
    """A field that runs up the picture turns every source by a quarter, counter-clockwise."""
    field = np.zeros((4, 5, 2))
    field[..., 0] = -1.0
    grid = Grid(4, 5, field=field)
    plain = SourceMap(np.zeros((20, 1, 2), np.float32), np.ones((20, 1), np.float32))
    turned = grid.in_image_axes(plain)
    assert turned.turn is not None
    np.testing.assert_allclose(turned.turn, np.pi / 2, atol=1e-6)
    assert Grid(4, 5).in_image_axes(plain) is plain


def test_whole_rows_unless_a_field_turns_the_frames() -> None:
    plane, torus = Grid(4, 5).lattice, Grid(4, 5, wrap=True).lattice
    assert plane is not None and plane == Lattice(4, 5, False)
    assert torus is not None and torus == Lattice(4, 5, True)
    assert Grid(4, 5, field=np.ones((4, 5, 2))).lattice is None
    row, column = np.array([1, -1, 4]), np.array([4, 0, 6])
    np.testing.assert_array_equal(plane.site_at(row, column), [9, -1, -1])
    np.testing.assert_array_equal(torus.site_at(row, column), [9, 15, 1])
