"""Whether a mesh's own UVs can take a texture of their own: every texel must belong to one place on the surface."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float64, Int32

from texloom.kernels import raster as kernels
from texloom.kernels.launch import launch
from texloom.output.rows import face_rows, texel_corners

_SIZE = 1024  # texels a side of the map that overlaps are counted on
_TOLERATED = 0.002  # share of covered texels; snapped corners of tiny faces overlap a little


@dataclass(frozen=True, kw_only=True)
class UvDiagnosis:
    """What was found; counts are faces, ``overlap`` is the share of covered texels that two or more faces claim."""

    faces: int
    overlap: float
    mirrored: int
    outside: int
    spanning: int
    degenerate: int
    missing: int

    @property
    def usable(self) -> bool:
        """Whether an atlas can be baked on these UVs."""
        return self.overlap <= _TOLERATED and self.spanning + self.missing == 0 and self.degenerate < self.faces

    @property
    def problems(self) -> tuple[str, ...]:
        """One line for each finding, with numbers."""
        found = []
        if self.overlap > _TOLERATED:
            found.append(f"UVs overlap on {100 * self.overlap:.1f} % of the texels they cover")
        if self.mirrored:
            found.append(f"{self.mirrored} of {self.faces} faces have mirrored UVs")
        if self.outside:
            found.append(f"{self.outside} of {self.faces} faces have UVs that wrap")
        if self.spanning:
            found.append(f"{self.spanning} of {self.faces} faces span a whole texture or more")
        if self.missing:
            found.append(f"{self.missing} of {self.faces} faces have no UVs")
        if self.degenerate:
            found.append(f"{self.degenerate} of {self.faces} faces have UVs without area")
        return tuple(found)

    def __str__(self) -> str:
        """One line that also says the way out."""
        if not self.problems:
            return "UVs are usable"
        text = "; ".join(self.problems)
        return text if self.usable else text + ": bake on a fresh atlas"


def diagnose_uv(uv: Float[np.ndarray, "face 3 2"]) -> UvDiagnosis:
    """Look for overlapping, mirrored, wrapping, spanning, degenerate and missing UVs.

    UVs outside the unit square are wrapped into it, as a repeating texture is read, before overlaps are counted.
    Mirrored alone is no obstacle (the tangent frame is mirrored too); with overlap it is the usual way of modelling
    one half and texturing it twice, which a texture without repetition cannot serve.
    """
    faces = len(uv)
    uv = np.asarray(uv, np.float64)
    uv = uv[np.isfinite(uv).all(axis=(1, 2))]
    first, second = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    negative, positive = int((area < 0).sum()), int((area > 0).sum())
    return UvDiagnosis(
        faces=faces,
        overlap=_overlap(uv),
        mirrored=0 if positive == 0 else negative,
        outside=int(((uv < 0) | (uv > 1)).any(axis=(1, 2)).sum()),
        spanning=int((np.ptp(uv, axis=1) >= 1).any(axis=1).sum()) if len(uv) else 0,
        degenerate=int((area == 0).sum()),
        missing=faces - len(uv),
    )


def _overlap(uv: Float[np.ndarray, "face 3 2"]) -> float:
    """Share of covered texels whose centre lies strictly inside two or more faces."""
    covers, _ = covers_of(wrapped(uv)[0], _SIZE)
    return float((covers > 1).sum() / max((covers > 0).sum(), 1))


def wrapped(uv: Float[np.ndarray, "face 3 2"]) -> tuple[Float64[np.ndarray, "copy 3 2"], Int32[np.ndarray, "copy"]]:
    """Faces moved by whole units into the unit square, those across its border twice or more; and whose copy each is.

    The first copies are the faces themselves, in order. A face that spans more than a unit is not covered whole.
    """
    uv = np.asarray(uv, np.float64)
    base = uv - np.floor(uv.min(axis=1, keepdims=True))
    over = base.max(axis=1) > 1.0
    copies, faces = [base], [np.arange(len(uv), dtype=np.int32)]
    for across in (np.array([True, False]), np.array([False, True]), np.array([True, True])):
        chosen = np.flatnonzero((over | ~across).all(axis=1)).astype(np.int32)
        copies.append(base[chosen] - across)
        faces.append(chosen)
    return np.concatenate(copies), np.concatenate(faces)


def covers_of(uv: Float[np.ndarray, "face 3 2"], size: int) -> tuple[np.ndarray, np.ndarray]:
    """For each texel of a square map, how many faces hold its centre, and the highest of them (-1 if none)."""
    rows = face_rows(texel_corners(uv, size, size), size)
    covers, last = np.empty((size, size), np.int32), np.empty((size, size), np.int32)
    launch(kernels.count_covers, size, inputs=rows.arrays, outputs=[covers, last])
    return covers, last
