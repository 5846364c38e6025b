"""OFF: counts, positions, polygons, as text."""

import numpy as np

from texloom.errors import FileError
from texloom.io.triangles import Triangles, fan


def read_off(content: bytes) -> Triangles:
    """The triangles of a text OFF file (also COFF, NOFF, STOFF: colours, normals and coordinates are passed over).

    Raises: FileError, naming the line that cannot be meant.
    """
    rows = [(number, line.split(b"#")[0].split()) for number, line in enumerate(content.splitlines(), 1)]
    rows = [(number, words) for number, words in rows if words]
    if not rows or not rows[0][1][0].upper().endswith(b"OFF"):
        raise FileError("not an OFF file: it does not begin with OFF")
    if b"BINARY" in rows[0][1]:
        raise FileError("binary OFF files are not supported: save it as text, or as PLY")
    if len(rows[0][1]) == 1:
        rows = rows[1:]
    else:  # the counts share the first line
        rows[0] = (rows[0][0], rows[0][1][1:])
    try:
        vertex_count, face_count = (int(word) for word in rows[0][1][:2])
    except (ValueError, IndexError):
        raise FileError("the OFF file does not say how many vertices and faces it has") from None
    if len(rows) - 1 < vertex_count + face_count:
        raise FileError(
            f"the OFF file promises {vertex_count} vertices and {face_count} faces, "
            f"{vertex_count + face_count} lines in all, but {len(rows) - 1} follow"
        )
    vertices = _positions(rows[1 : 1 + vertex_count])
    counts, corners = _polygons(rows[1 + vertex_count : 1 + vertex_count + face_count])
    triangles, _ = fan(counts)
    return Triangles(vertices, corners[triangles])


def _positions(rows: list[tuple[int, list[bytes]]]) -> np.ndarray:
    """The first three numbers of each line."""
    positions = np.empty((len(rows), 3))
    for i, (number, words) in enumerate(rows):
        try:
            positions[i] = [float(word) for word in words[:3]]
        except ValueError:
            raise FileError(f"line {number}: a vertex needs three numbers") from None
    return positions


def _polygons(rows: list[tuple[int, list[bytes]]]) -> tuple[np.ndarray, np.ndarray]:
    """How many corners each polygon has, and all corners strung together."""
    counts, corners = np.empty(len(rows), np.int64), []
    for i, (number, words) in enumerate(rows):
        try:
            counts[i] = int(words[0])
            named = [int(word) for word in words[1 : 1 + counts[i]]]
        except ValueError:
            raise FileError(f"line {number}: a face needs a count and as many whole numbers") from None
        if counts[i] < 3 or len(named) < counts[i]:
            raise FileError(
                f"line {number}: a face of {counts[i]} vertices names {len(named)}; three or more are needed"
            )
        corners += named
    return counts, np.array(corners, np.int64)
