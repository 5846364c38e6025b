"""The unrolled border: every sample of the band is met, at its own depth."""

import numpy as np
import pytest

from texloom.synthesis.seams import ring


@pytest.mark.parametrize("width, depth", [(8, 2), (8, 4), (12, 4), (9, 3), (32, 11), (64, 21)])
def test_places_of_the_band(width: int, depth: int) -> None:
    band = ring(width, depth)
    perimeter = 4 * (width - 1)
    assert band.samples.shape == (perimeter, depth, 2) and band.place.shape == (width**2, 2)
    row, column = band.samples[..., 0], band.samples[..., 1]
    deep = np.minimum(np.minimum(row, column), width - 1 - np.maximum(row, column))
    np.testing.assert_array_equal(deep, np.broadcast_to(np.arange(depth), deep.shape))

    # Around the border each sample once, in steps of one texel; place is its inverse.
    border = band.samples[:, 0]
    assert len(np.unique(border, axis=0)) == perimeter
    assert (np.abs(border - np.roll(border, 1, axis=0)).sum(1) == 1).all()
    np.testing.assert_array_equal(band.place[border @ [width, 1]], np.stack([np.arange(perimeter), 0 * deep[:, 0]], 1))

    # A sample's place names its depth, and a step around whose ray passes within a texel of it.
    square = np.stack(np.divmod(np.arange(width**2), width), 1)
    np.testing.assert_array_equal(band.place[:, 1], np.minimum(square, width - 1 - square).min(1))
    outer = band.place[:, 1] < depth
    on_ray = band.samples[band.place[outer, 0], band.place[outer, 1]]
    assert np.abs(on_ray - square[outer]).max() <= 1


def test_a_straight_cut_around_leaves_a_square() -> None:
    """A seam of one depth everywhere keeps exactly the samples that deep or deeper."""
    band = ring(12, 4)
    kept = (band.place[:, 1] >= 3).reshape(12, 12)
    assert kept[3:9, 3:9].all() and kept.sum() == 36
