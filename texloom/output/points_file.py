"""Points on a mesh as a file: PLY for viewers and modellers, NPZ with their places in the mesh's faces."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float64, Int32

from texloom.errors import FileError
from texloom.output.atomic import atomic
from texloom.output.draft import version
from texloom.points import Hierarchy

SUFFIXES = (".ply", ".npz")


def write_points(path: str | Path, points: Hierarchy, *, settings: Mapping[str, str] | None = None) -> Path:
    """The finest level's points with the level each first belongs to, and its triangulation; whole or not at all.

    ``.ply``: x y z, nx ny nz, scale, level; faces. ``.npz``: position, normal, scale, level, and of the mesh given the
    face and barycentric coordinates; ``faces`` of each level (``faces.0`` the coarsest).

    Raises: FileError, for another suffix.
    """
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise FileError(f"{path.name}: points are written as .ply or .npz")
    with atomic(path) as beside:
        if path.suffix.lower() == ".ply":
            beside.write_bytes(_ply(points, settings or {}))
        else:
            np.savez_compressed(beside, allow_pickle=False, **_arrays(points))
    return path


def level_of(points: Hierarchy) -> Int32[np.ndarray, "point"]:
    """The coarsest level that each point of the finest belongs to."""
    counts = [level.count for level in points.levels]
    return np.repeat(np.arange(len(counts), dtype=np.int32), np.diff(counts, prepend=0))


def _ply(points: Hierarchy, settings: Mapping[str, str]) -> bytes:
    finest = points.levels[-1]
    names = ("x", "y", "z", "nx", "ny", "nz", "scale")
    record = np.empty(finest.count, [(name, "<f4") for name in names] + [("level", "u1")])
    columns = np.column_stack([finest.position, finest.normal, finest.scale])
    for name, column in zip(names, columns.T, strict=True):
        record[name] = column
    record["level"] = level_of(points)
    faces = np.empty(len(finest.mesh.faces), [("count", "u1"), ("corners", "<i4", (3,))])
    faces["count"], faces["corners"] = 3, finest.mesh.faces
    notes = [f"comment {name} {' '.join(value.split())}" for name, value in settings.items()]
    header = ["ply", "format binary_little_endian 1.0", f"comment texloom {version()}", *notes]
    header += [f"element vertex {finest.count}", *(f"property float {name}" for name in names), "property uchar level"]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    return ("\n".join(header) + "\n").encode() + record.tobytes() + faces.tobytes()


def _arrays(points: Hierarchy) -> dict[str, Int32[np.ndarray, "..."] | Float64[np.ndarray, "..."]]:
    finest = points.levels[-1]
    faces = {f"faces.{number}": level.mesh.faces for number, level in enumerate(points.levels)}
    return {
        "position": finest.position,
        "normal": finest.normal,
        "scale": finest.scale,
        "level": level_of(points),
        "face": finest.face,
        "barycentric": finest.barycentric,
        **faces,
    }
