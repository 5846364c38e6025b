"""Direction and scale files brought from the vertices of the mesh's file onto those of the mended mesh."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float64, Int64, Shaped

from texloom.errors import FieldError
from texloom.field.arrows import Arrow, Placed, place
from texloom.io.arrows import read_arrows, read_rows
from texloom.mesh.model import Model


def holds_arrows(path: Path) -> bool:
    """Whether a file is one of arrows rather than of rows."""
    return path.suffix.lower() == ".json"


def placed_arrows(path: Path, model: Model) -> Placed:
    """The arrows of a JSON file on the mended mesh; ``vertex`` counts as in the mesh's file.

    Raises: FileError, if it cannot be read; FieldError, naming the arrow that is wrong.
    """
    origin, vertex = origins(model)
    vertex_of = dict(zip(origin.tolist(), vertex.tolist(), strict=True))

    def brought(number: int, arrow: Arrow) -> Arrow:
        if arrow.vertex is None:
            return arrow
        if arrow.vertex not in vertex_of:
            last = int(origin.max())
            raise FieldError(f"arrow {number} stands at vertex {arrow.vertex}, but no face has it; the last is {last}")
        return replace(arrow, vertex=vertex_of[arrow.vertex])

    arrows = read_arrows(path)
    try:
        return place(model.mesh, [brought(number, arrow) for number, arrow in enumerate(arrows)])
    except FieldError as error:
        raise FieldError(f"{path.name}: {error}") from None


def vertex_rows(path: Path, model: Model, *, columns: int) -> Float64[np.ndarray, "vertex columns"]:
    """Numbers for every vertex of the mended mesh, from a file with one row for each vertex of the mesh's file.

    Raises: FileError, if it cannot be read; FieldError, if it does not fit the mesh.
    """
    rows = read_rows(path)
    origin, _ = origins(model)
    if rows.shape[1] != columns:
        raise FieldError(f"{path.name} has {rows.shape[1]} numbers a row: give {columns} for each vertex")
    if len(rows) <= origin.max():
        raise FieldError(
            f"{path.name} has {len(rows)} rows, but faces use vertices up to {origin.max()} (counted from 0): "
            "give one row for each vertex"
        )
    return on_mesh(rows, model)


def on_mesh(rows: Shaped[np.ndarray, "origin *width"], model: Model) -> Shaped[np.ndarray, "vertex *width"]:
    """Values at the vertices of the mesh's file, at the vertices of the mended mesh."""
    origin, vertex = origins(model)
    values = np.empty((len(model.mesh.vertices), *rows.shape[1:]), rows.dtype)
    values[vertex] = rows[origin]
    return values


def origins(model: Model) -> tuple[Int64[np.ndarray, "pair"], Int64[np.ndarray, "pair"]]:
    """Vertices of the file and the vertices of the mended mesh they became, each pair once."""
    pairs = np.stack([model.corner_origin.ravel(), model.mesh.faces.ravel()], axis=1).astype(np.int64)
    origin, vertex = np.unique(pairs, axis=0).T
    return origin, vertex
