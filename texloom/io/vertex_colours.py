"""The colours that a mesh file holds at its vertices: PLY, OBJ with six numbers a vertex, GLB and glTF."""

import numpy as np
from jaxtyping import Float64

from texloom.errors import FileError
from texloom.exemplar.colour import encode
from texloom.io.ply import read_tables
from texloom.mesh.gltf import accessor, primitives, unpack
from texloom.mesh.model import Model


def read_vertex_colours(model: Model) -> Float64[np.ndarray, "origin 3"]:
    """Colours as seen (encoded), in [0, 1], one row for each vertex of the model's file, as it counts them.

    Raises: FileError, if the file holds none.
    """
    readers = {".ply": _of_ply, ".obj": _of_obj, ".glb": _of_gltf, ".gltf": _of_gltf}
    reader = readers.get(model.path.suffix.lower())
    colours = None if reader is None else reader(model)
    if colours is None:
        raise FileError(f"{model.path.name} has no colours at its vertices: save it with vertex colours, as PLY or GLB")
    return np.clip(colours.astype(np.float64), 0.0, 1.0)


def _of_ply(model: Model) -> np.ndarray | None:
    """Properties red, green and blue; whole numbers are shares of the largest."""
    vertex = read_tables(model.path.read_bytes()).get("vertex", {})
    for names in (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue")):
        if all(name in vertex for name in names):
            colours = np.stack([vertex[name] for name in names], 1)
            if colours.dtype.kind == "u":
                return colours / np.iinfo(colours.dtype).max
            return colours / 255 if colours.max(initial=0) > 1 else colours  # text does not say which it holds
    return None


def _of_obj(model: Model) -> np.ndarray | None:
    """The three numbers after each position."""
    lines = model.path.read_bytes().splitlines()
    rows = [words[4:7] for words in (line.split() for line in lines) if words[:1] == [b"v"]]
    try:
        colours = np.array([[float(word) for word in row] for row in rows])
    except ValueError:  # not three numbers everywhere
        return None
    return colours if colours.ndim == 2 and colours.shape[1] == 3 else None


def _of_gltf(model: Model) -> np.ndarray | None:
    """COLOR_0 of every primitive, which is linear."""
    assert model.document is not None
    document = unpack(model.document)
    found = primitives(document)
    if not found or any("COLOR_0" not in part.attributes for part in found):
        return None
    colours = np.concatenate([accessor(document, part.attributes["COLOR_0"])[:, :3] for part in found])
    return encode(np.clip(colours, 0, 1).astype(np.float32))
