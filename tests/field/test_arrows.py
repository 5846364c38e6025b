"""Arrows fall where they should, and say what is wrong with them."""

import numpy as np
import pytest

from tests.meshes import flat_square, sphere
from texloom.errors import FieldError
from texloom.field.arrows import Arrow, place


def test_arrows_land_on_vertices_as_unit_tangents():
    mesh = flat_square(4)
    placed = place(
        mesh,
        [
            Arrow(vertex=3, direction=(0, 2, 5)),
            Arrow(point=(0.52, 0.26, 3.0), direction=(4, 0, 0), scale=2.0),
            Arrow(vertex=9, scale=0.5),
        ],
    )
    np.testing.assert_array_equal(placed.direction_vertex, [3, 7])
    np.testing.assert_allclose(placed.direction, [[0, 1, 0], [1, 0, 0]], atol=1e-12)
    np.testing.assert_array_equal(placed.scale_vertex, [7, 9])
    np.testing.assert_allclose(placed.scale, [2.0, 0.5])


def test_nothing_is_placed_as_nothing():
    placed = place(flat_square(2), [])
    assert placed.direction.shape == (0, 3)
    assert placed.scale.shape == (0,)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Arrow(direction=(1, 0, 0)), "give one of the two"),
        (lambda: Arrow(point=(0, 0, 0), vertex=1, scale=1.0), "give one of the two"),
        (lambda: Arrow(vertex=1), "asks for"),
        (lambda: Arrow(vertex=1, direction=(0, 0, 0)), "no direction"),
        (lambda: Arrow(vertex=1, direction=(0, np.nan, 0)), "no direction"),
        (lambda: Arrow(point=(0, np.inf, 0), scale=1.0), "not finite"),
        (lambda: Arrow(vertex=1, scale=0.0), "scale is 0"),
        (lambda: Arrow(vertex=1, scale=float("nan")), "scale is nan"),
    ],
)
def test_a_wrong_arrow_is_refused(make, message):
    with pytest.raises(FieldError, match=message):
        make()


@pytest.mark.parametrize(
    ("vertex", "direction", "message"),
    [
        (9, (1, 0, 0), "arrow 1 stands at vertex 9, but the mesh has 9: use 0 to 8"),
        (-2, (1, 0, 0), "vertex -2"),
        (4, (0, 0, -3), "arrow 1 points along the normal of vertex 4"),
    ],
)
def test_an_arrow_that_does_not_fit_the_mesh_is_named(vertex, direction, message):
    with pytest.raises(FieldError, match=message):
        place(flat_square(2), [Arrow(vertex=0, scale=1.0), Arrow(vertex=vertex, direction=direction)])


def test_points_find_the_nearest_vertex():
    mesh = sphere(3)
    wanted = np.arange(0, len(mesh.vertices), 17)
    placed = place(mesh, [Arrow(point=tuple(1.3 * mesh.vertices[i]), scale=1.0) for i in wanted])
    np.testing.assert_array_equal(placed.scale_vertex, wanted)
