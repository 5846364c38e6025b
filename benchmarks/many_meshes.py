"""Whole ``texloom surface`` processes: many meshes with one saved sample, and a mesh with its edges blended."""

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.bunny import bunny, write_bent
from benchmarks.clock import best, once
from benchmarks.data import SEED
from texloom.domain.faces import Faces, usual_width
from texloom.domain.surface import texel_for_repeats
from texloom.field.smooth import smoothest
from texloom.io.stack import read_exemplar
from texloom.output.atlas import lay_atlas
from texloom.output.blended_atlas import bake_blend, face_sites
from texloom.output.blending import blend, edge_errors
from texloom.output.image import stored
from texloom.output.png import png_bytes
from texloom.output.sample_uv import usable_maps
from texloom.output.textons_file import save_textons
from texloom.output.unwrap import unwrap
from texloom.search.textons import learn_textons
from texloom.synthesis.quilting import Quilting

SAMPLE = "weave-wood-basket-192"
ATLAS, GUTTER = 2048, 8  # texels
_FEW, _MANY = 10, 1000
STAGES = ("read", "field", "patches", "growth", "rounds", "edges", "write")


def many(data: Path, count: int) -> list[dict[str, Any]]:
    """Milliseconds a mesh of one process for many meshes, everything included; one row a number of threads."""
    mesh = bunny(data)
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        (here / "meshes").mkdir()
        write_bent(here / "meshes", mesh, count)
        (here / "few.txt").write_text("".join(f"meshes/{number:04}.obj\n" for number in range(_FEW)), encoding="utf-8")
        save_textons(here / "sample.textons", learn_textons(_sample(data), seed=SEED))
        return [_many_row(here, count, len(mesh.faces), threads) for threads in (1, 2)]


def _many_row(here: Path, count: int, faces: int, threads: int) -> dict[str, Any]:
    """All meshes of a folder in one process, and a few of them, which tell what does not grow with their number."""
    words = [here / "sample.textons", "--method", "texton", "-o", here / "out", "--threads", threads]
    few, _ = once(lambda: _told(["surface", here / "few.txt", *words]))
    seconds, told = once(lambda: _told(["surface", here / "meshes", *words]))
    each = (seconds - few) / (count - _FEW)
    row = {"threads": threads, "meshes": count, "faces": faces, "process s": round(seconds, 2)}
    row |= {"a mesh ms": round(1000 * seconds / count, 1), "one more ms": round(1000 * each, 1)}
    row |= {f"{_MANY} meshes, ms each": round((few + (_MANY - _FEW) * each) / _MANY * 1000, 1)}
    stage = told["seconds"]
    row |= {f"{name} ms": round(1000 * stage[name] / count, 1) for name in STAGES}
    print(f"  {row}", flush=True)
    return row


def blending(data: Path) -> list[dict[str, Any]]:
    """Edges blended at the distance at which the whole mesh shows, what a bake takes, and how large files are."""
    mesh, sample = bunny(data), _sample(data)
    field = smoothest(mesh, 1)
    texel = texel_for_repeats(mesh, 3.0, sample.shape[1])
    faces = Faces.build(mesh, field, texel=texel, width=usual_width(sample.shape))
    quilted = Quilting().run(textons := learn_textons(sample, seed=SEED), faces, seed=SEED)
    errors = edge_errors(mesh, quilted.coordinates, textons.image)
    blended = errors.blended()
    between = faces.patch[errors.halfedge // 3] != faces.patch[mesh.twins[errors.halfedge] // 3]
    unwrapping, uv = once(lambda: unwrap(mesh, size=ATLAS, gutter=GUTTER))
    sites = face_sites(mesh, quilted.coordinates)
    laying, laid = best(lambda: lay_atlas(sites, uv, size=ATLAS, gutter=GUTTER), 1)
    chosen = blend(mesh, quilted.coordinates, errors.at_faces(blended))
    baking, maps = best(lambda: bake_blend(chosen, laid, usable_maps(sample)), 2)
    coding, _ = once(lambda: png_bytes(stored(maps["basecolor"], 8)))
    sizes = _sizes(data)
    row = {
        "edges": len(errors.mean),
        "between patches": int(between.sum()),
        "blended": int(blended.sum()),
        "unwrap s": round(unwrapping, 2),
        f"lay {ATLAS}² s": round(laying, 3),
        f"bake {ATLAS}² s": round(baking, 3),
        "PNG s": round(coding, 2),
        **{f"{home} MB": round(size / 1e6, 2) for home, size in sizes.items()},
    }
    print(f"  {row}", flush=True)
    return [row]


def _sizes(data: Path) -> dict[str, int]:
    """Bytes of the GLB, by the way home."""
    with tempfile.TemporaryDirectory() as folder:
        here, sizes = Path(folder), {}
        write_bent(here, bunny(data), 1)
        for home, words in (("sample-uv", []), ("atlas", ["--atlas-size", ATLAS])):
            out = here / f"{home}.glb"
            sample = data / "exemplars" / f"{SAMPLE}.png"
            _told(["surface", here / "0000.obj", sample, "--method", "texton", "--as", home, "-o", out, *words])
            sizes[home] = out.stat().st_size
    return sizes


def _sample(data: Path) -> Any:
    return read_exemplar(data / "exemplars" / f"{SAMPLE}.png")


def _told(words: Sequence[object]) -> dict[str, Any]:
    """What a ``texloom`` process tells on stdout."""
    line = [str(Path(sys.executable).with_name("texloom")), *map(str, words), "--json"]
    done = subprocess.run(line, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"texloom {words[0]} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return json.loads(done.stdout)
