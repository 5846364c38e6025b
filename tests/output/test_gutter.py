"""Gutters against the exact distance transform."""

import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from texloom.output.gutter import fill, nearest_texels


@pytest.mark.parametrize("width", [0, 1, 5])
def test_gutters_take_the_nearest_texel(width):
    covered = np.random.default_rng(0).random((40, 50)) < 0.02
    nearest = nearest_texels(covered, width)
    exact = distance_transform_edt(~covered)
    np.testing.assert_array_equal(nearest >= 0, exact <= width)
    row, column = np.nonzero(nearest >= 0)
    found = nearest[row, column]
    assert covered.reshape(-1)[found].all()
    np.testing.assert_allclose(np.hypot(found // 50 - row, found % 50 - column), exact[row, column], atol=1e-9)


def test_filling_keeps_covered_texels_and_gives_the_rest_the_mean():
    covered = np.zeros((6, 6), bool)
    covered[0, 0] = covered[5, 5] = True
    image = fill(np.array([[1.0], [3.0]], np.float32), nearest_texels(covered, 1))[..., 0]
    assert image[0, 0] == image[0, 1] == image[1, 0] == 1 and image[5, 5] == image[4, 5] == 3
    assert image[3, 3] == 2
