import numpy as np
import pytest

from texloom.demo.noise import cells, fractal, noise, per_id, quarters


def test_noise_vanishes_on_the_lattice_and_nowhere_jumps() -> None:
    row, column = np.mgrid[-3:5, -3:5].astype(float)
    np.testing.assert_allclose(noise(row, column, 3), 0.0, atol=1e-12)
    row, column = np.mgrid[0:4:0.01, 0:4:0.01]
    values = noise(row, column, 3)
    assert np.abs(np.diff(values, axis=0)).max() < 0.1
    assert 0.3 < np.abs(values).max() < 1.5


def test_a_seed_is_a_pattern() -> None:
    row, column = quarters(16)
    first, second = (fractal(row / 5, column / 5, seed) for seed in (1, 2))
    np.testing.assert_array_equal(first, fractal(row / 5, column / 5, 1))
    assert np.abs(first - second).max() > 0.3


def test_equal_identities_draw_equal_numbers_within_the_range() -> None:
    drawn = per_id(np.array([[7, 7], [8, 9]]), 4, low=2.0, high=3.0)
    assert drawn[0, 0] == drawn[0, 1] != drawn[1, 0]
    assert ((drawn >= 2.0) & (drawn < 3.0)).all()


@pytest.mark.parametrize("relax", [0, 2])
def test_a_cell_is_where_its_centre_is_nearest_and_its_border_where_two_meet(relax: int) -> None:
    row, column = quarters(48)
    cell, border, offset = cells(row, column, pitch=12.0, rounding=1e-3, seed=5, relax=relax)
    centre = np.stack([row, column], -1) - offset
    inside = border > 1.0
    for name in np.unique(cell):
        np.testing.assert_allclose(np.ptp(centre[cell == name], axis=0), 0.0, atol=1e-9)
    # A step of half a texel changes the distance to the border by no more, and it is small where cells change
    change = cell[:, 1:] != cell[:, :-1]
    assert change.any() and (border[:, 1:][change] < 0.51).all()
    assert inside.mean() > 0.5
