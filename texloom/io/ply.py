"""PLY: text or binary, any properties; positions, texture coordinates at vertices, polygons."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from texloom.errors import FileError
from texloom.io.triangles import Triangles, fan

_KINDS = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
_UV_NAMES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
_Column = tuple[np.ndarray, np.ndarray]  # a list property: counts of each row, values strung together


@dataclass
class _Element:
    """One block of rows the header promises."""

    name: str
    count: int
    kinds: dict[str, str] = field(default_factory=dict)  # property → NumPy kind of its values
    lists: dict[str, str] = field(default_factory=dict)  # list property → NumPy kind of its count


def read_ply(content: bytes) -> Triangles:
    """The triangles of a PLY file.

    Raises: FileError, if the header and the rows below it disagree.
    """
    tables = read_tables(content)
    vertex, face = tables.get("vertex", {}), tables.get("face", {})
    if not {"x", "y", "z"} <= vertex.keys():
        raise FileError("the PLY file has no vertex positions (x, y, z)")
    vertices = np.stack([np.asarray(vertex[axis], np.float64) for axis in "xyz"], axis=1)
    column = face.get("vertex_indices", face.get("vertex_index"))
    if not isinstance(column, tuple):
        return Triangles(vertices, np.zeros((0, 3), np.int32))
    counts, corners = column
    if (counts < 3).any():
        row = int(np.argmax(counts < 3))
        raise FileError(f"face {row} (counted from 0) has {int(counts[row])} vertices: three or more are needed")
    triangles, _ = fan(counts)
    faces = corners[triangles].astype(np.int64)
    return Triangles(vertices, faces, _uv(vertex, face, faces, triangles, counts))


def read_tables(content: bytes) -> dict[str, dict[str, Any]]:
    """The columns of every element of a PLY file, by name; list properties as (counts, values strung together).

    Raises: FileError, if the header and the rows below it disagree.
    """
    order, elements, body, line = _header(content)
    return _text_tables(elements, body, line) if order is None else _binary_tables(elements, body, order)


def _uv(
    vertex: dict[str, Any], face: dict[str, Any], faces: np.ndarray, triangles: np.ndarray, counts: np.ndarray
) -> np.ndarray | None:
    """Texture coordinates at corners, from the faces' own list or from the vertices."""
    listed = face.get("texcoord")
    if isinstance(listed, tuple) and np.array_equal(listed[0], 2 * counts):
        return np.asarray(listed[1], np.float32).reshape(-1, 2)[triangles]
    for u, v in _UV_NAMES:
        if u in vertex and v in vertex and faces.size and 0 <= faces.min() and faces.max() < len(vertex[u]):
            return np.stack([vertex[u], vertex[v]], axis=1).astype(np.float32)[faces]
    return None


def _header(content: bytes) -> tuple[str | None, list[_Element], bytes, int]:
    """Byte order ("<", ">", None for text), the elements promised, the rest of the file and the lines before it."""
    end = content.find(b"end_header")
    if not content.startswith(b"ply") or end < 0:
        raise FileError("not a PLY file: it has no PLY header")
    start = content.find(b"\n", end) + 1 or len(content)
    order: str | None = None
    elements: list[_Element] = []
    lines = content[:start].decode("ascii", "replace").splitlines()
    for number, line in enumerate(lines, 1):
        words = line.split()
        try:
            if words[:1] == ["format"]:
                order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
            elif words[:1] == ["element"]:
                elements.append(_Element(words[1], int(words[2])))
                if elements[-1].count < 0:
                    raise ValueError
            elif words[:2] == ["property", "list"]:
                elements[-1].lists[words[4]] = _KINDS[words[2]]
                elements[-1].kinds[words[4]] = _KINDS[words[3]]
            elif words[:1] == ["property"]:
                elements[-1].kinds[words[2]] = _KINDS[words[1]]
        except (KeyError, IndexError, ValueError):
            raise FileError(f"line {number} of the PLY header cannot be read: '{line[:40]}'") from None
    return order, elements, content[start:], len(lines)


def _text_tables(elements: list[_Element], body: bytes, line: int) -> dict[str, dict[str, Any]]:
    """Columns of every element; each row stands on a line of its own."""
    rows = [row for row in (text.split() for text in body.splitlines()) if row]
    promised = sum(element.count for element in elements)
    if len(rows) != promised:
        raise FileError(
            f"the PLY header promises {_promise(elements)}, {promised} lines in all, but {len(rows)} follow"
        )
    tables: dict[str, dict[str, Any]] = {}
    first = 0
    for element in elements:
        tables[element.name] = _text_table(element, rows[first : first + element.count], line + first + 1)
        first += element.count
    return tables


