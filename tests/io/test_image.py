"""Files of every depth and layout come back as they were written; what cannot be read says so in one line."""

import io
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image as Pillow

from tests.data import DATA, needs_data
from texloom.errors import FileError, TexloomError
from texloom.exemplar.colour import encode
from texloom.io.image import read_image, read_layers, read_stored
from texloom.io.stack import read_exemplar

RNG = np.random.default_rng(7)
COLOUR_TYPE = {1: 0, 2: 4, 3: 2, 4: 6}


def write_deep_png(path: Path, values: np.ndarray) -> None:
    """A 16-bit PNG, each row filtered in another of the five ways (a naive encoder, PNG specification section 9)."""
    rows, columns, channels = values.shape
    step = 2 * channels
    raw = values.astype(">u2").tobytes()
    above = bytes(columns * step)
    lines = []
    for row in range(rows):
        line = raw[row * columns * step : (row + 1) * columns * step]
        kind = row % 5
        out = bytearray()
        for i, byte in enumerate(line):
            a, b, c = (line[i - step], above[i], above[i - step]) if i >= step else (0, above[i], 0)
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            out.append((byte - (0, a, b, (a + b) // 2, nearest)[kind]) % 256)
        lines.append(bytes([kind]) + bytes(out))
        above = line

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", columns, rows, 16, COLOUR_TYPE[channels], 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(lines))) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + body)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_every_bit_of_a_16_bit_png_is_read(tmp_path, channels):
    values = RNG.integers(0, 65536, (11, 13, channels), dtype=np.uint16)
    write_deep_png(tmp_path / "deep.png", values)
    np.testing.assert_array_equal(read_stored(tmp_path / "deep.png"), values)


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_tiff_comes_back_as_written(tmp_path, channels, dtype):
    values = (RNG.random((12, 9, channels)) * (1 if dtype == np.float32 else 250)).astype(dtype)
    photometric = "minisblack" if channels == 1 else "rgb"
    stored = values[..., 0] if channels == 1 else values
    extra = {"extrasamples": ["unassalpha"]} if channels == 4 else {}
    tifffile.imwrite(tmp_path / "a.tif", stored, photometric=photometric, compression="zlib", **extra)
    back = read_stored(tmp_path / "a.tif")
    assert back.dtype == dtype
    np.testing.assert_array_equal(back, values)


@pytest.mark.parametrize("mode, channels", [("L", 1), ("LA", 2), ("RGB", 3), ("RGBA", 4)])
def test_8_bit_png_comes_back_as_written(tmp_path, mode, channels):
    values = RNG.integers(0, 256, (9, 10, channels), dtype=np.uint8)
    Pillow.fromarray(values.squeeze(), mode if channels == 2 else None).save(tmp_path / "a.png")
    np.testing.assert_array_equal(read_stored(tmp_path / "a.png"), values)


def test_a_palette_keeps_its_colours_and_its_transparent_entry(tmp_path):
    picture = Pillow.new("P", (8, 8))
    picture.putpalette([255, 0, 0, 0, 128, 0])
    picture.putpixel((3, 2), 1)
    picture.save(tmp_path / "plain.png")
    picture.save(tmp_path / "clear.png", transparency=1)
    assert read_stored(tmp_path / "plain.png")[2, 3].tolist() == [0, 128, 0]
    clear = read_stored(tmp_path / "clear.png")
    assert clear[2, 3].tolist() == [0, 128, 0, 0] and clear[0, 0].tolist() == [255, 0, 0, 255]


def test_bilevel_is_grey(tmp_path):
    stripes = np.arange(64).reshape(8, 8) % 3 == 0
    Pillow.fromarray(stripes).save(tmp_path / "a.png")
    np.testing.assert_array_equal(read_stored(tmp_path / "a.png")[..., 0], stripes * np.uint8(255))


def test_a_picture_stands_upright(tmp_path):
    values = np.zeros((8, 12, 3), np.uint8)
    values[:, :3] = 255
    exif = Pillow.Exif()
    exif[274] = 6  # shown turned a quarter clockwise
    Pillow.fromarray(values).save(tmp_path / "a.png", exif=exif)
    np.testing.assert_array_equal(read_stored(tmp_path / "a.png"), np.rot90(values, -1))


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_colours_become_light_and_return(tmp_path, dtype):
    largest = np.iinfo(dtype).max
    values = np.linspace(0, largest, 256).round().astype(dtype).reshape(16, 16)
    tifffile.imwrite(tmp_path / "a.tif", values)
    m = read_image(tmp_path / "a.tif")
    assert m.bits == 8 * values.itemsize
    np.testing.assert_array_equal(np.rint(encode(m.image)[..., 0] * largest), values)
    assert m.image[8, 0, 0] < 0.5 * values[8, 0] / largest  # middle grey is much less than half the light


def test_data_stays_as_stored(tmp_path):
    values = RNG.integers(0, 256, (8, 8), dtype=np.uint8)
    Pillow.fromarray(values).save(tmp_path / "rough.png")
    np.testing.assert_allclose(read_image(tmp_path / "rough.png", kind="data").image[..., 0], values / 255, rtol=1e-6)


def test_whole_opacity_is_no_map(tmp_path):
    values = np.full((8, 8, 4), 255, np.uint8)
    Pillow.fromarray(values).save(tmp_path / "a.png")
    assert read_layers(tmp_path / "a.png")[1] is None
    values[0, 0, 3] = 7
    Pillow.fromarray(values).save(tmp_path / "a.png")
    alpha = read_layers(tmp_path / "a.png")[1]
    assert alpha is not None and alpha.image[0, 0, 0] == np.float32(7) / np.float32(255)


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif", ".exr"])
def test_what_is_no_image_is_refused(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    with pytest.raises(FileError, match="no such file"):
        read_image(path)
    path.write_bytes(b"")
    with pytest.raises(FileError, match="0 bytes"):
        read_image(path)
    path.write_bytes(b"a text that calls itself a picture")
    with pytest.raises(FileError, match="a" + suffix) as caught:
        read_image(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "suffix, kwargs", [("PNG", {}), ("JPEG", {}), ("TIFF", {}), ("TIFF", {"compression": "tiff_lzw"})]
)
def test_a_truncated_file_is_refused(tmp_path, suffix, kwargs):
    whole = io.BytesIO()
    Pillow.fromarray(RNG.integers(0, 256, (40, 40, 3), dtype=np.uint8)).save(whole, suffix, **kwargs)
    path = tmp_path / f"half.{suffix.lower()}"
    path.write_bytes(whole.getvalue()[: len(whole.getvalue()) // 2])
    with pytest.raises(FileError, match="half"):
        read_image(path)


@needs_data
@pytest.mark.parametrize("path", sorted((DATA / "images-bad").glob("*")), ids=lambda path: path.name)
def test_awkward_images_load_or_are_refused_in_one_line(path):
    refused = {"empty", "not-an-image", "truncated", "one-pixel", "thin-1x128", "tiny-5x3"}
    if path.stem not in refused:
        assert min(read_exemplar(path).shape) >= 64
        return
    with pytest.raises(TexloomError, match=path.name) as caught:
        read_exemplar(path)
    assert "\n" not in str(caught.value)


@needs_data
def test_a_transparent_hole_is_masked_out():
    path = DATA / "images-bad" / "rgba-hole-128.png"
    exemplar, alpha = read_exemplar(path), read_layers(path)[1]
    assert alpha is not None and exemplar.mask is not None and not exemplar.mask.all()
    np.testing.assert_array_equal(exemplar.mask, alpha.image[..., 0] > 0)
    assert (exemplar.maps["alpha"].image > 0).all(), "what is masked must not show, so it takes its neighbours' values"
