"""Steps along edges: as SciPy counts them, and no farther than asked."""

import numpy as np
import pytest

from tests.synthesis.samples import ball
from texloom.domain.grid import Grid
from texloom.domain.steps import steps_from, within


@pytest.mark.parametrize("make", [lambda: Grid(9, 12), lambda: Grid(8, 8, wrap=True), ball])
def test_steps_are_those_of_shortest_paths(make) -> None:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    domain = make()
    sites = np.zeros(domain.count, bool)
    sites[[3, domain.count // 2]] = True
    graph = coo_array((np.ones(len(domain.edges)), tuple(domain.edges.T)), shape=(domain.count, domain.count))
    paths = dijkstra(graph.tocsr(), directed=False, indices=np.flatnonzero(sites), unweighted=True).min(0)
    np.testing.assert_array_equal(steps_from(domain, sites, 4), np.minimum(paths, 5))
    np.testing.assert_array_equal(within(domain, sites, 3), paths <= 3)


def test_from_nowhere_all_is_far() -> None:
    assert (steps_from(Grid(4, 4), np.zeros(16, bool), 7) == 8).all()
