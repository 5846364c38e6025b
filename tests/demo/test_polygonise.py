import numpy as np
import pytest

from texloom.demo.animal import rabbit
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import Shape, ball, carve, limb, mirrored, union
from texloom.mesh.mesh import Mesh


def euler_characteristic(mesh: Mesh) -> int:
    return len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)


def volume(mesh: Mesh) -> float:
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def shape_quality(mesh: Mesh) -> np.ndarray:
    """1 for an equilateral triangle, 0 for a needle."""
    corner = mesh.vertices[mesh.faces]
    sides = corner - np.roll(corner, 1, axis=1)
    return 4 * np.sqrt(3) * mesh.face_areas / (sides**2).sum((1, 2))


def torus(p: np.ndarray) -> np.ndarray:
    return np.hypot(np.hypot(p[..., 0], p[..., 1]) - 0.7, p[..., 2]) - 0.25


BOX = np.full(3, -1.2), np.full(3, 1.2)


@pytest.mark.parametrize(
    ("shape", "characteristic", "expected"),
    [(ball((0, 0, 0), 1.0), 2, 4 / 3 * np.pi), (torus, 0, 2 * np.pi**2 * 0.7 * 0.25**2)],
)
def test_a_closed_mesh_on_the_surface_facing_outwards(shape: Shape, characteristic: int, expected: float) -> None:
    mesh = polygonise(shape, low=BOX[0], high=BOX[1], step=0.1)
    assert (mesh.twins >= 0).all()
    assert euler_characteristic(mesh) == characteristic
    np.testing.assert_allclose(shape(mesh.vertices), 0.0, atol=1e-3)
    assert volume(mesh) == pytest.approx(expected, rel=0.03)


def test_a_finer_lattice_is_closer() -> None:
    errors = [
        abs(volume(polygonise(ball((0, 0, 0), 1.0), low=BOX[0], high=BOX[1], step=step)) - 4 / 3 * np.pi)
        for step in (0.2, 0.1)
    ]
    assert errors[1] < errors[0] / 3


def test_the_rabbit_is_one_closed_piece_of_good_triangles() -> None:
    mesh = rabbit()
    assert (mesh.twins >= 0).all()
    assert euler_characteristic(mesh) == 2
    assert 5_000 <= len(mesh.vertices) <= 10_000
    quality = shape_quality(mesh)
    assert quality.min() > 0.25 and quality.mean() > 0.9
    assert volume(mesh) > 0


@pytest.mark.parametrize(
    ("shape", "point", "distance"),
    [
        (ball((1, 0, 0), 0.5), (3, 0, 0), 1.5),
        (limb((0, 0, 0), (0, 2, 0), 0.5, 0.5), (2, 1, 0), 1.5),
        (limb((0, 0, 0), (0, 2, 0), 0.5, 0.25), (0, 3, 0), 0.75),
        (mirrored(ball((1, 0, 0), 0.5)), (-3, 0, 0), 1.5),
        (union([ball((0, 0, 0), 1.0), ball((9, 0, 0), 1.0)], blend=0.1), (0, 2, 0), 1.0),
        (carve(ball((0, 0, 0), 1.0), ball((1, 0, 0), 0.5), blend=1e-9), (1, 0, 0), 0.5),
    ],
)
def test_distances(shape: Shape, point: tuple[float, ...], distance: float) -> None:
    assert shape(np.array([point], float))[0] == pytest.approx(distance)


def test_a_ball_turns_about_its_centre() -> None:
    upright = ball((0, 0, 0), (0.1, 1.0, 0.1))
    lying = ball((0, 0, 0), (0.1, 1.0, 0.1), pitch=np.pi / 2)
    np.testing.assert_allclose(lying(np.array([[0.0, 0.0, 0.9]])), upright(np.array([[0.0, 0.9, 0.0]])))
