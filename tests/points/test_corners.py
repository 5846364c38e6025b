"""Corners of boundaries: points on every level, unless they are many or teeth."""

import numpy as np
import pytest

from tests.meshes import as_mesh, flat_square, sphere
from texloom.mesh.mesh import Mesh
from texloom.points import hierarchy
from texloom.points.corners import corners
from texloom.points.ground import Ground

COUNTS = (150, 600, 2400)


def sheet(outline: np.ndarray) -> Mesh:
    """The inside of a star-shaped outline around the origin."""
    count = len(outline)
    vertices = np.concatenate([np.zeros((1, 3)), np.pad(outline, ((0, 0), (0, 1)))])
    return as_mesh(vertices, [[0, 1 + i, 1 + (i + 1) % count] for i in range(count)])


def star(points: int, inner: float) -> Mesh:
    """Points at radius 1, notches at ``inner``, by turns."""
    angle = np.pi * np.arange(2 * points) / points
    radius = np.where(np.arange(2 * points) % 2 == 0, 1.0, inner)
    return sheet(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1))


def rough(mesh: Mesh) -> Ground:
    return Ground(mesh, np.ones(len(mesh.vertices)))


@pytest.mark.parametrize("mesh", [flat_square(), flat_square(1), star(5, 0.4)], ids=["square", "two triangles", "star"])
def test_the_outline_keeps_its_corners(mesh: Mesh) -> None:
    """So all levels cover the sheet, to the last corner; and they are as even as without."""
    number = len(corners(rough(mesh), COUNTS[0]).face)
    for level in hierarchy(mesh, COUNTS).levels:
        rim = level.position[:number]
        assert level.mesh.boundary_vertices[:number].all()
        tips = mesh.vertices[[np.argmin(np.linalg.norm(mesh.vertices - each, axis=1)) for each in rim]]
        np.testing.assert_array_equal(rim, tips)
        assert level.mesh.face_areas.sum() == pytest.approx(mesh.face_areas.sum(), rel=1e-9)
        assert level.variation < 0.14 and level.closest > 0.5


def test_corners_are_where_the_boundary_turns() -> None:
    found = corners(rough(flat_square()), 150)
    at = rough(flat_square()).positions(found.face, found.barycentric)
    np.testing.assert_array_equal(np.unique(at, axis=0), [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]])
    np.testing.assert_allclose(found.barycentric[np.arange(4), found.side], 1)
    assert len(corners(rough(star(5, 0.4)), 150).face) == 10  # the notches too
    assert len(corners(rough(star(12, 0.97)), 150).face) == 0  # 24 turns, by 29 degrees at most
    assert len(corners(rough(sphere(2)), 150).face) == 0


def test_teeth_are_no_corners() -> None:
    """A square one of whose sides is ragged in its middle: every vertex turns there, the next one as far back."""
    teeth = np.stack([np.linspace(0.2, -0.2, 21), 1 + 0.02 * (np.arange(21) % 2)], axis=1)
    ragged = sheet(np.concatenate([[[-1, 1], [-1, -1], [1, -1], [1, 1]], teeth]))
    assert len(corners(rough(ragged), 150).face) == 4
    assert len(corners(rough(ragged), 50_000).face) == 4 + 21  # seen from near, they are


def test_many_corners_are_left() -> None:
    """Squares with but three points each."""
    one = flat_square(1)
    vertices = np.concatenate([one.vertices + [2 * i, 0, 0] for i in range(30)])
    cards = as_mesh(vertices, np.concatenate([one.faces + 4 * i for i in range(30)]))
    assert len(corners(rough(cards), 90).face) == 0
    assert len(corners(rough(cards), 480).face) == 120
    assert hierarchy(cards, (90,)).levels[0].count == 90


def test_a_large_level_keeps_them_too() -> None:
    """It is laid by way of a smaller one."""
    level = hierarchy(flat_square(), (16_000,)).levels[0]
    np.testing.assert_array_equal(np.unique(level.position[:4, :2], axis=0), [[0, 0], [0, 1], [1, 0], [1, 1]])
    assert level.variation < 0.1 and level.mesh.face_areas.sum() == pytest.approx(1)
