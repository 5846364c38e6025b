"""Reading meshes: OBJ, PLY, OFF, STL, GLB and glTF, mended on the way in."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from texloom.errors import FileError, MeshError, ParameterError
from texloom.io.gltf import read_gltf
from texloom.io.obj import read_obj
from texloom.io.off import read_off
from texloom.io.ply import read_ply
from texloom.io.stl import read_stl
from texloom.io.triangles import Triangles
from texloom.mesh.mend import mend
from texloom.mesh.model import Model

_READERS: dict[str, Callable[[bytes], Triangles]] = {
    ".obj": read_obj,
    ".ply": read_ply,
    ".off": read_off,
    ".stl": read_stl,
}
_GLTF = (".glb", ".gltf")
SUFFIXES = (*_READERS, *_GLTF)


def read_mesh(path: str | Path, *, material: str | None = None) -> Model:
    """The mesh of a file, mended; only the faces under one material, where it is named.

    Raises: FileError, if the file cannot be read; MeshError, if it holds no surface; ParameterError, if no such
    material is in it. Each is one line that begins with the file's name.
    """
    path = Path(path)
    try:
        with np.errstate(invalid="ignore"):  # not-a-numbers are refused below, by name
            read = _read(path)
        chosen = _under_material(read, material)
        mended = mend(read.vertices, read.faces[chosen])
    except (FileError, MeshError) as error:
        raise type(error)(f"{path.name}: {error}") from None
    except ParameterError as error:
        raise ParameterError(f"{path.name}: {error}") from None
    face_origin = chosen[mended.face_origin]
    uv = None
    if read.uv is not None:
        uv = read.uv[chosen].reshape(-1, 2)[mended.corner_given]
        uv = uv if np.isfinite(uv).all() else None
    return Model(
        path=path,
        mesh=mended.mesh,
        uv=uv,
        corner_origin=mended.corner_origin,
        face_origin=face_origin,
        mends=mended.mends,
        document=read.document,
        primitive=None if read.primitive is None else read.primitive[face_origin],
    )


def _read(path: Path) -> Triangles:
    """The triangles of a file by its suffix."""
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise FileError(f"'{suffix or 'no suffix'}' is not a mesh format we read; these are: {' '.join(SUFFIXES)}")
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise FileError("no such file") from None
    except OSError as error:
        raise FileError(f"cannot be read: {error.strerror}") from None
    if suffix in _GLTF:
        return read_gltf(path, content)
    return _READERS[suffix](content)


def _under_material(read: Triangles, material: str | None) -> np.ndarray:
    """Faces to texture: all, or those under the named material."""
    if material is None:
        return np.arange(len(read.faces), dtype=np.int32)
    if material not in read.materials:
        known = ", ".join(f"'{name}'" for name in read.materials) or "none"
        raise ParameterError(f"there is no material '{material}'; the file has: {known}")
    assert read.material is not None
    return np.flatnonzero(read.material == read.materials.index(material)).astype(np.int32)
