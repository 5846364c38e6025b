"""Lattices are found to a fraction of a texel, and tiles on them do not cut motifs."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.fitting import curved
from texloom.sketch.reading.lattice import Lattice, lattice_of, tiles


def waves(shifts: np.ndarray, seed: int = 0, *, shape: tuple[int, int] = (160, 200), grain: float = 0.5) -> np.ndarray:
    """A picture that repeats under the shifts, from waves of several lengths, and grain."""
    draw = np.random.default_rng(seed)
    place = np.indices(shape).reshape(2, -1).T @ np.linalg.inv(shifts)
    picture = sum(
        draw.normal() * np.cos(2 * np.pi * (place @ wave + draw.uniform()))
        for wave in np.indices((3, 5)).reshape(2, -1).T - [0, 2]
        if wave.any()
    )
    return np.float32((picture / np.std(picture) + grain * draw.normal(size=len(place))).reshape(shape))


def same_lattice(one: np.ndarray, other: np.ndarray) -> None:
    """Each is whole multiples of the other."""
    times = one @ np.linalg.inv(other)
    np.testing.assert_allclose(times, np.round(times), atol=0.02)
    np.testing.assert_allclose(abs(np.linalg.det(times)), 1, atol=0.02)


@pytest.mark.parametrize(
    "shifts", [[[20.0, 0.0], [0.0, 31.0]], [[17.3, 4.6], [-6.2, 22.9]], [[0.0, 24.4], [18.7, 12.2]]]
)
def test_a_lattice_is_found_between_texels(shifts):
    lattice = lattice_of(waves(np.array(shifts)))
    assert lattice is not None
    same_lattice(lattice.shifts, np.array(shifts))
    assert lattice.order > 0.3


def test_a_mask_over_a_third_changes_nothing():
    shifts = np.array([[17.3, 4.6], [-6.2, 22.9]])
    usable = np.ones((160, 200), bool)
    usable[:, 70:130] = False
    lattice = lattice_of(np.where(usable, waves(shifts), np.float32(0)), usable)
    assert lattice is not None
    same_lattice(lattice.shifts, shifts)
    assert lattice.order > 0.3


def test_stripes_and_clouds_keep_no_order():
    row, column = np.mgrid[:128, :128]
    stripes = np.float32(np.sin(0.6 * row + 0.17 * column))
    clouds = np.float32(gaussian_filter(np.random.default_rng(0).normal(size=(128, 128)), 3))
    for picture in (stripes, clouds):
        lattice = lattice_of(picture)
        assert lattice is None or lattice.order < 0.15


def test_tiles_tile_the_picture_and_run_where_it_is_calm():
    shifts = np.array([[18.0, 7.0], [-5.0, 21.0]])
    place = np.indices((120, 140)).reshape(2, -1).T @ np.linalg.inv(shifts) - [0.3, 0.8]
    far = np.hypot(*((place - np.round(place)) @ shifts).T)
    picture = np.float32(np.where(far < 5, np.sin(3 * far), 0)).reshape(120, 140)
    lines = tiles(picture, Lattice(shifts, 1.0))
    graph = curved((120.0, 140.0), lines, tolerance=0.1)
    np.testing.assert_allclose(graph.cells().area, abs(np.linalg.det(shifts)), rtol=1e-3)
    assert len(graph.cells()) >= 22
    assert len(graph.crossings()) == 0
    assert (np.abs(lines.vertices - [59.5, 69.5]) < [60.001, 70.001]).all()
    assert np.abs(picture[on(graph)]).max() == 0


def on(graph: CellGraph) -> tuple[np.ndarray, np.ndarray]:
    """Texels under the edges."""
    chord = graph.flattened(0.1)
    share = np.linspace(0, 1, 60)[:, None, None]
    row, column = np.round(chord.start + share * (chord.end - chord.start)).astype(int).reshape(-1, 2).T
    return np.clip(row, 0, graph.size[0] - 1).astype(int), np.clip(column, 0, graph.size[1] - 1).astype(int)
