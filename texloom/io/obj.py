"""Wavefront OBJ: positions, texture coordinates at corners, polygons, material names.

Most files are positions, then polygons of one size, and little else: those are read at one go (``_plain``), all others
line by line.
"""

import re
from itertools import chain

import numpy as np

from texloom.errors import FileError
from texloom.io.numbers import floats, integers, table
from texloom.io.triangles import Triangles, fan

_Numbered = list[tuple[int, list[bytes]]]  # (line of the file, its words)


def read_obj(content: bytes) -> Triangles:
    """The triangles of an OBJ file; normals, lines, groups and free-form surfaces are passed over.

    Raises: FileError, naming the line that cannot be meant.
    """
    plain = _plain(content)
    if plain is not None:
        return plain
    positions: _Numbered = []
    coordinates: _Numbered = []
    polygons: _Numbered = []
    before: list[tuple[int, int]] = []  # positions and coordinates read before each polygon, for relative indices
    materials: dict[str, int] = {}
    material_of_polygon: list[int] = []
    material = -1
    for number, line in enumerate(content.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines(), 1):
        words = line.split()
        if not words:
            continue
        if words[0] == b"v":
            positions.append((number, words))
        elif words[0] == b"vt":
            coordinates.append((number, words))
        elif words[0] == b"f":
            polygons.append((number, words))
            before.append((len(positions), len(coordinates)))
            material_of_polygon.append(material)
        elif words[0] == b"usemtl":
            name = b" ".join(words[1:]).decode("utf-8", "replace")
            material = materials.setdefault(name, len(materials))

    vertices = _numbers(positions, 3, "a position")
    uv = _numbers(coordinates, 2, "a texture coordinate")
    counts = np.array([len(words) - 1 for _, words in polygons], np.int64)
    _check_counts(counts, polygons)
    lines = np.repeat([number for number, _ in polygons], counts)
    position, coordinate = _indices(polygons, counts, np.array(before).reshape(-1, 2))
    _check_range(position, len(vertices), lines, "vertex")
    if uv.size:
        _check_range(coordinate[coordinate != _NONE], len(uv), lines[coordinate != _NONE], "texture coordinate")

    corners, polygon = fan(counts)
    has_uv = len(uv) > 0 and len(coordinate) > 0 and (coordinate != _NONE).all()
    return Triangles(
        vertices,
        position[corners].astype(np.int32),
        uv[coordinate[corners]].astype(np.float32) if has_uv else None,
        np.array(material_of_polygon, np.int32)[polygon],
        tuple(materials),
    )


_PASSED_OVER = re.compile(rb"^(?:#|(?:vn|o|g|s|mtllib)\b).*(?:\n|\Z)|^[ \t]*\n", re.MULTILINE)
_OF_NUMBERS = b"0123456789+-.eE \t\n"


def _plain(content: bytes) -> Triangles | None:
    """The triangles of a file of positions, then polygons of one size, with no more to a corner than its position.

    None for any other file, right or wrong.
    """
    content = content.replace(b"\r\n", b"\n").strip()
    if b"\r" in content or b"\\" in content:  # other ways to end a line, or not to
        return None
    keywords = content.translate(None, _OF_NUMBERS)
    if keywords.strip(b"vf"):
        content = _PASSED_OVER.sub(b"", content)
        keywords = content.translate(None, _OF_NUMBERS)
    positions, polygons = keywords.count(b"v"), keywords.count(b"f")
    if not (positions and polygons) or keywords != b"v" * positions + b"f" * polygons:
        return None
    cut = content.index(b"f")
    vertices = table(content[:cut], b"v", rows=positions, numbers=floats)
    corners = table(content[cut:], b"f", rows=polygons, numbers=integers)
    if vertices is None or corners is None or min(vertices.shape[1], corners.shape[1]) < 3:
        return None
    corners = np.where(corners < 0, positions + corners, corners - 1)
    if corners.min() < 0 or corners.max() >= positions:
        return None
    triangles, _ = fan(np.full(polygons, corners.shape[1]))
    faces = corners.reshape(-1)[triangles].astype(np.int32)
    return Triangles(np.ascontiguousarray(vertices[:, :3]), faces, material=np.full(len(faces), -1, np.int32))


_NONE = np.iinfo(np.int64).min  # a corner without texture coordinate


def _numbers(lines: _Numbered, width: int, what: str) -> np.ndarray:
    """The first ``width`` numbers of each line."""
    try:
        return np.array([words[1 : width + 1] for _, words in lines], "S").reshape(-1, width).astype(np.float64)
    except ValueError:
        pass
    for number, words in lines:
        try:
            if len(list(map(float, words[1 : width + 1]))) < width:
                raise ValueError
        except ValueError:
            shown = b" ".join(words).decode("utf-8", "replace")[:40]
            raise FileError(f"line {number}: {what} needs {width} numbers, got '{shown}'") from None
    return np.array([[float(word) for word in words[1 : width + 1]] for _, words in lines]).reshape(-1, width)


def _check_counts(counts: np.ndarray, polygons: _Numbered) -> None:
    """Every face needs three corners."""
    short = np.flatnonzero(counts < 3)
    if len(short):
        number, words = polygons[short[0]]
        shown = b" ".join(words).decode("utf-8", "replace")[:40]
        raise FileError(f"line {number}: a face needs three vertices or more, got '{shown}' (is the file cut short?)")


def _indices(polygons: _Numbered, counts: np.ndarray, before: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position and texture coordinate of every corner, counted from 0; relative indices resolved."""
    words = list(chain.from_iterable(words[1:] for _, words in polygons))
    if any(b"/" in word for word in words):
        parts = [word.split(b"/") for word in words]
        position = _integers([part[0] for part in parts], polygons)
        coordinate = _integers([part[1] if len(part) > 1 and part[1] else b"0" for part in parts], polygons)
    else:
        position, coordinate = _integers(words, polygons), np.zeros(len(words), np.int64)
    before = np.repeat(before, counts, axis=0)
    position = np.where(position < 0, before[:, 0] + position, position - 1)
    coordinate = np.where(coordinate < 0, before[:, 1] + coordinate, np.where(coordinate == 0, _NONE, coordinate - 1))
    return position, coordinate


def _integers(words: list[bytes], polygons: _Numbered) -> np.ndarray:
    """Words as integers; the first line with a word that is none is named."""
    try:
        return np.array(words, "S").astype(np.int64) if words else np.zeros(0, np.int64)
    except (ValueError, OverflowError):
        pass
    for number, line in polygons:
        for word in chain.from_iterable(part.split(b"/") for part in line[1:]):
            if word and not word.lstrip(b"+-").isdigit():
                shown = b" ".join(line).decode("utf-8", "replace")[:40]
                raise FileError(f"line {number}: '{shown}' is not a face") from None
    raise FileError("a face names a vertex that is not a number")


def _check_range(indices: np.ndarray, count: int, lines: np.ndarray, what: str) -> None:
    """Every index names something read."""
    outside = np.flatnonzero((indices < 0) | (indices >= count))
    if len(outside):
        index, line = int(indices[outside[0]]), int(lines[outside[0]])
        plural = "vertices" if what == "vertex" else "texture coordinates"
        raise FileError(f"line {line}: the face names {what} {index + 1}, but the file has {count} {plural}")
