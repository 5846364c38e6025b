"""Direction and scale files: JSON arrows, or one row a vertex."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float64

from texloom.errors import FieldError, FileError
from texloom.field.arrows import Arrow

_KEYS = {"point", "vertex", "direction", "scale"}
_EXAMPLE = '[{"vertex": 0, "direction": [0, 1, 0], "scale": 1}]'


def read_arrows(path: Path) -> tuple[Arrow, ...]:
    """The arrows of a JSON file: a list of ``{"point": [x, y, z] | "vertex": i, "direction": [x, y, z], "scale": s}``.

    Raises: FileError, if it cannot be read; FieldError, if an arrow is wrong, naming it.
    """
    try:
        entries = json.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise FileError(f"{path.name} cannot be read: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise FileError(f"{path.name} is not JSON ({error}): give a list such as {_EXAMPLE}") from None
    if not isinstance(entries, list) or not entries:
        raise FileError(f"{path.name} holds no list of arrows: give a list such as {_EXAMPLE}")
    return tuple(_arrow(entry, f"{path.name}, arrow {number}") for number, entry in enumerate(entries))


def read_rows(path: Path) -> Float64[np.ndarray, "row column"]:
    """A per-vertex array: .npy, or text with one vertex a line (blanks or commas between numbers, # for remarks).

    Raises: FileError, if it cannot be read or is no array of finite numbers.
    """
    try:
        rows = _load(path)
    except OSError as error:
        raise FileError(f"{path.name} cannot be read: {error.strerror or error}") from None
    except (ValueError, TypeError, EOFError):
        raise FileError(f"{path.name} is no array of numbers: give .npy, or text with one vertex a line") from None
    if rows.size == 0 or rows.ndim > 2:
        raise FileError(f"{path.name} has shape {rows.shape}: give one row for each vertex")
    rows = rows.reshape(len(rows) if rows.ndim else 1, -1)
    wrong = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if len(wrong):
        raise FileError(f"{path.name}: {len(wrong)} of {len(rows)} rows are not finite, the first is row {wrong[0]}")
    return rows


def _load(path: Path) -> Float64[np.ndarray, "..."]:
    if path.suffix.lower() == ".npy":
        return np.asarray(np.load(path, allow_pickle=False), np.float64)
    lines = [line.split("#")[0].replace(",", " ").split() for line in path.read_text(encoding="utf-8-sig").splitlines()]
    return np.array([[float(word) for word in line] for line in lines if line], np.float64)


def _arrow(entry: Any, where: str) -> Arrow:
    if not isinstance(entry, dict):
        raise FieldError(f"{where} is no object: write one such as {_EXAMPLE[1:-1]}")
    unknown = sorted(set(entry) - _KEYS)
    if unknown:
        raise FieldError(f'{where} has "{unknown[0]}": known are "point", "vertex", "direction" and "scale"')
    vertex, scale = entry.get("vertex"), entry.get("scale")
    if vertex is not None and (not isinstance(vertex, int) or isinstance(vertex, bool)):
        raise FieldError(f"{where}: vertex {vertex!r} is no whole number")
    if scale is not None and not _is_number(scale):
        raise FieldError(f"{where}: scale {scale!r} is no number")
    try:
        return Arrow(
            point=_triple(entry.get("point"), "point"),
            vertex=vertex,
            direction=_triple(entry.get("direction"), "direction"),
            scale=None if scale is None else float(scale),
        )
    except FieldError as error:
        raise FieldError(f"{where}: {error}") from None


def _triple(value: Any, name: str) -> tuple[float, float, float] | None:
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 3 or not all(_is_number(part) for part in value):
        raise FieldError(f"{name} {json.dumps(value)[:60]} is no [x, y, z] of three numbers")
    return float(value[0]), float(value[1]), float(value[2])


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
