import numpy as np
import pytest

from texloom.demo.relief import horizon, light, material, mean_of_quarters, normals, occlusion, tint


@pytest.mark.parametrize(("slope_down", "slope_right"), [(0.0, 0.0), (0.5, 0.0), (0.0, -0.7), (0.3, 0.4)])
def test_normals_of_a_slope(slope_down: float, slope_right: float) -> None:
    row, column = np.mgrid[0:8, 0:8].astype(float)
    expected = np.array([-slope_right, slope_down, 1.0])  # green is up the picture, against rows
    normal = normals(slope_down * row + slope_right * column)
    np.testing.assert_allclose(normal, np.broadcast_to(expected / np.linalg.norm(expected), normal.shape), atol=1e-12)


def test_a_step_hides_sky_only_on_its_low_side() -> None:
    height = np.zeros((24, 24))
    height[:, 12:] = 5.0
    ao = occlusion(height)
    np.testing.assert_allclose(ao[12, 13:], 1.0)
    assert ao[12, 11] < 0.75 and ao[12, 2] > ao[12, 11]
    assert horizon(height, (0.0, 1.0), reach=4)[12, 11] == pytest.approx(5.0)


def test_a_plane_is_fully_lit() -> None:
    flat = np.zeros((8, 8))
    np.testing.assert_allclose(light(flat, occlusion(flat), strength=0.7), 1.0)


def test_light_comes_from_above_left() -> None:
    row, column = np.mgrid[0:17, 0:17] - 8.0
    dome = np.sqrt(np.maximum(64 - row**2 - column**2, 0.0))
    lit = light(dome, np.ones_like(dome), strength=1.0)
    assert lit[5, 5] > lit[8, 8] > lit[11, 11]


def test_material_is_six_maps_of_half_the_fine_size() -> None:
    fine = np.full((32, 32), 0.5)
    stack = material(np.full((32, 32, 3), 0.25), fine, roughness=fine)
    assert list(stack.maps) == ["basecolor", "normal", "roughness", "metallic", "height", "ao"]
    assert stack.shape == (16, 16)
    np.testing.assert_allclose(stack.maps["basecolor"].image, 0.25)
    np.testing.assert_allclose(stack.maps["normal"].image, np.broadcast_to([0.5, 0.5, 1.0], (16, 16, 3)))


def test_mean_of_quarters() -> None:
    np.testing.assert_allclose(mean_of_quarters(np.arange(16.0).reshape(4, 4)), [[2.5, 4.5], [10.5, 12.5]])


def test_tint_ends_at_the_palettes_ends() -> None:
    ends = tint(["000000", "ffffff"], np.array([[-1.0, 0.0, 1.0, 2.0]]))
    np.testing.assert_allclose(ends[0, :, 0], [0, 0, 1, 1])
