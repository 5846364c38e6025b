"""A fresh atlas: UVs for a mesh that has none, or whose own cannot take a texture."""

import numpy as np
from jaxtyping import Float32, Int

from texloom.mesh.mesh import Mesh
from texloom.output.charts import FaceGraph, flattened, grow_charts, halve
from texloom.output.pack import pack_charts
from texloom.output.uv import covers_of

_XATLAS_FACES = 8_000  # above, xatlas takes longer than the synthesis: 8 s at 18 000 faces against our 2 s
_CHECKED = 1024  # texels a side of the map that overlaps are looked for on
_ROUNDS = 8


def unwrap(mesh: Mesh, *, size: int = 2048, gutter: int = 8) -> Float32[np.ndarray, "face 3 2"]:
    """UVs (v up) at the corners of every face, in charts at least ``gutter`` texels apart on an atlas of ``size``.

    xatlas for small meshes; projected charts (``charts.py``) for large ones.
    """
    if len(mesh.faces) <= _XATLAS_FACES:
        return _with_xatlas(mesh, size, gutter)
    return unwrap_large(mesh, size=size, gutter=gutter)


def unwrap_large(mesh: Mesh, *, size: int = 2048, gutter: int = 8) -> Float32[np.ndarray, "face 3 2"]:
    """UVs from projected charts; a chart that comes to lie over itself is halved until none does."""
    faces = FaceGraph(mesh)
    chart = grow_charts(faces)
    uv = pack_charts(flattened(mesh, chart), chart, size=size, gutter=gutter)
    for _ in range(_ROUNDS):
        folded = _folded(uv, chart)
        if not len(folded):
            break
        chart = halve(faces, chart, folded)
        uv = pack_charts(flattened(mesh, chart), chart, size=size, gutter=gutter)
    return uv.astype(np.float32)


def _folded(uv: Float32[np.ndarray, "face 3 2"], chart: Int[np.ndarray, "face"]) -> Int[np.ndarray, "folded"]:
    """Charts with texels that two of their faces cover."""
    covers, last = covers_of(uv, _CHECKED)
    return np.unique(chart[last[covers > 1]])


def _with_xatlas(mesh: Mesh, size: int, gutter: int) -> Float32[np.ndarray, "face 3 2"]:
    import xatlas

    atlas = xatlas.Atlas()
    atlas.add_mesh(mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32))
    packing = xatlas.PackOptions()
    packing.padding, packing.resolution, packing.bilinear = gutter, size, True
    atlas.generate(xatlas.ChartOptions(), packing)
    _, corners, uv = atlas[0]
    sides = np.array([atlas.width, atlas.height], np.float32)
    return np.ascontiguousarray((uv * (sides / sides.max()))[corners], np.float32)
