"""The refined mesh with a value of every map at every site: PLY, or GLB for viewers that show vertex colours."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float32

from texloom.errors import FileError
from texloom.exemplar.colour import encode
from texloom.exemplar.exemplar import Exemplar
from texloom.output.atomic import atomic
from texloom.output.draft import Draft, version
from texloom.output.gather import gather_sites
from texloom.output.material import base_colour
from texloom.output.sites import SurfaceSites
from texloom.sources import SourceMap


def write_vertex_colours(
    path: str | Path,
    surface: SurfaceSites,
    sources: SourceMap,
    exemplar: Exemplar,
    *,
    settings: Mapping[str, str] | None = None,
    tangents: bool = True,
) -> Path:
    """Gather every map at the sites and write ``.ply`` or ``.glb``."""
    path = Path(path)
    values = {name: gather_sites(sources, map) for name, map in exemplar.maps.items()}
    base = base_colour(exemplar.maps) or next(iter(exemplar.maps))
    colours = linear_rgba(values[base], values.get("alpha"))
    if path.suffix.lower() == ".ply":
        content = ply_bytes(surface, colours, settings=settings)
    elif path.suffix.lower() == ".glb":
        content = _glb(surface, exemplar, values, base, colours, settings or {}, tangents)
    else:
        raise FileError(f"{path.name}: vertex colours are written as .glb or .ply")
    with atomic(path) as beside:
        beside.write_bytes(content)
    return path


def linear_rgba(
    values: Float32[np.ndarray, "site channel"], alpha: Float32[np.ndarray, "site 1"] | None = None
) -> Float32[np.ndarray, "site 4"]:
    """Colours (one channel becomes grey) with opacity."""
    colours = np.ones((len(values), 4), np.float32)
    colours[:, :3] = values[:, :3] if values.shape[1] >= 3 else values[:, :1]
    if alpha is not None:
        colours[:, 3] = alpha[:, 0]
    return colours


def ply_bytes(
    surface: SurfaceSites, colours: Float32[np.ndarray, "site 4"], *, settings: Mapping[str, str] | None = None
) -> bytes:
    """Binary PLY: positions, normals and 8-bit sRGB colours."""
    properties = [(axis, "<f4") for axis in ("x", "y", "z", "nx", "ny", "nz")]
    properties += [(colour, "u1") for colour in ("red", "green", "blue", "alpha")]
    vertices = np.empty(len(surface.vertices), properties)
    for axis in range(3):
        vertices["xyz"[axis]] = surface.vertices[:, axis]
        vertices["n" + "xyz"[axis]] = surface.shown_normal[:, axis]
    stored = np.concatenate([encode(colours[:, :3]), np.clip(colours[:, 3:], 0, 1)], axis=1)
    for channel, name in enumerate(("red", "green", "blue", "alpha")):
        vertices[name] = np.rint(stored[:, channel] * 255)
    faces = np.empty(len(surface.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, surface.faces
    kinds = {"<f4": "float", "u1": "uchar"}
    notes = [f"comment {key}: {' '.join(str(value).split())}" for key, value in (settings or {}).items()]
    header = ["ply", "format binary_little_endian 1.0", f"comment texloom {version()}", *notes]
    header += [f"element vertex {len(vertices)}", *(f"property {kinds[kind]} {name}" for name, kind in properties)]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    return ("\n".join(header) + "\n").encode() + vertices.tobytes() + faces.tobytes()


def _glb(
    surface: SurfaceSites,
    exemplar: Exemplar,
    values: Mapping[str, Float32[np.ndarray, "site channel"]],
    base: str,
    colours: Float32[np.ndarray, "site 4"],
    settings: Mapping[str, str],
    tangents: bool,
) -> bytes:
    """COLOR_0 in linear light (16 bits, as glTF asks); other maps as attributes of their own name (``_ROUGHNESS``).

    TANGENT is the direction field, ``_SCALE`` the scale field; the texel's length is in the mesh's extras.
    """
    draft = Draft()
    colour = np.rint(np.clip(colours, 0, 1) * 65535).astype("<u2")
    attributes = {
        "POSITION": draft.attribute(np.asarray(surface.vertices, "<f4")),
        "NORMAL": draft.attribute(np.asarray(surface.shown_normal, "<f4")),
        "COLOR_0": draft.attribute(colour, normalized=True),
    }
    if tangents:
        handed = np.ones((len(surface.vertices), 1), np.float32)
        attributes["TANGENT"] = draft.attribute(np.concatenate([surface.direction, handed], axis=1).astype("<f4"))
    if surface.scale is not None:
        attributes["_SCALE"] = draft.attribute(np.asarray(surface.scale, "<f4").reshape(-1, 1))
    for name in exemplar.maps:
        if name not in (base, "alpha"):
            attributes["_" + name.upper()] = draft.attribute(np.asarray(values[name], "<f4"))
    material: dict = {"name": "texloom", "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.9}}
    if "alpha" in values:
        material["alphaMode"] = "BLEND"
    primitive = {"attributes": attributes, "indices": draft.indices(surface.faces)}
    primitive["material"] = draft.add("materials", material)
    draft.add("meshes", {"primitives": [primitive], "extras": {"texel": float(surface.texel)}})
    draft.add("nodes", {"mesh": 0})
    draft.add("scenes", {"nodes": [0]})
    draft.json["scene"] = 0
    return draft.packed(settings)
