"""Direction and scale files: JSON arrows, or one row a vertex, brought onto the vertices of the mended mesh."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float64, Int64

from texloom.errors import FieldError, FileError
from texloom.field.arrows import Arrow
from texloom.mesh.model import Model

_KEYS = {"point": 3, "vertex": 0, "direction": 3, "scale": 1}  # how many numbers each takes


def holds_arrows(path: Path) -> bool:
    """Whether a file is one of arrows rather than of rows."""
    return path.suffix.lower() == ".json"


def read_arrows(path: Path, model: Model) -> list[Arrow]:
    """The arrows of a JSON file; their vertices, counted as in the mesh's file, become those of the mended mesh.

    Raises: FileError, if it cannot be read; FieldError, naming the arrow that is wrong.
    """
    vertex_of = dict(zip(*(part.tolist() for part in _origins(model)), strict=True))
    arrows = []
    for number, entry in enumerate(_load_json(path)):
        try:
            arrows.append(_arrow(entry, vertex_of))
        except FieldError as error:
            raise FieldError(f"{path.name}: arrow {number} (counted from 0): {error}") from None
    return arrows


def read_rows(path: Path, model: Model, *, columns: int) -> Float64[np.ndarray, "vertex columns"]:
    """Numbers for every vertex of the mended mesh, from a file with one row for each vertex of the mesh's file.

    Raises: FileError, if it cannot be read; FieldError, if it does not fit the mesh.
    """
    rows = _load_rows(path)
    origin, vertex = _origins(model)
    if rows.shape[1] != columns:
        raise FieldError(f"{path.name} has {rows.shape[1]} numbers a row: give {columns} for each vertex")
    if len(rows) <= origin.max():
        raise FieldError(
            f"{path.name} has {len(rows)} rows, but faces use vertices up to {origin.max()} (counted from 0): "
            "give one row for each vertex"
        )
    values = np.empty((len(model.mesh.vertices), columns))
    values[vertex] = rows[origin]
    return values


def _origins(model: Model) -> tuple[Int64[np.ndarray, "pair"], Int64[np.ndarray, "pair"]]:
    """Vertices of the file and the vertices of the mended mesh they became, each pair once."""
    pairs = np.stack([model.corner_origin.ravel(), model.mesh.faces.ravel()], axis=1).astype(np.int64)
    origin, vertex = np.unique(pairs, axis=0).T
    return origin, vertex


def _load_json(path: Path) -> list[Any]:
    try:
        arrows = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise FileError(f"{path}: no such file") from None
    except OSError as error:
        raise FileError(f"{path.name} cannot be read: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise FileError(f"{path.name} is not JSON: {error}") from None
    if not isinstance(arrows, list) or not arrows:
        raise FileError(f'{path.name}: give a list of arrows such as [{{"vertex": 0, "direction": [0, 1, 0]}}]')
    return arrows


def _load_rows(path: Path) -> Float64[np.ndarray, "row column"]:
    """A table of numbers: .npy, or text with blanks or commas between."""
    try:
        if path.suffix.lower() == ".npy":
            rows = np.asarray(np.load(path, allow_pickle=False), np.float64)
        else:
            text = path.read_text(encoding="utf-8").replace(",", " ")
            rows = np.array([[float(word) for word in line.split()] for line in text.splitlines() if line.strip()])
        return rows.reshape(len(rows), -1)
    except FileNotFoundError:
        raise FileError(f"{path}: no such file") from None
    except OSError as error:
        raise FileError(f"{path.name} cannot be read: {error.strerror or error}") from None
    except (ValueError, TypeError, EOFError):
        raise FileError(f"{path.name} is not a table of numbers: give .json arrows, .npy, or rows of text") from None


def _arrow(entry: Any, vertex_of: dict[int, int]) -> Arrow:
    """One arrow as it was written."""
    if not isinstance(entry, dict):
        raise FieldError('it is not of the form {"point": [x, y, z], "direction": [x, y, z], "scale": s}')
    unknown = sorted(set(entry) - set(_KEYS))
    if unknown:
        raise FieldError(f'"{unknown[0]}" is unknown: use point, vertex, direction and scale')
    given: dict[str, Any] = {name: _numbers(name, value) for name, value in entry.items() if name != "vertex"}
    if "vertex" in entry:
        vertex = entry["vertex"]
        if type(vertex) is not int or vertex not in vertex_of:
            raise FieldError(f"no face has vertex {vertex!r}; the last is {max(vertex_of)} (counted from 0)")
        given["vertex"] = vertex_of[vertex]
    return Arrow(**given)


def _numbers(name: str, value: Any) -> tuple[float, ...] | float:
    """The numbers of a key: three, or one."""
    count = _KEYS[name]
    numbers = value if isinstance(value, list) else [value]
    if len(numbers) != count or any(isinstance(x, bool) or not isinstance(x, (int, float)) for x in numbers):
        raise FieldError(f'"{name}" is {json.dumps(value)[:60]}: give {count} number{"s" if count > 1 else ""}')
    return float(numbers[0]) if count == 1 else tuple(float(x) for x in numbers)
