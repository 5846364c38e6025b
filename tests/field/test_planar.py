"""Planar fields point where their names say."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom.errors import FieldError
from texloom.field import planar


@pytest.mark.parametrize("name", planar.NAMED)
@pytest.mark.parametrize("shape", [(1, 1), (7, 12), (8, 8)])
def test_directions_are_unit(name, shape):
    field = planar.NAMED[name](*shape)
    assert field.direction.shape == (*shape, 2)
    np.testing.assert_allclose(np.linalg.norm(field.direction, axis=2), 1, atol=1e-6)
    assert field.scale is None


def test_an_angle_turns_counter_clockwise_as_seen():
    np.testing.assert_allclose(planar.uniform(2, 2).direction[0, 0], [0, 1], atol=1e-6)
    np.testing.assert_allclose(planar.uniform(2, 2, np.pi / 2).direction[0, 0], [-1, 0], atol=1e-6)


def test_radial_points_away_and_ring_around():
    radial, ring = planar.radial(9, 9).direction, planar.ring(9, 9).direction
    np.testing.assert_allclose(radial[0, 4], [-1, 0], atol=1e-6)
    np.testing.assert_allclose(radial[4, 8], [0, 1], atol=1e-6)
    np.testing.assert_allclose(ring[4, 8], [-1, 0], atol=1e-6)  # up on the right: counter-clockwise
    np.testing.assert_allclose(np.sum(radial * ring, axis=2)[:, [0, 1, 7]], 0, atol=1e-6)


def test_sine_follows_the_slope_of_its_curve():
    field = planar.sine(3, 400, waves=3, height=0.05).direction
    x = np.arange(400)
    height = -0.05 * 400 * np.sin(2 * np.pi * 3 * x / 400)  # rows grow downwards
    np.testing.assert_allclose(field[1, :, 0] / field[1, :, 1], np.gradient(height), atol=0.02)


def test_centre_scale_grades_to_one():
    scale = planar.ring(21, 41, centre_scale=0.25).scale
    np.testing.assert_allclose(scale[10, 20], 0.25, rtol=1e-6)
    np.testing.assert_allclose(scale[[0, 20, 10], [20, 20, 0]], 1.0)
    np.testing.assert_allclose(scale[5, 20], 0.5, rtol=1e-6)


@given(st.integers(1, 9), st.integers(1, 9), st.integers(0, 99))
def test_vectors_of_the_grid_come_back(rows, columns, seed):
    vectors = np.random.default_rng(seed).normal(size=(rows, columns, 2))
    field = planar.from_vectors(vectors, rows, columns)
    length = np.linalg.norm(vectors, axis=2)
    np.testing.assert_allclose(field.direction, vectors / length[..., None], atol=1e-5)
    if field.scale is not None:
        np.testing.assert_allclose(field.scale, length / length.mean(), rtol=1e-5)


def test_stretching_keeps_a_constant_field():
    field = planar.from_vectors(np.tile([3.0, 4.0], (2, 3, 1)), 10, 7)
    np.testing.assert_allclose(field.direction, np.tile([0.6, 0.8], (10, 7, 1)), atol=1e-6)
    assert field.scale is None


def test_a_missing_vector_takes_after_its_neighbour():
    vectors = np.tile([0.0, 1.0], (3, 3, 1))
    vectors[1, 1] = 0
    np.testing.assert_allclose(planar.from_vectors(vectors, 3, 3).direction, np.tile([0, 1], (3, 3, 1)))


def test_images_are_angles_or_vectors():
    grey = np.full((2, 2, 1), 0.25, np.float32)
    np.testing.assert_allclose(planar.from_image(grey, 2, 2).direction[0, 0], [-1, 0], atol=1e-6)
    up = np.tile(np.array([127 / 255, 1.0, 0.0], np.float32), (2, 2, 1))
    np.testing.assert_allclose(planar.from_image(up, 2, 2).direction[0, 0], [-1, 0], atol=1e-6)
    right = np.tile(np.array([1.0, 128 / 255, 1.0], np.float32), (2, 2, 1))
    np.testing.assert_allclose(planar.from_image(right, 4, 4).direction[3, 3], [0, 1], atol=1e-6)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: planar.from_vectors(np.ones((3, 3)), 3, 3), "shape"),
        (lambda: planar.from_vectors(np.zeros((3, 3, 2)), 3, 3), "all planar vectors are 0"),
        (lambda: planar.from_vectors(np.full((3, 3, 2), np.nan), 3, 3), "9 of 9"),
        (lambda: planar.from_image(np.ones((3, 3)), 3, 3), "shape"),
        (lambda: planar.radial(3, 3, centre_scale=0.0), "above 0"),
    ],
)
def test_wrong_input_is_named(build, message):
    with pytest.raises(FieldError, match=message):
        build()
