"""Random cells tile a torus evenly, the same for the same seed."""

import numpy as np
import pytest

from texloom.errors import ParameterError
from texloom.sketch.random import random_cells


@pytest.mark.parametrize("size, cell", [((96.0, 128.0), 12.0), ((64.0, 64.0), 32.0), ((200.0, 50.0), 10.0)])
def test_cells_cover_the_torus_and_are_even(size, cell):
    graph = random_cells(size, cell=cell, seed=4)
    cells = graph.cells()
    np.testing.assert_allclose(cells.area.sum(), size[0] * size[1])
    assert len(cells) == max(round(size[0] * size[1] / cell**2), 4)
    assert cells.area.std() < 0.3 * cells.area.mean()
    assert len(graph.crossings()) == 0 and (graph.degree == 3).all()
    assert len(graph.vertices) - len(graph.edges) + len(cells) == 0  # Euler characteristic of a torus
    assert ((graph.vertices >= -0.5) & (graph.vertices <= np.array(size) - 0.5)).all()


def test_a_seed_gives_its_cells():
    one, same, other = (random_cells((64.0, 64.0), cell=9, seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.vertices, same.vertices)
    assert len(one.vertices) != len(other.vertices) or not np.allclose(one.vertices, other.vertices)


@pytest.mark.parametrize("cell", [0.0, -3.0, 40.0])
def test_cells_that_do_not_tile_are_refused(cell):
    with pytest.raises(ParameterError, match="do not tile"):
        random_cells((64.0, 64.0), cell=cell, seed=1)
