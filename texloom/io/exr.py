"""OpenEXR scan-line images, uncompressed or ZIP (what renderers and texture sites write for data maps).

Format: "OpenEXR File Layout" (openexr.com). Tiles, several parts, and the PIZ, PXR24, B44 and DWA compressions are
refused by name.
"""

import struct
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float32

from texloom.errors import FileError

_MAGIC = 20000630
_COMPRESSIONS = ("none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB")
_ROWS_PER_CHUNK = {"none": 1, "ZIPS": 1, "ZIP": 16}
_TYPES = (np.dtype("<u4"), np.dtype("<f2"), np.dtype("<f4"))
_ORDERS = ("RGBA", "RGB", "YA", "Y")


def read_exr(path: str | Path) -> Float32[np.ndarray, "row column channel"]:
    """Values as they are: linear light or data, grey or colour, opacity last.

    Raises: FileError, if the file is broken or laid out in a way that is not read.
    """
    path = Path(path)
    try:
        planes = _read_planes(path.read_bytes(), path.name)
    except (struct.error, zlib.error, ValueError, IndexError, KeyError, OverflowError, MemoryError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"{path.name} is not an EXR file that can be read: export it again") from error
    order = next((names for names in _ORDERS if set(names) <= set(planes)), None)
    if order is None:
        order = sorted(planes)[:1]
    return np.stack([planes[name] for name in order], axis=-1)


def _read_planes(data: bytes, name: str) -> dict[str, Float32[np.ndarray, "row column"]]:
    """Every channel by name."""
    header, place = _header(data, name)
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    rows, columns = bottom - top + 1, right - left + 1
    channels = _channels(header["channels"], name)
    compression = _COMPRESSIONS[header["compression"][0]]
    if compression not in _ROWS_PER_CHUNK:
        raise FileError(f"{name} is compressed as {compression}, which is not read: save it as ZIP or as 16-bit PNG")
    planes = {channel: np.empty((rows, columns), np.float32) for channel in channels}
    step = _ROWS_PER_CHUNK[compression]
    offsets = struct.unpack_from(f"<{-(-rows // step)}Q", data, place)
    for offset in offsets:
        row, size = struct.unpack_from("<ii", data, offset)
        count = min(step, bottom + 1 - row)
        expected = count * columns * sum(kind.itemsize for kind in channels.values())
        chunk = data[offset + 8 : offset + 8 + size]
        lines = chunk if size == expected else _unzip(chunk)  # what compression would enlarge is stored as it is
        if len(lines) != expected:
            raise FileError(
                f"{name} is cut short: {len(lines)} of {expected} bytes at row {row - top}; export it again"
            )
        _spread(lines, channels, planes, row - top, count)
    return planes


def _header(data: bytes, name: str) -> tuple[dict[str, bytes], int]:
    """The attributes, and where they end."""
    magic, version = struct.unpack_from("<II", data)
    if magic != _MAGIC:
        raise FileError(f"{name} is not an EXR file: use PNG, JPEG, TIFF or EXR")
    if version & 0x1A00:
        raise FileError(f"{name} is a tiled, deep or many-part EXR, which is not read: save it as scan lines")
    attributes, place = {}, 8
    while data[place] != 0:
        end = data.index(b"\0", place)
        kind_end = data.index(b"\0", end + 1)
        (size,) = struct.unpack_from("<i", data, kind_end + 1)
        attributes[data[place:end].decode("latin-1")] = data[kind_end + 5 : kind_end + 5 + size]
        place = kind_end + 5 + size
    return attributes, place + 1


def _channels(data: bytes, name: str) -> dict[str, np.dtype]:
    """Name and type of each channel, in the order they are stored."""
    channels, place = {}, 0
    while data[place] != 0:
        end = data.index(b"\0", place)
        kind, _, across, down = struct.unpack_from("<4i", data, end + 1)
        if (across, down) != (1, 1):
            raise FileError(f"{name} has channels of lower resolution, which are not read: save them whole")
        channels[data[place:end].decode("latin-1")] = _TYPES[kind]
        place = end + 17
    return channels


def _unzip(chunk: bytes) -> bytes:
    """Undo ZIP, then the running difference, then the split of bytes into even and odd."""
    stored = np.frombuffer(zlib.decompress(chunk), np.uint8)
    difference = stored.astype(np.int64) - 128
    difference[0] += 128
    halves = np.cumsum(difference).astype(np.uint8)
    lines = np.empty_like(halves)
    middle = (len(halves) + 1) // 2
    lines[::2], lines[1::2] = halves[:middle], halves[middle:]
    return lines.tobytes()


def _spread(
    lines: bytes,
    channels: Mapping[str, np.dtype],
    planes: Mapping[str, Float32[np.ndarray, "row column"]],
    first: int,
    count: int,
) -> None:
    """Write a chunk, where each row holds its channels one after the other, into the planes."""
    place = 0
    for row in range(first, first + count):
        for channel, kind in channels.items():
            plane = planes[channel]
            plane[row] = np.frombuffer(lines, kind, plane.shape[1], place)
            place += plane.shape[1] * kind.itemsize