def _text_table(element: _Element, rows: list[list[bytes]], line: int) -> dict[str, Any]:
    """Columns of one element given as words."""
    columns: dict[str, list[Any]] = {name: [] for name in element.kinds}
    for number, row in enumerate(rows):
        at = 0
        try:
            for name in element.kinds:
                if name in element.lists:
                    count = int(row[at])
                    values = row[at + 1 : at + 1 + count]
                    at += 1 + count
                else:
                    values, at = row[at : at + 1], at + 1
                columns[name].append([float(value) for value in values])
            if at != len(row):
                raise ValueError
        except (ValueError, IndexError):
            raise FileError(
                f"line {line + number}: this is not the {element.name} the PLY header promises "
                f"({' '.join(element.kinds)}): are its counts right?"
            ) from None
    return {name: _strung(values, name in element.lists) for name, values in columns.items()}


def _strung(values: list[list[float]], is_list: bool) -> np.ndarray | _Column:
    """A column of single values, or of lists."""
    flat = np.array([value for row in values for value in row], np.float64)
    return (np.array([len(row) for row in values], np.int64), flat) if is_list else flat


def _binary_tables(elements: list[_Element], body: bytes, order: str) -> dict[str, dict[str, Any]]:
    """Columns of every element, one after the other in the body."""
    tables: dict[str, dict[str, Any]] = {}
    start = 0
    for element in elements:
        try:
            tables[element.name], start = _binary_table(element, body, start, order)
        except (ValueError, IndexError):
            raise FileError(
                f"the PLY file is cut short, or its header is wrong: it promises {_promise(elements)}, "
                f"but the {len(body)} bytes below it do not hold them"
            ) from None
    if body[start:].strip(b"\0\r\n \t"):
        raise FileError(
            f"the PLY header promises {_promise(elements)}, but {len(body) - start} bytes more follow: "
            "its counts are wrong"
        )
    return tables


def _binary_table(element: _Element, body: bytes, start: int, order: str) -> tuple[dict[str, Any], int]:
    """Columns of one element, and where the next begins; rows of equal lists are read at one go."""
    lengths = {name: 0 for name in element.lists}
    if element.count and element.lists:
        first_row, _ = _binary_row(element, body, start, order)
        lengths = {name: len(first_row[name]) for name in element.lists}
    record = []
    for name, kind in element.kinds.items():
        if name in element.lists:
            record.append((f"{name} count", order + element.lists[name]))
            record.append((name, order + kind, (lengths[name],)))
        else:
            record.append((name, order + kind))
    whole = np.dtype(record)
    if start + whole.itemsize * element.count <= len(body):
        table = np.frombuffer(body, whole, element.count, start)
        if all((table[f"{name} count"] == length).all() for name, length in lengths.items()):
            columns = {
                name: (np.full(element.count, lengths[name]), table[name].reshape(-1))
                if name in lengths
                else table[name]
                for name in element.kinds
            }
            return columns, start + whole.itemsize * element.count
    return _uneven_table(element, body, start, order)


def _uneven_table(element: _Element, body: bytes, start: int, order: str) -> tuple[dict[str, Any], int]:
    """Columns of an element whose lists differ in length, row by row."""
    rows = []
    for _ in range(element.count):
        row, start = _binary_row(element, body, start, order)
        rows.append(row)
    columns: dict[str, Any] = {}
    for name in element.kinds:
        flat = np.concatenate([row[name] for row in rows]) if rows else np.zeros(0)
        columns[name] = (np.array([len(row[name]) for row in rows], np.int64), flat) if name in element.lists else flat
    return columns, start


def _binary_row(element: _Element, body: bytes, start: int, order: str) -> tuple[dict[str, np.ndarray], int]:
    """The values of one row, and where the next begins."""
    row = {}
    for name, kind in element.kinds.items():
        count = 1
        if name in element.lists:
            counter = np.dtype(order + element.lists[name])
            count = int(np.frombuffer(body, counter, 1, start)[0])
            start += counter.itemsize
        values = np.dtype(order + kind)
        row[name] = np.frombuffer(body, values, count, start) if count else np.zeros(0, values)
        start += values.itemsize * count
    return row, start


def _promise(elements: list[_Element]) -> str:
    """What the header promises, in words."""
    return " and ".join(f"{element.count} {element.name} rows" for element in elements)
