"""What every mesh reader returns, and the cutting of polygons into triangles."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Float64, Int, Int32


@dataclass(frozen=True, eq=False)
class Triangles:
    """The triangles of a file, before anything is mended."""

    vertices: Float64[np.ndarray, "vertex 3"]
    faces: Int[np.ndarray, "face 3"]  # as wide as the file has them: not checked yet
    uv: Float32[np.ndarray, "face 3 2"] | None = None  # v up
    material: Int32[np.ndarray, "face"] | None = None  # row of ``materials``, -1 for none
    materials: tuple[str, ...] = ()
    primitive: Int32[np.ndarray, "face 2"] | None = None  # glTF only: (node, primitive)
    document: bytes | None = None  # glTF only: the whole file, self-contained


def fan(counts: Int[np.ndarray, "polygon"]) -> tuple[Int[np.ndarray, "triangle 3"], Int[np.ndarray, "triangle"]]:
    """Corners of each triangle, as positions in the polygons' corners strung together, and the polygon of each.

    A polygon ``a b c d`` becomes ``a b c``, ``a c d``.
    """
    if (counts == 3).all():
        return np.arange(3 * len(counts)).reshape(-1, 3), np.arange(len(counts))
    polygon = np.repeat(np.arange(len(counts)), counts - 2)
    starts = np.cumsum(counts) - counts
    within = np.arange(len(polygon)) - np.repeat(np.cumsum(counts - 2) - (counts - 2), counts - 2)
    first = starts[polygon]
    return np.stack([first, first + within + 1, first + within + 2], axis=1), polygon
