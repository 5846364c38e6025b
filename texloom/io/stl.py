"""STL: triangles that share no vertices, binary or text."""

import numpy as np

from texloom.errors import FileError
from texloom.io.triangles import Triangles

_HEADER, _TRIANGLE = 84, 50  # bytes


def read_stl(content: bytes) -> Triangles:
    """The triangles of an STL file, each with its own three vertices; normals are passed over.

    Raises: FileError, if the file is cut short.
    """
    promised = int.from_bytes(content[80:84], "little") if len(content) >= _HEADER else -1
    if promised >= 0 and len(content) == _HEADER + _TRIANGLE * promised:
        return _soup(_binary(content, promised))
    if content.lstrip()[:5].lower() == b"solid" and b"\0" not in content[:512]:
        return _soup(_text(content))
    if promised < 0:
        raise FileError(f"not an STL file: {len(content)} bytes are too few for a header")
    raise FileError(
        f"not an STL file, or cut short: its header promises {promised} triangles "
        f"({_HEADER + _TRIANGLE * promised} bytes), it has {len(content)} bytes"
    )


def _binary(content: bytes, count: int) -> np.ndarray:
    """Corners of each triangle; 12 little-endian floats (normal, three corners) and two bytes each."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    return np.frombuffer(content, record, count, _HEADER)["corners"]


def _text(content: bytes) -> np.ndarray:
    """Corners of each triangle: the lines ``vertex x y z``, three by three."""
    lines = [(number, line.split()) for number, line in enumerate(content.splitlines(), 1)]
    corners = []
    for number, words in lines:
        if words and words[0].lower() == b"vertex":
            try:
                x, y, z = (float(word) for word in words[1:])
            except ValueError:
                raise FileError(f"line {number}: a vertex needs three numbers") from None
            corners.append((x, y, z))
    if len(corners) % 3:
        raise FileError(f"the STL file is cut short: {len(corners)} vertices do not make whole triangles")
    return np.array(corners, np.float64).reshape(-1, 3, 3)


def _soup(corners: np.ndarray) -> Triangles:
    vertices = corners.reshape(-1, 3).astype(np.float64)
    return Triangles(vertices, np.arange(len(vertices), dtype=np.int32).reshape(-1, 3))
