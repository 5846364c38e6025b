"""An OpenEXR writer: scan lines of 32-bit floats, losslessly packed (ZIP, 16 lines a block), linear light."""

import struct
import zlib
from collections.abc import Mapping

import numpy as np
from jaxtyping import Float32

from texloom.kernels.launch import parallel_map

_NAMES = {1: "Y", 2: "YA", 3: "RGB", 4: "RGBA"}
_LINES = 16  # scan lines of a ZIP block
_ZIP = 3
_FLOAT = 2


def exr_bytes(image: Float32[np.ndarray, "row column channel"], *, text: Mapping[str, str] | None = None) -> bytes:
    """A whole EXR file; channels are stored in alphabetical order, as the format asks. ``text`` becomes attributes."""
    rows, columns, channels = image.shape
    names = sorted(_NAMES[channels])
    planes = np.stack([image[..., _NAMES[channels].index(name)] for name in names], axis=1).astype("<f4")

    def block(number: int) -> bytes:
        first = number * _LINES
        packed = _pack(planes[first : first + _LINES].tobytes())
        return struct.pack("<ii", first, len(packed)) + packed

    blocks = parallel_map(block, -(-rows // _LINES))
    header = _header(rows, columns, names, text or {})
    starts = len(header) + 8 * len(blocks) + np.cumsum([0] + [len(b) for b in blocks[:-1]])
    return header + starts.astype("<u8").tobytes() + b"".join(blocks)


def _header(rows: int, columns: int, names: list[str], text: Mapping[str, str]) -> bytes:
    """Magic number, version and attributes."""
    window = struct.pack("<iiii", 0, 0, columns - 1, rows - 1)
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", _FLOAT, 0, 1, 1) for name in names) + b"\0"
    attributes = [
        ("channels", "chlist", channels),
        ("compression", "compression", bytes([_ZIP])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
        ("screenWindowCenter", "v2f", struct.pack("<ff", 0.0, 0.0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1.0)),
        *((key[:31], "string", value.encode("utf-8")) for key, value in text.items()),
    ]
    body = b"".join(
        name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
        for name, kind, value in attributes
    )
    return struct.pack("<ii", 20000630, 2) + body + b"\0"


def _pack(raw: bytes) -> bytes:
    """EXR's ZIP: bytes split into even and odd, differenced, deflated; left as they are where that is no shorter."""
    data = np.frombuffer(raw, np.uint8)
    split = np.concatenate([data[0::2], data[1::2]]).astype(np.int16)
    predicted = split.copy()
    predicted[1:] = split[1:] - split[:-1] + 128
    packed = zlib.compress(predicted.astype(np.uint8).tobytes(), 4)
    return packed if len(packed) < len(raw) else raw
