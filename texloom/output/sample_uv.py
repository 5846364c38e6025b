"""A mesh textured with the sample itself: every corner of a face is a place in it, and no texture is made."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float, Float32, Shaped

from texloom.exemplar.appearance import fill_masked
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.mesh.mesh import Mesh
from texloom.mesh.model import Model
from texloom.output.atomic import atomic
from texloom.output.blending import EdgeErrors, Neighbours
from texloom.output.material import MaterialMaps
from texloom.output.retexture import retextured_glb
from texloom.output.tangents import corner_tangents
from texloom.output.textured import TexturedMesh, write_textured

_ACROSS = ("_UV_A", "_UV_B", "_UV_C")  # opposite to corners 0, 1, 2


def sample_uv(positions: Float[np.ndarray, "*n 2"], shape: tuple[int, int]) -> Float32[np.ndarray, "*n 2"]:
    """UVs (v up) of [row, column] positions in a sample of ``shape`` (rows, columns)."""
    rows, columns = shape
    u, v = (positions[..., 1] + 0.5) / columns, 1.0 - (positions[..., 0] + 0.5) / rows
    return np.stack([u, v], axis=-1).astype(np.float32)


def usable_maps(exemplar: Exemplar) -> MaterialMaps:
    """The sample's maps without its masked texels, which are given what lies nearest.

    A neighbour's map goes on beyond its face and may read there. Meshes written with the same are spared all but the
    first encoding.
    """
    filled = {name: replace(map, image=fill_masked(map.image, exemplar.mask)) for name, map in exemplar.maps.items()}
    return MaterialMaps(filled)


def on_sample(
    mesh: Mesh,
    coordinates: Float[np.ndarray, "face 3 2"],
    shape: tuple[int, int],
    *,
    further: Mapping[str, Shaped[np.ndarray, "face 3 n"]] | None = None,
) -> TexturedMesh:
    """The mesh on a sample of ``shape`` texels, with the tangents its normal maps are meant in (along +column)."""
    uv = sample_uv(coordinates, shape)
    return TexturedMesh(
        vertices=mesh.vertices,
        faces=mesh.faces,
        normals=mesh.vertex_normals,
        uv=uv,
        tangents=corner_tangents(mesh.vertices, mesh.faces, uv, normals=mesh.vertex_normals.take(mesh.faces, axis=0)),
        further=further or {},
        clamp=True,
    )


def blending_attributes(
    beside: Neighbours, errors: EdgeErrors, shape: tuple[int, int]
) -> dict[str, Shaped[np.ndarray, "face 3 n"]]:
    """What a shader needs to blend at run time (``examples/10_texton/shader``), at the corners of every face.

    ``_UV_A``, ``_UV_B``, ``_UV_C``: the corner's UV (v down, as TEXCOORD_0) in the map of the neighbour opposite to
    corner 0, 1, 2 of the face. ``_BARY``: 1 at the corner's own place among the three, in normalized bytes. ``_BLEND``:
    E_t d of the edges opposite to corners 0, 1, 2 (differences of 255 times world units), alike at the three corners;
    0 where there is nothing to blend. Times λ / ‖v − m‖ it is Φ.
    """
    uv = sample_uv(beside.positions, shape)
    uv[..., 1] = 1 - uv[..., 1]
    gain = errors.at_faces(errors.mean * errors.length) * beside.there
    faces = len(gain)
    return {
        **{name: np.ascontiguousarray(uv[:, k]) for k, name in enumerate(_ACROSS)},
        "_BARY": np.broadcast_to(np.eye(3, dtype=np.uint8) * np.uint8(255), (faces, 3, 3)),
        "_BLEND": np.repeat(gain[:, None], 3, axis=1),
    }


def write_sample_uv(
    path: str | Path,
    model: Model | None,
    mesh: TexturedMesh,
    maps: Mapping[str, Map],
    *,
    settings: Mapping[str, str] | None = None,
) -> list[Path]:
    """Write the mesh with the sample's maps: a GLB that came in as ``model`` goes back whole, others are made anew."""
    path = Path(path)
    if model is None or model.document is None or path.suffix.lower() != ".glb":
        return write_textured(path, mesh, maps, settings=settings)
    shown = {"uv": mesh.uv, "tangents": mesh.tangents, "further": mesh.further, "clamp": mesh.clamp}
    with atomic(path) as beside:
        beside.write_bytes(retextured_glb(model, maps, **shown, settings=settings))
    return [path]
