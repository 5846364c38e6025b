"""Triangles sorted into the rows of a picture, ready for the row kernels of ``kernels/raster.py``."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float64, Int32

_STEPS = 256.0  # positions within a pixel; edge functions of snapped corners are exact in doubles


@dataclass(frozen=True, eq=False)
class FaceRows:
    """Corners (column, row) in pixels, snapped, and the faces that may touch each row in increasing order."""

    corners: Float64[np.ndarray, "face 3 2"]
    start: Int32[np.ndarray, "rows_plus_one"]
    faces: Int32[np.ndarray, "entry"]

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The arrays as the kernels take them."""
        return self.start, self.faces, self.corners


def face_rows(corners: Float[np.ndarray, "face 3 2"], rows: int, *, reach: float = 0.0) -> FaceRows:
    """Snap the corners and list, for each of ``rows`` rows, the faces within ``reach`` pixels of it.

    A face that touches no row's centre line is listed nowhere, which is most of a finely tessellated picture.
    """
    snapped = np.rint(np.asarray(corners, np.float64) * _STEPS) / _STEPS
    heights = snapped[:, :, 1]
    first = np.ceil(np.minimum(np.minimum(heights[:, 0], heights[:, 1]), heights[:, 2]) - reach)
    last = np.floor(np.maximum(np.maximum(heights[:, 0], heights[:, 1]), heights[:, 2]) + reach)
    first = np.clip(first, 0, rows).astype(np.int32)
    counts = np.maximum(np.clip(last, -1, rows - 1).astype(np.int32) - first + 1, 0)
    faces = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
    within = np.arange(len(faces), dtype=np.int32) - np.repeat(np.cumsum(counts, dtype=np.int32) - counts, counts)
    row = (np.repeat(first, counts) + within).astype(np.uint16)
    order = np.argsort(row, kind="stable")
    start = np.zeros(rows + 1, np.int32)
    np.cumsum(np.bincount(row, minlength=rows), out=start[1:])
    return FaceRows(snapped, start, faces[order])


def texel_corners(uv: Float[np.ndarray, "face 3 2"], rows: int, columns: int) -> Float64[np.ndarray, "face 3 2"]:
    """Corners (column, row) in texels, with texel centres at integers, of ``uv`` with v up."""
    return np.stack([uv[..., 0] * columns - 0.5, (1.0 - uv[..., 1].astype(np.float64)) * rows - 0.5], axis=-1)
