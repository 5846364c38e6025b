"""Blur, down and up on points: averages that keep what is constant, and vectors that stay in the surface."""

import numpy as np
import pytest

from tests.meshes import cylinder, flat_square, sphere, torus
from texloom.errors import ParameterError
from texloom.points import Hierarchy, Level, Pyramid, hierarchy
from texloom.points.transport import frames, to_complex, to_vectors, turns


@pytest.fixture(scope="module")
def ball() -> Hierarchy:
    return hierarchy(sphere(4), (250, 1000, 4000))


def naive_blur(level: Level, values: np.ndarray, radius: float) -> np.ndarray:
    """C(v) + Σ wᵢ (C(vᵢ) − C(v)), point by point."""
    blurred = values.copy()
    for v in range(level.count):
        near = level.mesh.edges[(level.mesh.edges == v).any(1)].sum(1) - v
        apart = np.linalg.norm(level.position[near] - level.position[v], axis=1) / (radius * level.spacing)
        weights = np.where(apart < 1, (1 - apart**2) ** 2, 0) + 1e-12
        weights *= 0.5 / weights.sum()
        blurred[v] += weights @ (values[near] - values[v])
    return blurred


def test_constants_stay(ball: Hierarchy) -> None:
    pyramid = Pyramid(ball)
    for level, here in enumerate(ball.levels):
        same = np.full((here.count, 2), [3.0, -1.0])
        np.testing.assert_allclose(pyramid.blur(level, same, times=3), same)
        if level:
            np.testing.assert_allclose(pyramid.down(level, same), same[: ball.levels[level - 1].count])
        if level < 2:
            np.testing.assert_allclose(pyramid.up(level, same), np.full((ball.levels[level + 1].count, 2), same[0]))


def test_values_of_any_shape(ball: Hierarchy) -> None:
    values = np.random.default_rng(0).random((4000, 2, 3))
    pyramid = Pyramid(ball)
    assert pyramid.down(2, values).shape == (1000, 2, 3)
    np.testing.assert_allclose(pyramid.blur(2, values[:, 0, 1]), pyramid.blur(2, values)[:, 0, 1])
    assert pyramid.up(1, values[:1000, 0, 0]).shape == (4000,)


def test_blur_is_its_formula(ball: Hierarchy) -> None:
    values = np.random.default_rng(1).random((250, 3))
    np.testing.assert_allclose(Pyramid(ball).blur(0, values), naive_blur(ball.levels[0], values, 1.75), atol=1e-6)


def test_nothing_leaves_its_range(ball: Hierarchy) -> None:
    values = np.random.default_rng(2).integers(0, 2, 1000).astype(float)
    raised = Pyramid(ball).up(1, values)
    assert raised.min() >= -1e-12 and raised.max() <= 1 + 1e-12


def test_smooth_values_come_back(ball: Hierarchy) -> None:
    """Down and up again costs a height function little, noise nearly all it has."""
    pyramid = Pyramid(ball)
    height = ball.levels[2].position[:, 2]
    again = pyramid.up(1, pyramid.down(2, height))
    assert np.abs(again - height).max() < 0.03
    noise = np.random.default_rng(3).standard_normal(4000)
    assert pyramid.up(1, pyramid.down(2, noise)).std() < 0.45


def test_a_wider_radius_is_smoother(ball: Hierarchy) -> None:
    values = np.random.default_rng(4).standard_normal(1000)
    assert Pyramid(ball, radius=3).up(1, values).std() < 0.8 * Pyramid(ball, radius=1.2).up(1, values).std()


def test_in_the_plane_vectors_are_values() -> None:
    """Every component of a vector is blurred as any number is."""
    made = hierarchy(flat_square(8), (200, 800))
    pyramid = Pyramid(made)
    vectors = np.random.default_rng(5).standard_normal((800, 3)) * [1, 1, 0]
    np.testing.assert_allclose(pyramid.down_vectors(1, vectors), pyramid.down(1, vectors), atol=1e-12)
    np.testing.assert_allclose(pyramid.up_vectors(0, vectors[:200]), pyramid.up(0, vectors[:200]), atol=1e-12)


def test_around_a_cylinder_vectors_stay() -> None:
    """The field that goes around stays itself; averaged in space it would shrink."""
    made = hierarchy(cylinder(96, 24), (120, 480))
    pyramid = Pyramid(made)
    around = [np.cross([0, 0, 1], level.normal) for level in made.levels]
    for level in (0, 1):
        blurred = pyramid.blur_vectors(level, around[level], times=20)
        np.testing.assert_allclose(blurred, around[level], atol=1e-9)
    np.testing.assert_allclose(pyramid.up_vectors(0, around[0]), around[1], atol=1e-9)
    np.testing.assert_allclose(pyramid.down_vectors(1, around[1]), around[0], atol=1e-9)
    assert np.linalg.norm(pyramid.blur(0, around[0], times=20), axis=1).mean() < 0.9


def test_vectors_stay_tangent(ball: Hierarchy) -> None:
    pyramid = Pyramid(ball)
    vectors = np.random.default_rng(6).standard_normal((4000, 3))
    for level, made in ((2, pyramid.blur_vectors(2, vectors)), (1, pyramid.down_vectors(2, vectors))):
        np.testing.assert_allclose(np.einsum("px,px->p", made, ball.levels[level].normal), 0, atol=1e-12)


def test_turns_are_rotations_and_go_back() -> None:
    normal = np.random.default_rng(7).standard_normal((200, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    axes = frames(normal)
    np.testing.assert_allclose(
        np.einsum("pax,pbx->pab", axes, axes), np.broadcast_to(np.eye(2), (200, 2, 2)), atol=1e-12
    )
    np.testing.assert_allclose(np.cross(axes[:, 0], axes[:, 1]), normal, atol=1e-12)
    source, target = np.arange(100), np.arange(100, 200)
    there, back = turns(axes, axes, source, target), turns(axes, axes, target, source)
    np.testing.assert_allclose(there * back, 1, atol=1e-9)
    vectors = np.cross(normal, [0.3, -0.2, 0.9])
    np.testing.assert_allclose(to_vectors(to_complex(vectors, axes), axes), vectors, atol=1e-12)
    # About the common perpendicular: what lies along it stays
    axis = np.cross(normal[source], normal[target])
    carried = to_vectors(to_complex(axis, axes[source]) * there, axes[target])
    np.testing.assert_allclose(carried, axis, atol=1e-9)


def test_beyond_the_ends_there_is_nothing() -> None:
    pyramid = Pyramid(hierarchy(torus(), (100, 300)))
    with pytest.raises(ParameterError, match="coarser than level 0"):
        pyramid.down(0, np.ones(100))
    with pytest.raises(ParameterError, match="finer than level 1"):
        pyramid.up(1, np.ones(300))
    with pytest.raises(ParameterError, match="no neighbour"):
        Pyramid(pyramid.hierarchy, radius=0)
