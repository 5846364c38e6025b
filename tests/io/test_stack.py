"""A folder of maps becomes one exemplar, whoever named the files."""

import numpy as np
import pytest
from PIL import Image as Pillow

from tests.data import DATA, needs_data
from texloom.errors import ExemplarError, FileError
from texloom.io.names import role_of
from texloom.io.stack import read_exemplar

RNG = np.random.default_rng(3)


def save(path, value=None, size=(12, 10), channels=3):
    """An image of one value, or of random ones."""
    shape = (size[1], size[0], channels)
    values = RNG.integers(1, 255, shape, dtype=np.uint8) if value is None else np.full(shape, value, np.uint8)
    Pillow.fromarray(values[..., 0] if channels == 1 else values).save(path)
    return values


@pytest.mark.parametrize(
    "name, role, directx",
    [
        ("brick_wall_diff_1k.png", "basecolor", None),
        ("rough_metal_plate_diff_1k.png", "basecolor", None),
        ("brick_wall_nor_gl_1k.png", "normal", False),
        ("brick_wall_nor_dx_1k.png", "normal", True),
        ("brick_wall_arm_2k.jpg", "orm", None),
        ("brick_wall_disp_1k.png", "height", None),
        ("Bricks001_1K-PNG_Color.png", "basecolor", None),
        ("Bricks001_1K-PNG_NormalGL.png", "normal", False),
        ("Bricks001_1K-PNG_NormalDX.png", "normal", True),
        ("Bricks001_1K-PNG_AmbientOcclusion.png", "ao", None),
        ("Bricks001_1K-PNG_Metalness.png", "metallic", None),
        ("Bricks001_1K-PNG_Displacement.png", "height", None),
        ("Bricks001_1K-PNG_Opacity.png", "alpha", None),
        ("T_Wall_BaseColor.tga", "basecolor", None),
        ("T_Wall_OcclusionRoughnessMetallic.png", "orm", None),
        ("wall_metallicRoughness.png", "metallic-roughness", None),
        ("normal.png", "normal", None),
        ("mask.png", "mask", None),
        ("Bricks001.png", None, None),
    ],
)
def test_names_tell_maps(name, role, directx):
    found = role_of(name)
    assert (found and found.name, found and found.directx) == (role, directx)


def test_a_folder_is_one_stack(tmp_path):
    for name in ("basecolor", "normal"):
        save(tmp_path / f"{name}.png")
    for name in ("height", "roughness", "ao"):
        save(tmp_path / f"{name}.png", channels=1)
    exemplar = read_exemplar(tmp_path)
    assert list(exemplar.maps) == ["basecolor", "normal", "roughness", "height", "ao"]
    assert [m.kind for m in exemplar.maps.values()] == ["colour", "normal", "data", "data", "data"]
    assert exemplar.shape == (10, 12) and exemplar.mask is None


def test_packed_channels_are_taken_apart(tmp_path):
    packed = save(tmp_path / "wall_arm_1k.png")
    save(tmp_path / "wall_diff_1k.png")
    own = save(tmp_path / "wall_rough_1k.png", channels=1)
    exemplar = read_exemplar(tmp_path)
    np.testing.assert_allclose(exemplar.maps["ao"].image[..., 0], packed[..., 0] / 255, rtol=1e-6)
    np.testing.assert_allclose(exemplar.maps["metallic"].image[..., 0], packed[..., 2] / 255, rtol=1e-6)
    np.testing.assert_allclose(exemplar.maps["roughness"].image[..., 0], own[..., 0] / 255, rtol=1e-6)


def test_green_points_up(tmp_path):
    stored = save(tmp_path / "wall_NormalDX.png") / np.float32(255)
    flipped = np.stack([stored[..., 0], 1 - stored[..., 1], stored[..., 2]], axis=-1)
    np.testing.assert_allclose(read_exemplar(tmp_path).maps["normal"].image, flipped, atol=1e-6)
    upright = save(tmp_path / "wall_NormalGL.png") / np.float32(255)
    for directx in (False, True):  # the name tells
        m = read_exemplar(tmp_path, directx_normals=directx).maps["normal"]
        np.testing.assert_allclose(m.image, upright, atol=1e-6)


def test_an_unmarked_normal_follows_the_flag(tmp_path):
    save(tmp_path / "normal.png")
    plain = read_exemplar(tmp_path).maps["normal"].image
    flipped = read_exemplar(tmp_path, directx_normals=True).maps["normal"].image
    np.testing.assert_allclose(plain[..., 1], 1 - flipped[..., 1], atol=1e-6)
    np.testing.assert_array_equal(plain[..., ::2], flipped[..., ::2])


def test_mask_file_and_opacity_both_exclude(tmp_path):
    save(tmp_path / "color.png")
    opacity = np.full((10, 12), 255, np.uint8)
    opacity[0] = 0
    Pillow.fromarray(opacity).save(tmp_path / "opacity.png")
    white = np.full((10, 12), 255, np.uint8)
    white[:, 0] = 0
    Pillow.fromarray(white).save(tmp_path / "mask.png")
    expected = np.ones((10, 12), bool)
    expected[0] = expected[:, 0] = False
    np.testing.assert_array_equal(read_exemplar(tmp_path).mask, expected)
    assert "mask" not in read_exemplar(tmp_path).maps


def test_a_mask_can_be_given(tmp_path):
    save(tmp_path / "a.png")
    keep = RNG.random((10, 12)) > 0.5
    Pillow.fromarray(keep).save(tmp_path / "m.png")
    np.testing.assert_array_equal(read_exemplar(tmp_path / "a.png", mask=tmp_path / "m.png").mask, keep)
    np.testing.assert_array_equal(read_exemplar(tmp_path / "a.png", mask=keep).mask, keep)


def test_what_is_wrong_with_a_folder_is_named(tmp_path):
    with pytest.raises(FileError, match="holds no image"):
        read_exemplar(tmp_path)
    save(tmp_path / "one.png")
    assert list(read_exemplar(tmp_path).maps) == ["basecolor"]
    save(tmp_path / "two.png")
    with pytest.raises(FileError, match="2 images, but no name tells"):
        read_exemplar(tmp_path)
    save(tmp_path / "albedo.png")
    save(tmp_path / "diffuse.png")
    with pytest.raises(FileError, match="albedo.png and diffuse.png"):
        read_exemplar(tmp_path)
    (tmp_path / "diffuse.png").unlink()
    save(tmp_path / "height.png", size=(20, 10), channels=1)
    with pytest.raises(ExemplarError, match="basecolor is 12x10 and height is 20x10"):
        read_exemplar(tmp_path)
    save(tmp_path / "height.png", size=(12, 10), channels=1)
    save(tmp_path / "normal.png", channels=1)
    with pytest.raises(ExemplarError, match="normal map needs 3"):
        read_exemplar(tmp_path)


def test_a_black_mask_is_refused(tmp_path):
    save(tmp_path / "basecolor.png")
    save(tmp_path / "mask.png", value=0, channels=1)
    with pytest.raises(ExemplarError, match="none of 120 texels"):
        read_exemplar(tmp_path)


@needs_data
@pytest.mark.parametrize("folder", sorted((DATA / "pbr").glob("*")), ids=lambda path: path.name)
def test_real_stacks_load_whole(folder):
    exemplar = read_exemplar(folder)
    assert set(exemplar.maps) == {file.stem for file in folder.glob("*.png")}
    assert next(iter(exemplar.maps)) == "basecolor"
