"""A tile cut where the cut shows least."""

import numpy as np

from texloom.exemplar.exemplar import Map
from texloom.output.gather import identity_sources
from texloom.output.tiling import begin_at, quiet_start


def test_the_cut_avoids_the_loudest_line() -> None:
    rng = np.random.default_rng(0)
    smooth = np.sin(np.arange(40)[:, None] * 2 * np.pi / 40) + np.cos(np.arange(30) * 2 * np.pi / 30)
    image = (0.5 + 0.1 * smooth + 0.001 * rng.random((40, 30))).astype(np.float32)[..., None]
    image[17:] += 0.5  # a step before row 17, and one across the border
    row, column = quiet_start([Map(image, "data", 32)])
    assert row not in (0, 17) and 0 <= column < 30
    steps = np.abs(image - np.roll(image, 1, 0)).mean((1, 2))
    assert row == steps.argmin()


def test_the_worst_map_decides() -> None:
    first = np.float32([0, 0, 1, 1, 0, 1]).reshape(6, 1, 1)  # quiet before rows 1 and 3
    second = np.float32([0, 1, 1, 1, 1, 0]).reshape(6, 1, 1)  # loud before row 1
    assert quiet_start([Map(first, "data", 32), Map(second, "data", 32)])[0] == 3


def test_maps_and_sources_move_together() -> None:
    rng = np.random.default_rng(1)
    image = rng.random((6, 5, 2), np.float32)
    maps, sources = begin_at((2, 3), {"a": Map(image, "data", 8)}, identity_sources(6, 5))
    np.testing.assert_array_equal(maps["a"].image, np.roll(image, (-2, -3), (0, 1)))
    at = sources.position[:, 0].astype(int)
    np.testing.assert_array_equal(image[at[:, 0], at[:, 1]].reshape(6, 5, 2), maps["a"].image)
