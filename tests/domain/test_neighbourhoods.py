"""Stencils: everything near, symmetric, and ever thinner."""

import numpy as np
import pytest

from texloom.domain.neighbourhoods import NEAR, square, stencil


@pytest.mark.parametrize("reach", [0, 1, 2, 3, 4, 8, 9, 17, 18, 40])
def test_all_near_steps_then_fewer_and_no_farther_than_the_reach(reach: int) -> None:
    steps = stencil(reach)
    there = {(int(r), int(c)) for r, c in steps}
    far = np.abs(steps).max(1)
    near = min(reach, NEAR)
    assert len(there) == len(steps) and tuple(steps[0]) == (0, 0)
    assert (far <= near).sum() == (2 * near + 1) ** 2
    assert far.max() <= reach and reach - far.max() <= max(0, reach // 3)
    assert (np.diff(far) >= 0).all()
    for r, c in there:
        assert {(-r, c), (r, -c), (c, r)} <= there


def test_rings_thin_out() -> None:
    assert [len(stencil(reach)) for reach in (0, 1, 2, 3, 5, 6, 9, 18, 36)] == [1, 9, 25, 49, 49, 65, 89, 129, 169]
    distant = stencil(36)[np.abs(stencil(36)).max(1) > 18]
    assert (distant % 12 == 0).all()


@pytest.mark.parametrize("reach", [0, 1, 4])
def test_a_square_is_whole(reach: int) -> None:
    steps = square(reach)
    assert {tuple(step) for step in steps.tolist()} == {
        (r, c) for r in range(-reach, reach + 1) for c in range(-reach, reach + 1)
    }
    assert len(steps) == (2 * reach + 1) ** 2 and (np.diff(np.abs(steps).max(1)) >= 0).all()
