"""A sample and its textons kept in one file (``.textons``): all that texturing any number of meshes needs."""

import json
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from texloom.errors import FileError, TexloomError
from texloom.exemplar.exemplar import Exemplar, Map, Part, to_map
from texloom.output.atomic import atomic
from texloom.output.image import stored
from texloom.search.analysis import fingerprint
from texloom.search.textons import Textons, TextonSettings

FORMAT = 1
_MARK = "texloom-textons"
_AGAIN = "learn the textons again with texloom textons"
_BROKEN = (
    *(OSError, EOFError, zipfile.BadZipFile, RuntimeError, MemoryError),  # of the archive, whatever bit is wrong
    *(ValueError, KeyError, TypeError, IndexError),  # of what is in it
)


@dataclass(frozen=True, eq=False, kw_only=True)
class TextonsEntry:
    """What a file of textons says of itself, without its arrays."""

    path: Path
    size: tuple[int, int]  # columns and rows of the sample
    maps: Mapping[str, int]  # bits, by name
    masked: float  # share of the texels that are not used
    textons: int
    settings: TextonSettings
    passes: int
    kept: float
    made: Mapping[str, str]  # how, as given to ``save_textons``
    bytes: int


def save_textons(path: str | Path, textons: Textons, *, made: Mapping[str, str] | None = None) -> Path:
    """Write the sample and its textons, whole or not at all; ``made`` tells how, in words.

    A NumPy archive, not compressed: it is read in milliseconds. Maps keep every bit: as the integers they were read
    from where those give the same values, else as floats.
    """
    path = Path(path)
    exemplar = textons.exemplar
    arrays: dict[str, np.ndarray] = {f"map.{name}": _as_stored(m) for name, m in exemplar.maps.items()}
    if exemplar.mask is not None:
        arrays["mask"] = exemplar.mask
    short = textons.count <= np.iinfo(np.int16).max
    arrays |= {
        "image": textons.image,
        "labels": textons.labels.astype(np.int16) if short else textons.labels,
        "distance": textons.distance,
    }
    rows, columns = exemplar.shape
    header = {
        "kind": _MARK,
        "format": FORMAT,
        "fingerprint": fingerprint(exemplar),
        "size": [columns, rows],
        "maps": {name: {"kind": m.kind, "bits": m.bits} for name, m in exemplar.maps.items()},
        "masked": 0.0 if exemplar.mask is None else 1.0 - float(exemplar.mask.mean()),
        "parts": [asdict(part) for part in exemplar.parts],
        "textons": textons.count,
        "settings": asdict(textons.settings),
        "passes": textons.passes,
        "kept": textons.kept,
        "made": dict(made or {}),
    }
    with atomic(path) as beside, beside.open("wb") as file:
        np.savez(file, header=np.array(json.dumps(header)), **arrays)  # pyright: ignore[reportArgumentType]
    return path


def load_textons(path: str | Path) -> Textons:
    """Read a file of textons.

    Raises: FileError, if it is not one, is damaged, or was written in another format.
    """
    path = Path(path)
    header, arrays = _read(path, whole=True)
    try:
        maps = {name: _as_map(arrays[f"map.{name}"], told) for name, told in header["maps"].items()}
        exemplar = Exemplar(maps, arrays.get("mask"), tuple(Part(**part) for part in header["parts"]))
        textons = Textons(
            exemplar,
            arrays["image"],
            arrays["labels"].astype(np.int32),
            arrays["distance"],
            TextonSettings(**header["settings"]),
            header["passes"],
            header["kept"],
        )
        sound = fingerprint(exemplar) == header["fingerprint"] and _fits(textons)
    except (*_BROKEN, TexloomError):
        sound, textons = False, None
    if not sound or textons is None:
        raise FileError(f"{path.name} is damaged: {_AGAIN}")
    return textons


def read_entry(path: str | Path) -> TextonsEntry:
    """What a file of textons says of itself. Raises FileError, as ``load_textons`` does."""
    path = Path(path)
    header, _ = _read(path, whole=False)
    try:
        return TextonsEntry(
            path=path,
            size=(header["size"][0], header["size"][1]),
            maps={name: told["bits"] for name, told in header["maps"].items()},
            masked=header["masked"],
            textons=header["textons"],
            settings=TextonSettings(**header["settings"]),
            passes=header["passes"],
            kept=header["kept"],
            made=header["made"],
            bytes=path.stat().st_size,
        )
    except (*_BROKEN, TexloomError):
        raise FileError(f"{path.name} is damaged: {_AGAIN}") from None


def _read(path: Path, *, whole: bool) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """The header, checked, and the arrays, if the ``whole`` is wanted."""
    if not path.is_file():
        raise FileError(f"{path}: no such file")
    header: dict[str, Any] = {}
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            header = json.loads(str(archive["header"]))
            kind, version = header["kind"], header["format"]
            current = whole and kind == _MARK and version == FORMAT
            arrays = {name: archive[name] for name in archive.files if name != "header"} if current else {}
    except _BROKEN:
        told = "is damaged" if header.get("kind") == _MARK else "is not a file of textons, or is damaged"
        raise FileError(f"{path.name} {told}: {_AGAIN}") from None
    if kind != _MARK:
        raise FileError(f"{path.name} is not a file of textons: give one written by texloom textons")
    if version != FORMAT:
        raise FileError(
            f"{path.name} holds textons of format {version}, this texloom reads format {FORMAT}: "
            f"{_AGAIN}, or use the texloom that wrote it"
        )
    return header, arrays


def _as_stored(m: Map) -> np.ndarray:
    """The integers a map was read from, where they give its very values; else its floats."""
    if m.bits != 32:
        integers = stored(m, m.bits)
        if np.array_equal(to_map(integers, m.kind).image, m.image):
            return integers
    return m.image


def _as_map(values: np.ndarray, told: Mapping[str, Any]) -> Map:
    image = to_map(values, told["kind"]).image
    return Map(image, told["kind"], told["bits"])


def _fits(textons: Textons) -> bool:
    """Whether what kernels will index fits together."""
    shape, labels = textons.exemplar.shape, textons.labels
    inside = labels[:, textons.exemplar.usable]
    return bool(
        labels.shape == (textons.settings.orientations, *shape)
        and textons.image.shape[:2] == shape
        and textons.image.dtype == np.float32
        and textons.distance.dtype == np.float32
        and textons.distance.shape == (textons.count, textons.count)
        and (labels >= -1).all()
        and ((inside >= 0) & (inside < textons.count)).all()
        and np.count_nonzero(labels >= 0) == inside.size
    )
