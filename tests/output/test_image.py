"""Image files: every depth and channel count comes back as it was; settings are inside; nothing half-written."""

import struct
import zlib

import numpy as np
import pytest
from PIL import Image as Pillow

from texloom.errors import FileError, ParameterError
from texloom.exemplar.exemplar import Map, to_map
from texloom.io.image import read_stored
from texloom.output.exr import exr_bytes
from texloom.output.image import write_image, write_images


def ramp(depth, channels):
    values = np.arange(64 * 64 * channels, dtype=np.uint32) * 48271
    return (values % (np.iinfo(depth).max + 1)).astype(depth).reshape(64, 64, channels)


@pytest.mark.parametrize("suffix", [".png", ".tif"])
@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_integers_come_back(tmp_path, suffix, depth, channels):
    values = ramp(depth, channels)
    path = write_image(tmp_path / f"map{suffix}", to_map(values, "data"), settings={"seed": "7"})
    np.testing.assert_array_equal(read_stored(path), values)


def test_settings_are_in_the_png(tmp_path):
    path = write_image(tmp_path / "a.png", to_map(ramp(np.uint8, 3), "colour"), settings={"method": "optimize é"})
    with Pillow.open(path) as picture:
        picture.load()
        assert picture.text["method"] == "optimize é"
        assert "srgb" in picture.info


def test_a_float_map_becomes_sixteen_bits_in_a_png_and_stays_float_in_a_tiff(tmp_path):
    map = Map(np.random.default_rng(0).random((9, 9, 1), dtype=np.float32), "data", 32)
    assert read_stored(write_image(tmp_path / "a.png", map)).dtype == np.uint16
    np.testing.assert_array_equal(read_stored(write_image(tmp_path / "a.tif", map)), map.image)


def test_an_exr_holds_the_floats():
    image = np.random.default_rng(1).normal(size=(37, 11, 3)).astype(np.float32)
    np.testing.assert_array_equal(read_exr(exr_bytes(image, text={"seed": "7"}), 37, 11, "BGR")[..., ::-1], image)


def read_exr(data, rows, columns, names):
    """Undo the blocks as the format describes them."""
    assert struct.unpack_from("<i", data)[0] == 20000630
    count = -(-rows // 16)
    starts = next(
        starts
        for at in range(8, 1000)
        if (starts := struct.unpack_from(f"<{count}Q", data, at))[0] == at + 8 * count and starts[-1] < len(data)
    )
    planes = []
    for number, start in enumerate(starts):
        row, size = struct.unpack_from("<ii", data, start)
        assert row == number * 16
        lines = min(16, rows - row)
        raw, length = data[start + 8 : start + 8 + size], lines * len(names) * columns * 4
        if size < length:
            predicted = np.frombuffer(zlib.decompress(raw), np.uint8).astype(np.int64)
            bytes_ = np.cumsum(predicted - np.concatenate([[0], np.full(length - 1, 128)])).astype(np.uint8)
            raw = np.empty(length, np.uint8)
            raw[0::2], raw[1::2] = bytes_[: (length + 1) // 2], bytes_[(length + 1) // 2 :]
            raw = raw.tobytes()
        planes.append(np.frombuffer(raw, "<f4").reshape(lines, len(names), columns))
    return np.concatenate(planes).transpose(0, 2, 1)


def test_a_stack_is_a_folder_with_one_file_a_map(tmp_path):
    maps = {"basecolor": to_map(ramp(np.uint8, 3), "colour"), "height": to_map(ramp(np.uint16, 1), "data")}
    files = write_images(tmp_path / "out", maps)
    assert sorted(path.name for path in files) == ["basecolor.png", "height.png"]
    np.testing.assert_array_equal(read_stored(tmp_path / "out" / "height.png"), ramp(np.uint16, 1))
    with pytest.raises(ParameterError, match="2 maps"):
        write_images(tmp_path / "one.png", maps)


def test_colour_and_alpha_share_a_file(tmp_path):
    rgba = ramp(np.uint8, 4)
    maps = {"basecolor": to_map(rgba[..., :3], "colour"), "alpha": to_map(rgba[..., 3:], "data")}
    write_images(tmp_path / "a.png", maps)
    np.testing.assert_array_equal(read_stored(tmp_path / "a.png"), rgba)


def test_a_failure_leaves_no_file_and_no_folder(tmp_path):
    maps = {"a": to_map(ramp(np.uint8, 1), "data"), "b": Map(np.zeros((2, 2, 7), np.float32), "data", 8)}
    with pytest.raises(KeyError):
        write_images(tmp_path / "out", maps)
    assert not list(tmp_path.iterdir())


def test_an_unknown_suffix_is_refused(tmp_path):
    with pytest.raises(FileError, match="use .png"):
        write_image(tmp_path / "a.bmp", to_map(ramp(np.uint8, 3), "colour"))
