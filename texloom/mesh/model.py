"""A mesh as the user gave it: what was read, what was mended, and what must come back untouched."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float32, Int32

from texloom.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Model:
    """A mended mesh with its way back to the file.

    For glTF the mesh is in world space (node transforms applied), only the triangles to texture are in it, and
    ``document`` holds the whole file so that nodes, skins, animations and other materials can be written back.
    """

    path: Path
    mesh: Mesh
    uv: Float32[np.ndarray, "face 3 2"] | None  # per corner, v up; None where the file has none
    corner_origin: Int32[np.ndarray, "face 3"]  # vertex of the file (all parts counted through) at each corner
    face_origin: Int32[np.ndarray, "face"]  # triangle of the file (polygons fanned, all parts counted through)
    mends: tuple[str, ...]  # one line for each kind of mend, with its count
    document: bytes | None = None  # glTF only: the file as read, self-contained (GLB)
    primitive: Int32[np.ndarray, "face 2"] | None = None  # glTF only: (node, primitive) each face came from
