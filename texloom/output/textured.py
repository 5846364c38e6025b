"""A mesh with baked maps, as one GLB or as OBJ + MTL + PNGs."""

from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int, Shaped

from texloom.errors import FileError
from texloom.exemplar.exemplar import Map
from texloom.output.atomic import atomic
from texloom.output.corners import shared_corners, unshared_corners
from texloom.output.draft import Draft, version
from texloom.output.image import stored
from texloom.output.material import add_material, base_colour
from texloom.output.png import png_bytes

# Statements of an MTL file; the last three are the common extension for physically based materials.
_MTL = {"alpha": "map_d", "height": "disp", "roughness": "map_Pr", "metallic": "map_Pm", "emissive": "map_Ke"}


@dataclass(frozen=True, eq=False, kw_only=True)
class TexturedMesh:
    """A mesh on a texture: UVs (v up) and, for normal maps, the glTF tangents they are meant in, both at corners.

    ``further`` are attributes of a GLB by their name there (``_NAME``), at corners too; unsigned bytes stand for
    [0, 1]. ``clamp``: the texture ends in its outermost texels, instead of repeating.
    """

    vertices: Float[np.ndarray, "vertex 3"]
    faces: Int[np.ndarray, "face 3"]
    normals: Float[np.ndarray, "vertex 3"]
    uv: Float[np.ndarray, "face 3 2"]
    tangents: Float[np.ndarray, "face 3 4"] | None = None
    further: Mapping[str, Shaped[np.ndarray, "face 3 n"]] = field(default_factory=dict)
    clamp: bool = False


def write_textured(
    path: str | Path, mesh: TexturedMesh, maps: Mapping[str, Map], *, settings: Mapping[str, str] | None = None
) -> list[Path]:
    """Write the mesh with its maps; ``.glb`` is one file, ``.obj`` comes with an MTL and a PNG a map beside it."""
    path = Path(path)
    if path.suffix.lower() == ".glb":
        with atomic(path) as beside:
            beside.write_bytes(textured_glb(mesh, maps, settings=settings))
        return [path]
    if path.suffix.lower() == ".obj":
        return _write_obj(path, mesh, maps, dict(settings or {}))
    raise FileError(f"{path.name}: a textured mesh is written as .glb or .obj")


def textured_glb(mesh: TexturedMesh, maps: Mapping[str, Map], *, settings: Mapping[str, str] | None = None) -> bytes:
    """The mesh and its maps as one GLB. Vertices are split where a corner's UV or tangent differs.

    With ``further`` attributes every corner is a vertex of its own.
    """
    draft = Draft(clamp=mesh.clamp)
    flat = mesh.faces.reshape(-1)
    keys = [flat, mesh.uv.reshape(-1, 2)]
    if mesh.tangents is not None:
        keys.append(mesh.tangents.reshape(-1, 4))
    first, vertex = unshared_corners(len(flat)) if mesh.further else shared_corners(*keys)
    attributes = {
        "POSITION": draft.attribute(mesh.vertices.astype("<f4").take(flat[first], axis=0)),
        "NORMAL": draft.attribute(mesh.normals.astype("<f4").take(flat[first], axis=0)),
        "TEXCOORD_0": draft.attribute(flipped(mesh.uv.reshape(-1, 2).take(first, axis=0))),
    }
    if mesh.tangents is not None:
        attributes["TANGENT"] = draft.attribute(mesh.tangents.reshape(-1, 4).take(first, axis=0).astype("<f4"))
    attributes |= add_further(draft, mesh.further)
    primitive = {"attributes": attributes, "indices": draft.indices(vertex.reshape(-1, 3))}
    primitive["material"] = add_material(draft, maps)
    draft.add("meshes", {"primitives": [primitive]})
    draft.add("nodes", {"mesh": 0})
    draft.add("scenes", {"nodes": [0]})
    draft.json["scene"] = 0
    return draft.packed(settings or {})


def add_further(draft: Draft, further: Mapping[str, Shaped[np.ndarray, "face 3 n"]]) -> dict[str, int]:
    """Accessors of further attributes, a vertex a corner."""
    return {
        name: draft.attribute(values.reshape(-1, values.shape[-1]), normalized=values.dtype == np.uint8)
        for name, values in further.items()
    }


def flipped(uv: Float[np.ndarray, "vertex 2"]) -> Float[np.ndarray, "vertex 2"]:
    """UVs with v up as glTF stores them, with v down."""
    return np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1).astype("<f4")


def _write_obj(path: Path, mesh: TexturedMesh, maps: Mapping[str, Map], settings: dict[str, str]) -> list[Path]:
    """All files, or none. OBJ has no tangents: viewers rebuild them from the UVs as MikkTSpace does."""
    material = path.with_suffix(".mtl")
    pictures = {name: path.with_name(f"{path.stem}-{name}.png") for name in maps}
    with ExitStack() as files:
        for name, picture in pictures.items():
            image = stored(maps[name], 8 if maps[name].bits == 8 else 16)
            content = png_bytes(image, text=settings, srgb=maps[name].kind == "colour")
            files.enter_context(atomic(picture)).write_bytes(content)
        files.enter_context(atomic(material)).write_text(_mtl_text(maps, pictures, clamp=mesh.clamp), encoding="utf-8")
        with files.enter_context(atomic(path)).open("w", encoding="utf-8") as file:
            _write_obj_text(file, mesh, material.name)
    return [path, material, *pictures.values()]


def _mtl_text(maps: Mapping[str, Map], pictures: Mapping[str, Path], *, clamp: bool) -> str:
    base = base_colour(maps)
    options = "-clamp on " if clamp else ""
    lines = [f"# texloom {version()}", "newmtl texloom", "Kd 1 1 1", "Ks 0.04 0.04 0.04", "illum 2"]
    if base is not None:
        lines.append(f"map_Kd {options}{pictures[base].name}")
    for name, map in maps.items():
        if map.kind == "normal":
            lines.append(f"norm {options}{pictures[name].name}")
        elif name in _MTL:
            lines.append(f"{_MTL[name]} {options}{pictures[name].name}")
    return "\n".join(lines) + "\n"


def _write_obj_text(file, mesh: TexturedMesh, material: str) -> None:
    """Positions, UVs and normals as text, faces with all three indices."""
    first, uv_index = shared_corners(mesh.uv.reshape(-1, 2))
    file.write(f"# texloom {version()}\nmtllib {material}\nusemtl texloom\n")
    np.savetxt(file, mesh.vertices, fmt="v %.9g %.9g %.9g")
    np.savetxt(file, mesh.uv.reshape(-1, 2)[first], fmt="vt %.9g %.9g")
    np.savetxt(file, mesh.normals, fmt="vn %.6f %.6f %.6f")
    corner = np.stack([mesh.faces.reshape(-1), uv_index, mesh.faces.reshape(-1)], axis=1) + 1
    np.savetxt(file, corner.reshape(-1, 9), fmt="f %d/%d/%d %d/%d/%d %d/%d/%d")
