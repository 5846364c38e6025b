import numpy as np
import pytest

from tests.sketch.drawn import voronoi, wall
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.mesh.matching import cross_lines, edge_costs, match_crops
from texloom.sketch.mesh.patch import random_crops

INNER, OUTER = np.array([[5.0, 5.0]]), np.array([[5.0, -5.0]])


@pytest.mark.parametrize(
    ("other", "cost"),
    [
        ((5.0, 5.0), 0.0),  # it coincides
        ((5.0, 1.0), 5 * 1 - 1),  # further along the edge
        ((5.0, 9.0), 5 * 3 - 1),  # back along it
        ((8.0, 5.0), 4 * (1 + np.sqrt(2)) - 1),  # beside it
        ((5.0, 5.5), 1.5 * 2 - 1),  # so near that a turn counts half
    ],
)
def test_edges_cost_their_distance_and_turn(other: tuple[float, float], cost: float) -> None:
    np.testing.assert_allclose(edge_costs(INNER, OUTER, np.array([other])), [cost])


def test_a_line_is_crossed_in_order_and_edges_are_followed_to_where_they_meet_others() -> None:
    vertices = np.array([[2.0, 0], [1, 5], [8, 12], [6, 3], [7, 14], [9, 0], [0, 14.0], [2.75, 6.75], [4.5, 8.5]])
    sketch = straight((16, 16), vertices, np.array([[0, 1], [7, 1], [4, 3], [5, 2], [6, 2], [7, 8], [2, 8]]))
    crossed = cross_lines(sketch, 1, np.array([7.0, 100.0, 2.0]))
    np.testing.assert_array_equal(np.diff(crossed.start), [3, 0, 2])
    np.testing.assert_array_equal(crossed.below[:3], [0, 3, 5])  # through vertices that two edges meet at
    np.testing.assert_array_equal(crossed.above[:3], [2, 4, 2])
    np.testing.assert_allclose(crossed.place[:3], [3, 6 + 4 / 11, 9 - 7 / 12])
    np.testing.assert_allclose(crossed.place[3:], [1.6, 9 - 2 / 12])
    np.testing.assert_allclose(crossed.on_edge[:3], [1 / 7, 7 / 11, 7 / 12])


def naive_cost(sketch: CellGraph, crop: np.ndarray) -> float:  # eqs 1-3, straight edges between junctions
    total = 0.0
    for axis in (0, 1):
        sides = []
        for at in (crop[axis], crop[axis + 2]):
            side = []
            for a, b in sketch.vertices[sketch.edges]:
                low, high = (a, b) if a[axis] < b[axis] else (b, a)
                if low[axis] < at <= high[axis]:
                    place = low + (high - low) * (at - low[axis]) / (high[axis] - low[axis])
                    if crop[1 - axis] <= place[1 - axis] < crop[3 - axis]:
                        side.append((place[1 - axis], low, high))
            sides.append(sorted(side, key=lambda crossing: crossing[0]))
        if len(sides[0]) != len(sides[1]):
            return np.inf
        shift = np.eye(2)[axis] * (crop[axis + 2] - crop[axis])
        costs = []
        for (_, out_1, in_1), (_, in_2, out_2) in zip(*sides, strict=True):
            for inner, outer, other in ((in_1, out_1, out_2 - shift), (in_2 - shift, out_2 - shift, out_1)):
                gap, along = other - inner, outer - inner
                distance = np.linalg.norm(gap)
                turn = np.linalg.norm(gap / distance - along / np.linalg.norm(along))
                costs.append((1 + distance) * (1 + turn * min(distance, 1)) - 1)
        total += float(np.mean(costs)) if costs else 0.0
    return total


def test_many_crops_at_once_cost_what_each_does() -> None:
    sketch = voronoi(25, seed=4)
    crops = random_crops(sketch.size, 3)[:300]
    costs = match_crops(sketch, crops).cost
    expected = np.array([naive_cost(sketch, crop) for crop in crops])
    assert np.isfinite(expected).sum() > 5
    np.testing.assert_allclose(costs, expected)


def test_whole_periods_cost_nothing() -> None:
    sketch = wall(8, 4)
    crops = np.array(
        [[10.0, 20, 58, 80], [10, 20, 70, 80], [10, 20, 58, 85]]
    )  # 4 courses and 2 bricks; one course more
    match = match_crops(sketch, crops)
    np.testing.assert_allclose(match.cost[0], 0, atol=1e-9)
    assert (match.cost[1:] > 1).all()
    np.testing.assert_array_equal(match.crossings[0], [2, 4])
