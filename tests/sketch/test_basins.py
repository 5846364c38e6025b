"""Wells of known depth, and the pass between them."""

import numpy as np
import pytest

from texloom.sketch.reading.basins import basins


def wells(depths, pass_height: float) -> np.ndarray:
    """A trough with a pass between each well and the next."""
    profile = []
    for depth in depths:
        profile += [pass_height, (depth + pass_height) / 2, depth, (depth + pass_height) / 2]
    return np.tile(np.array([*profile, pass_height], np.float32), (5, 1))


@pytest.mark.parametrize("least, count", [(0.5, 3), (2.5, 2), (4.0, 2), (9.0, 1)])
def test_wells_shallower_than_asked_run_together(least, count):
    height = wells([-5.0, -2.0, -8.0], 0.0)
    found = basins(height, lambda saddle, _deep, low, _a, _b: saddle - low < least)
    assert len(np.unique(found)) == count
    assert (found == found[0]).all()


def test_flat_ground_is_one_basin():
    assert (basins(np.zeros((7, 9), np.float32), lambda *_: True) == 0).all()


def test_texels_of_both_are_told():
    told = []
    basins(wells([-5.0, -2.0], 0.0), lambda _s, _d, _l, a, b: told.append(a + b) is None)
    assert told[-1] == 45
