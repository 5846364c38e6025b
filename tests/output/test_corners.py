"""Corners that can share a vertex: equal ones and no others, whatever their hashes."""

import numpy as np
import pytest

from texloom.output import corners
from texloom.output.corners import shared_corners

RNG = np.random.default_rng(11)


def naive(*attributes):
    """First corners and groups, looked up row by row; + 0 makes −0 zero."""
    seen, first, group = {}, [], []
    for corner, rows in enumerate(zip(*attributes, strict=True)):
        key = tuple(
            (np.asarray(row, np.float32) + np.float32(0)).tobytes() if np.asarray(row).dtype.kind == "f" else str(row)
            for row in rows
        )
        if key not in seen:
            seen[key] = len(first)
            first.append(corner)
        group.append(seen[key])
    return np.array(first, int), np.array(group, int)


def few_values(count):
    """A vertex, a UV, a normal and a handedness at each corner, many alike."""
    vertex = RNG.integers(0, max(count // 6, 1), count).astype(np.int32)
    normal = RNG.normal(size=(count, 3))[vertex]
    return vertex, RNG.choice([0.0, -0.0, 0.25, 3e-41], (count, 2)), normal, RNG.choice([-1, 1], count).astype(np.int8)


@pytest.mark.parametrize("count", [0, 1, 2, 7, 300, 5000])
def test_groups_are_those_of_a_dictionary(count):
    given = few_values(count)
    for attributes in (given, given[:1], given[1:2], given[2:], given[:3:2]):
        for found, expected in zip(shared_corners(*attributes), naive(*attributes), strict=True):
            np.testing.assert_array_equal(found, expected)


def test_corners_that_differ_in_one_bit_are_apart():
    uv = RNG.random((4000, 2)).astype(np.float32)
    nearly = uv.copy()
    nearly.view(np.uint32)[np.arange(4000), RNG.integers(0, 2, 4000)] ^= 1
    first, group = shared_corners(np.concatenate([uv, nearly]))
    assert len(first) == 8000
    np.testing.assert_array_equal(group, np.arange(8000))


@pytest.mark.parametrize("kept", [0, 3 << 62, 0xFF << 56], ids=["one hash", "four", "256"])
def test_unequal_corners_of_one_hash_stay_apart(kept, monkeypatch):
    mixed = corners._mixed
    monkeypatch.setattr(corners, "_mixed", lambda *given: mixed(*given) & np.uint64(kept))
    given = few_values(700)
    for found, expected in zip(shared_corners(*given), naive(*given), strict=True):
        np.testing.assert_array_equal(found, expected)
