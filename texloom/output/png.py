"""A PNG writer: 8 and 16 bits, 1 to 4 channels, text chunks, all threads.

Pillow cannot write 16-bit colour. Rows are filtered, then deflated in fixed blocks over the thread pool, so the file is
the same for any number of threads.
"""

import struct
import zlib
from collections.abc import Mapping

import numpy as np
from jaxtyping import UInt8, UInt16

from texloom.kernels.launch import parallel_map

_COLOUR_TYPES = {1: 0, 2: 4, 3: 2, 4: 6}  # channels to PNG colour type
_BLOCK = 1 << 20  # bytes deflated at a time
_LEVEL = 4


def png_bytes(
    image: UInt8[np.ndarray, "row column channel"] | UInt16[np.ndarray, "row column channel"],
    *,
    text: Mapping[str, str] | None = None,
    srgb: bool = False,
) -> bytes:
    """A whole PNG file. ``text`` goes into iTXt chunks; ``srgb`` marks the values as sRGB colours."""
    rows, columns, channels = image.shape
    header = struct.pack(">IIBBBBB", columns, rows, image.dtype.itemsize * 8, _COLOUR_TYPES[channels], 0, 0, 0)
    chunks = [_chunk(b"IHDR", header)]
    if srgb:
        chunks.append(_chunk(b"sRGB", b"\0"))
    for keyword, value in (text or {}).items():
        body = keyword.encode("latin-1") + b"\0\0\0\0\0" + value.encode("utf-8")
        chunks.append(_chunk(b"iTXt", body))
    chunks += [_chunk(b"IDAT", _deflate(_filtered(image))), _chunk(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def _chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def _filtered(image: np.ndarray) -> UInt8[np.ndarray, "row byte"]:
    """Rows as bytes, each behind its filter type: the one of none, sub and up that leaves the least sum of |bytes|."""
    rows = len(image)
    raw = image.astype(image.dtype.newbyteorder(">"), copy=False).reshape(rows, -1).view(np.uint8)
    pixel = image.shape[2] * image.dtype.itemsize
    filtered = np.empty((rows, 1 + raw.shape[1]), np.uint8)
    block = max(1, _BLOCK // raw.shape[1])

    def filter_block(number: int) -> None:
        first, last = number * block, min((number + 1) * block, rows)
        here = raw[first:last]
        sub = here.copy()
        sub[:, pixel:] -= here[:, :-pixel]
        up = here.copy()
        up[max(0, 1 - first) :] -= raw[max(first - 1, 0) : last - 1]
        choices = (here, sub, up)
        cost = [np.abs(choice.view(np.int8)).sum(axis=1, dtype=np.int64) for choice in choices]
        best = np.argmin(cost, axis=0)
        filtered[first:last, 0] = best
        for kind, choice in enumerate(choices):
            filtered[first:last, 1:][best == kind] = choice[best == kind]

    parallel_map(filter_block, -(-rows // block))
    return filtered


def _deflate(data: UInt8[np.ndarray, "row byte"]) -> bytes:
    """A zlib stream, deflated in blocks that end on byte borders and simply follow one another."""
    view = memoryview(data.tobytes())
    count = -(-len(view) // _BLOCK)

    def deflate_block(number: int) -> bytes:
        deflater = zlib.compressobj(_LEVEL, zlib.DEFLATED, -15)
        body = deflater.compress(view[number * _BLOCK : (number + 1) * _BLOCK])
        return body + deflater.flush(zlib.Z_FINISH if number == count - 1 else zlib.Z_FULL_FLUSH)

    return b"\x78\x9c" + b"".join(parallel_map(deflate_block, count)) + struct.pack(">I", zlib.adler32(view))
