"""EXR scan lines come back as a naive encoder wrote them; every other layout is refused by name."""

import struct
import zlib

import numpy as np
import pytest

from texloom.errors import FileError
from texloom.io.exr import read_exr
from texloom.io.image import read_image

RNG = np.random.default_rng(11)
NONE, ZIPS, ZIP, PIZ = 0, 2, 3, 4


def encode_exr(values, compression=NONE, version=2, names="RGBA"):
    """A scan-line EXR after "OpenEXR File Layout", one step after the other."""
    rows, columns, count = values.shape
    names = {1: "Y", 3: "RGB", 4: "RGBA"}.get(count, names)
    kind = {2: 1, 4: 2}[values.itemsize]
    order = sorted(range(count), key=lambda i: names[i])
    channels = b"".join(names[i].encode() + b"\0" + struct.pack("<4i", kind, 0, 1, 1) for i in order) + b"\0"
    window = struct.pack("<4i", 5, 7, 5 + columns - 1, 7 + rows - 1)
    header = struct.pack("<II", 20000630, version)
    for name, form, data in [
        (b"channels", b"chlist", channels),
        (b"compression", b"compression", bytes([compression])),
        (b"dataWindow", b"box2i", window),
        (b"displayWindow", b"box2i", window),
    ]:
        header += name + b"\0" + form + b"\0" + struct.pack("<i", len(data)) + data
    header += b"\0"
    step = 16 if compression == ZIP else 1
    chunks = []
    for first in range(0, rows, step):
        lines = b"".join(row[:, i].tobytes() for row in values[first : first + step] for i in order)
        packed = pack(lines) if compression != NONE else lines
        packed = packed if len(packed) < len(lines) else lines
        chunks.append(struct.pack("<ii", 7 + first, len(packed)) + packed)
    place = len(header) + 8 * len(chunks)
    table = b""
    for chunk in chunks:
        table += struct.pack("<Q", place)
        place += len(chunk)
    return header + table + b"".join(chunks)


def pack(lines):
    """Even bytes before odd ones, then differences, then zlib."""
    halves = lines[::2] + lines[1::2]
    return zlib.compress(halves[:1] + bytes((b - a + 128) % 256 for a, b in zip(halves[:-1], halves[1:], strict=True)))


@pytest.mark.parametrize("compression", [NONE, ZIPS, ZIP])
@pytest.mark.parametrize("dtype", [np.float16, np.float32])
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_scan_lines_come_back(tmp_path, compression, dtype, channels):
    values = (RNG.random((37, 19, channels)) * 4).astype(dtype)
    values[3:30] = values[3]  # some chunks shrink, some do not
    (tmp_path / "a.exr").write_bytes(encode_exr(values, compression))
    np.testing.assert_array_equal(read_exr(tmp_path / "a.exr"), values.astype(np.float32))


def test_floats_are_light_already(tmp_path):
    values = (RNG.random((9, 9, 3)) * 4).astype(np.float16)
    (tmp_path / "a.exr").write_bytes(encode_exr(values))
    m = read_image(tmp_path / "a.exr")
    assert m.bits == 32
    np.testing.assert_array_equal(m.image, values)


@pytest.mark.parametrize(
    "data, message",
    [
        (encode_exr(np.zeros((9, 9, 3), np.float16), PIZ), "compressed as PIZ"),
        (encode_exr(np.zeros((9, 9, 3), np.float16), version=2 | 0x200), "tiled"),
        (encode_exr(np.zeros((9, 9, 3), np.float16))[:-100], "cut short"),
        (encode_exr(np.zeros((9, 9, 3), np.float16))[:200], "export it again"),
        (b"\x89PNG\r\n\x1a\n and more", "not an EXR file"),
        (b"no", "export it again"),
    ],
)
def test_what_is_not_read_is_refused(tmp_path, data, message):
    (tmp_path / "a.exr").write_bytes(data)
    with pytest.raises(FileError, match=message) as caught:
        read_exr(tmp_path / "a.exr")
    assert "a.exr" in str(caught.value) and "\n" not in str(caught.value)
