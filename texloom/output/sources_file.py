"""Sources kept in a file, to be applied again to another stack or to another output."""

import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from texloom.errors import FileError
from texloom.output.atomic import atomic
from texloom.sources import SourceMap

FORMAT = 1
_MARK = "texloom-sources"
_FIELDS = ("position", "weight", "turn", "scale")


@dataclass(frozen=True, eq=False)
class SavedSources:
    """What a file of sources holds: the sources, the arrays that describe their domain, and the settings of the run."""

    sources: SourceMap
    domain: Mapping[str, np.ndarray] = field(default_factory=dict)
    settings: Mapping[str, str] = field(default_factory=dict)


def save_sources(path: str | Path, saved: SavedSources) -> Path:
    """Write a compressed NumPy archive (``.npz``) that any NumPy can open."""
    path = Path(path)
    header = json.dumps({"kind": _MARK, "format": FORMAT, "settings": dict(saved.settings)})
    arrays = {f"domain.{name}": np.asarray(values) for name, values in saved.domain.items()}
    for name in _FIELDS:
        values = getattr(saved.sources, name)
        if values is not None:
            arrays[name] = values
    with atomic(path) as beside, beside.open("wb") as file:
        np.savez_compressed(file, header=np.array(header), **arrays)  # pyright: ignore[reportArgumentType]
    return path


def load_sources(path: str | Path) -> SavedSources:
    """Read a file of sources.

    Raises: FileError, if it is not one, is damaged, or was written in another format.
    """
    path = Path(path)
    if not path.exists():
        raise FileError(f"{path}: no such file")
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise FileError(f"{path.name} is not a file of sources, or is damaged: save the sources again") from error
    header = _header(path, arrays)
    sources = SourceMap(*(arrays.get(name) for name in _FIELDS))  # pyright: ignore[reportArgumentType]
    domain = {name.removeprefix("domain."): values for name, values in arrays.items() if name.startswith("domain.")}
    return SavedSources(sources, domain, header["settings"])


def _header(path: Path, arrays: Mapping[str, np.ndarray]) -> dict:
    """The header, checked."""
    header: dict = {}
    try:
        header = json.loads(str(arrays["header"]))
        kind, version = header["kind"], header["format"]
    except (KeyError, TypeError, ValueError):
        kind, version = None, None
    if kind != _MARK:
        raise FileError(f"{path.name} is not a file of sources: give one written by texloom")
    if version != FORMAT:
        raise FileError(
            f"{path.name} holds sources of format {version}, this texloom reads format {FORMAT}: "
            "run the synthesis again, or use the texloom that wrote it"
        )
    if "position" not in arrays or "weight" not in arrays:
        raise FileError(f"{path.name} lacks its positions or weights: save the sources again")
    return header
