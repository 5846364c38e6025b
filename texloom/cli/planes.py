"""Planar domains from the options of ``texloom image``."""

from pathlib import Path

import numpy as np

from texloom.domain.grid import Grid
from texloom.errors import FileError, ParameterError
from texloom.field.planar import NAMED, PlanarField, from_image, from_vectors, uniform

_AROUND_A_CENTRE = ("radial", "ring")


def plane(rows: int, columns: int, *, field: str | None, tileable: bool) -> Grid:
    """A plane or torus of sites, along the planar field that ``--field`` asks for."""
    if field is None:
        return Grid(rows, columns, wrap=tileable)
    if tileable and field in _AROUND_A_CENTRE:
        raise ParameterError(f"--tileable and --field {field} exclude each other: its opposite borders differ")
    planar = planar_field(field, rows, columns)
    return Grid(rows, columns, wrap=tileable, field=planar.direction, magnitude=planar.scale)


def planar_field(wish: str, rows: int, columns: int) -> PlanarField:
    """A field by its name, ``uniform:DEGREES``, or from a file of vectors or a painted image."""
    if wish in NAMED:
        return NAMED[wish](rows, columns)
    if wish.startswith("uniform:"):
        return uniform(rows, columns, np.deg2rad(_degrees(wish)))
    path = Path(wish)
    if not path.exists():
        raise ParameterError(f"--field {wish}: choose {', '.join(NAMED)}, uniform:DEGREES, or a file (there is none)")
    if path.suffix.lower() == ".npy":
        return from_vectors(_load(path), rows, columns)
    from texloom.io.image import read_image

    return from_image(read_image(path, kind="data").image, rows, columns)


def _degrees(wish: str) -> float:
    try:
        degrees = float(wish.removeprefix("uniform:"))
    except ValueError:
        degrees = np.nan
    if not np.isfinite(degrees):
        raise ParameterError(f"--field {wish}: give degrees, as in uniform:30")
    return degrees


def _load(path: Path) -> np.ndarray:
    try:
        return np.asarray(np.load(path, allow_pickle=False), np.float64)
    except (OSError, ValueError, TypeError, EOFError):
        raise FileError(f"{path.name} is not an array of numbers: save it with numpy.save") from None
