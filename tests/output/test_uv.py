"""What is found in UVs, with the counts named."""

import numpy as np

from tests.output.shapes import grid_mesh
from texloom.output.uv import diagnose_uv


def test_a_plain_square_is_usable():
    found = diagnose_uv(grid_mesh(8)[1])
    assert found.usable and found.problems == () and str(found) == "UVs are usable"


def test_overlap_is_measured():
    uv = grid_mesh(8)[1]
    both = np.concatenate([uv, uv[:64]])
    found = diagnose_uv(both)
    assert not found.usable and abs(found.overlap - 0.5) < 0.01
    assert "overlap on 50" in str(found) and "fresh atlas" in str(found)


def test_mirrored_halves_are_named_but_alone_no_obstacle():
    uv = grid_mesh(8)[1] * 0.5
    found = diagnose_uv(np.concatenate([uv, uv * [-1, 1] + [1, 0]]))
    assert found.usable and found.mirrored == 128 and "128 of 256 faces have mirrored" in str(found)
    assert diagnose_uv(uv * [-1, 1] + [1, 0]).mirrored == 0


def test_wrapping_missing_spanning_and_flat_uvs():
    uv = grid_mesh(4)[1]
    assert diagnose_uv(uv + 0.5).usable and diagnose_uv(uv + 0.5).outside > 0
    assert not diagnose_uv(grid_mesh(1)[1] * 3).usable
    holes = uv.copy()
    holes[:3] = np.nan
    assert diagnose_uv(holes).missing == 3 and not diagnose_uv(holes).usable
    assert not diagnose_uv(np.zeros((5, 3, 2))).usable
