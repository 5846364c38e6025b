"""The bunny of the published tables: with as many faces as there, cut finer, and bent into many."""

from functools import cache
from pathlib import Path

import numpy as np

from benchmarks.data import SEED
from benchmarks.table1 import midpoints
from texloom.io.mesh import read_mesh
from texloom.mesh.mesh import Mesh

MESH = "bunny-watertight-30k.obj"
FACES = 8192
_WAVES = 4  # of each bend
_BEND = 0.02  # of the longest side, the usual size of a wave
_SHORTEST = 2.0  # waves over the longest side: legs and ears stay what they are


@cache
def bunny(data: Path, faces: int = FACES) -> Mesh:
    """The bunny with so many faces."""
    import igl

    whole = read_mesh(data / "meshes" / MESH).mesh
    vertices, kept, *_ = igl.decimate(whole.vertices, whole.faces.astype(np.int64), faces)
    return Mesh(np.ascontiguousarray(vertices), np.ascontiguousarray(kept, np.int32))


def finer(data: Path, faces: int, times: int) -> Mesh:
    """The bunny with so many faces, each cut into four, and again."""
    mesh = bunny(data, faces)
    for _ in range(times):
        mesh = midpoints(mesh)
    return mesh


def write_bent(folder: Path, mesh: Mesh, count: int) -> None:
    """So many meshes, each bent by waves of its own, as ``NUMBER.obj`` in a folder."""
    longest = np.ptp(mesh.vertices, axis=0).max()
    faces = "".join(f"f {a} {b} {c}\n" for a, b, c in (mesh.faces + 1).tolist())
    draw = np.random.default_rng(SEED)
    for number in range(count):
        wave = draw.normal(size=(3, _WAVES)) * _SHORTEST / longest
        moved = np.sin(mesh.vertices @ wave + draw.uniform(0, 2 * np.pi, _WAVES)) @ draw.normal(size=(_WAVES, 3))
        vertices = mesh.vertices + _BEND * longest * moved
        lines = "".join(f"v {x:.7g} {y:.7g} {z:.7g}\n" for x, y, z in vertices.tolist())
        (folder / f"{number:04}.obj").write_text(lines + faces, encoding="utf-8")
