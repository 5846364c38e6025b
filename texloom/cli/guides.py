"""Direction and scale files: JSON arrows or one row a vertex, read and brought onto the vertices of the mended mesh."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float64, Int64

from texloom.errors import FieldError, FileError
from texloom.mesh.model import Model

_KEYS = {"point", "vertex", "direction", "scale"}


@dataclass(frozen=True, eq=False)
class Guides:
    """What the user wants at some vertices; NaN where an arrow leaves the direction or the scale open."""

    vertex: Int64[np.ndarray, "guide"]
    direction: Float64[np.ndarray, "guide 3"]
    scale: Float64[np.ndarray, "guide"]

    def directed(self) -> tuple[Int64[np.ndarray, "n"], Float64[np.ndarray, "n 3"]]:
        """Vertices with a direction, and these."""
        given = np.isfinite(self.direction[:, 0])
        return self.vertex[given], self.direction[given]

    def scaled(self) -> tuple[Int64[np.ndarray, "n"], Float64[np.ndarray, "n"]]:
        """Vertices with a scale, and these."""
        given = np.isfinite(self.scale)
        return self.vertex[given], self.scale[given]


def read_guides(path: Path, model: Model, *, wanted: str) -> Guides:
    """The guides of a file. ``wanted`` is "direction" or "scale": what at least one of them must give.

    Raises: FileError, if it cannot be read; FieldError, if it does not fit the mesh.
    """
    try:
        if path.suffix.lower() == ".json":
            guides = _from_arrows(_load_json(path), model)
        else:
            guides = _from_rows(_load_rows(path), model, wanted)
    except FieldError as error:
        raise FieldError(f"{path.name}: {error}") from None
    if not len((guides.directed() if wanted == "direction" else guides.scaled())[0]):
        raise FieldError(f"{path.name}: none of its {len(guides.vertex)} arrows gives a {wanted}")
    return guides


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
    """A per-vertex array: .npy, or text."""
    try:
        if path.suffix.lower() == ".npy":
            rows = np.load(path, allow_pickle=False)
        else:
            text = path.read_text(encoding="utf-8").replace(",", " ")
            rows = np.array([[float(word) for word in line.split()] for line in text.splitlines() if line.strip()])
        rows = np.asarray(rows, np.float64)
    except FileNotFoundError:
        raise FileError(f"{path}: no such file") from None
    except OSError as error:
        raise FileError(f"{path.name} cannot be read: {error.strerror or error}") from None
    except (ValueError, TypeError, EOFError):
        raise FileError(f"{path.name} is not an array of numbers: give .json arrows, .npy, or rows of text") from None
    return rows.reshape(len(rows), -1) if rows.ndim else rows.reshape(1, 1)


def _from_rows(rows: Float64[np.ndarray, "row column"], model: Model, wanted: str) -> Guides:
    """One row a vertex of the file (or of the mended mesh)."""
    columns = 3 if wanted == "direction" else 1
    if rows.shape[1] != columns:
        raise FieldError(f"a {wanted} array has {columns} column{'s'[: columns - 1]}, this one has {rows.shape[1]}")
    count = int(model.corner_origin.max()) + 1
    if len(rows) < count:
        raise FieldError(f"{len(rows)} rows for a mesh of {count} vertices or more: give one row a vertex")
    if not np.isfinite(rows).all():
        raise FieldError(f"row {int(np.argmin(np.isfinite(rows).all(axis=1)))} (counted from 0) is not finite")
    vertex, origin = _vertex_of(model)
    values = rows[origin]
    nothing = np.full(len(vertex), np.nan)
    if wanted == "direction":
        return Guides(vertex, values, nothing)
    return Guides(vertex, np.full((len(vertex), 3), np.nan), _positive(values[:, 0]))


def _from_arrows(arrows: list[Any], model: Model) -> Guides:
    places, directions, scales = [], [], []
    known = _vertex_of(model)
    for number, arrow in enumerate(arrows):
        try:
            places.append(_place(arrow, model, known))
            directions.append(_numbers(arrow.get("direction", [math.nan] * 3), 3, "direction"))
            scales.append(_numbers([arrow.get("scale", math.nan)], 1, "scale")[0])
        except FieldError as error:
            raise FieldError(f"arrow {number} (counted from 0): {error}") from None
    return Guides(np.array(places, np.int64), np.array(directions), _positive(np.array(scales)))


def _place(arrow: Any, model: Model, known: tuple[Int64[np.ndarray, "n"], Int64[np.ndarray, "n"]]) -> int:
    """The vertex of the mesh an arrow stands at."""
    if not isinstance(arrow, dict) or not set(arrow) <= _KEYS or ("point" in arrow) == ("vertex" in arrow):
        raise FieldError('give "point" or "vertex", and "direction", "scale" or both')
    if "direction" not in arrow and "scale" not in arrow:
        raise FieldError('it has neither "direction" nor "scale"')
    if "point" in arrow:
        point = np.array(_numbers(arrow["point"], 3, "point"))
        return int(np.argmin(((model.mesh.vertices - point) ** 2).sum(axis=1)))
    vertex, origin = known
    found = np.flatnonzero(origin == arrow["vertex"]) if isinstance(arrow["vertex"], int) else []
    if not len(found):
        raise FieldError(f"no face has vertex {arrow['vertex']!r}; the last is {origin.max()} (counted from 0)")
    return int(vertex[found[0]])


def _vertex_of(model: Model) -> tuple[Int64[np.ndarray, "vertex"], Int64[np.ndarray, "vertex"]]:
    """Vertices of the mended mesh and those of the file they came from, each pair once."""
    pairs = np.stack([model.corner_origin.ravel(), model.mesh.faces.ravel()], axis=1).astype(np.int64)
    origin, vertex = np.unique(pairs, axis=0).T
    return vertex, origin


def _numbers(value: Any, count: int, name: str) -> list[float]:
    plain = isinstance(value, list) and all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in value)
    if not plain or len(value) != count or any(math.isinf(x) for x in value):
        raise FieldError(f'"{name}" is {json.dumps(value)[:60]}: give {count} finite number{"s"[: count - 1]}')
    return [float(x) for x in value]


def _positive(scale: Float64[np.ndarray, "guide"]) -> Float64[np.ndarray, "guide"]:
    if (scale <= 0).any():
        raise FieldError(f"scales must be above 0, one is {np.nanmin(scale):g}")
    return scale
