"""Seconds of sweeps and of what they stand on: points, stages, whole processes, fields through arrows."""

import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import machine, ours
from benchmarks.clock import best, once
from benchmarks.data import SEED
from benchmarks.sweep_scenes import BUNNY, load
from texloom.domain.surface import Surface
from texloom.field import spread
from texloom.field.arrows import Arrow, place
from texloom.field.singularities import indices
from texloom.field.smooth import smoothest, through_arrows
from texloom.io.stack import read_exemplar
from texloom.kernels import launch
from texloom.mesh.mesh import Mesh
from texloom.points import hierarchy
from texloom.synthesis.sweep import Sweep
from texloom.synthesis.synthesize import synthesize
from texloom.systems.sweep import sweeps

SAMPLE = "scales-green-cells-192"
COUNTS = (4_000, 16_000, 64_000, 256_000)
POINTS = 64_000  # of the finest of three levels
SPEEDS = {
    "parallel": Sweep(),
    "parallel, one pass": Sweep(passes=1),
    "parallel, tree": Sweep(search="tree"),
    "sequential": Sweep(order="sequential"),
    "from random": Sweep(start="random"),
    "talk": sweeps(),
}
ARROWED = (BUNNY, "spot-3k", "torus-2k")
_TIMES = 3
_BEGIN = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""
_DENSITY = 2 / np.sqrt(3)  # points a square texel

Rows = list[dict[str, Any]]


def points(data: Path) -> Rows:
    """Seconds of a hierarchy, and how even its levels are."""
    mesh, rows = load(data, BUNNY), list[dict[str, Any]]()
    for threads in (1, 2):
        launch.use(threads=threads)
        load_now = machine.load()
        seconds, made = best(lambda: hierarchy(mesh, COUNTS, seed=SEED), _TIMES)
        rows.append({"threads": threads, "seconds": round(seconds, 2), "load before": round(load_now, 1)})
        for name in ("variation", "closest"):
            rows[-1][f"{name} by level"] = ", ".join(f"{getattr(level, name):.3f}" for level in made.levels)
        print(f"  {rows[-1]}", flush=True)
    return rows


def stages(data: Path) -> Rows:
    """Warm seconds of a sweep by stage, the points apart."""
    exemplar, surface, rows = read_exemplar(data / "exemplars" / f"{SAMPLE}.png"), _bunny(data), []
    for threads in (1, 2):
        launch.use(threads=threads)
        for name, method in SPEEDS.items():
            runs = [synthesize(exemplar, surface, method, seed=SEED).seconds for _ in range(_TIMES + 1)][1:]
            least = min(runs, key=lambda stage: sum(stage.values()) - stage["points"])
            rows.append({"method": name, "threads": threads, "without points": sum(least.values()) - least["points"]})
            rows[-1] |= {f"{stage} s": seconds for stage, seconds in sorted(least.items(), key=_by_stage)}
            print(f"  {rows[-1]}", flush=True)
    return rows


def processes(data: Path) -> Rows:
    """Whole commands: seconds and peak memory; the first of all compiles its kernels."""
    sample, mesh, rows = data / "exemplars" / f"{SAMPLE}.png", data / "meshes" / f"{BUNNY}.obj", []
    with tempfile.TemporaryDirectory() as folder:
        line = ["surface", mesh, sample, "-o", Path(folder, "out.ply"), "--texel", str(_texel(load(data, BUNNY)))]
        for name, words in {"sweep": ["--method", "sweep"], "talk": ["--preset", "sweep"], "optimize": []}.items():
            for threads in (1, 2):
                command = [*line, *words, "--threads", threads]
                _alone(command)
                spent = _alone(command)
                rows.append({"method": name, "threads": threads, "process s": spent.seconds})
                rows[-1] |= {"peak MB": spent.peak_megabytes, "load before": round(machine.load(), 1)}
                print(f"  {rows[-1]}", flush=True)
        spent = _alone([*line, "--method", "sweep"], f"WARP_CACHE_PATH={folder}/kernels")
        rows.append({"method": "sweep, kernels compiled", "threads": 2, "process s": spent.seconds})
        rows[-1] |= {"peak MB": spent.peak_megabytes, "load before": round(machine.load(), 1)}
    return rows


def fields(data: Path) -> Rows:
    """Through four arrows around the shortest axis: singularities and seconds, spread and harmonic."""
    rows = []
    for name in ARROWED:
        mesh = load(data, name)
        placed = place(mesh, _arrows(mesh))
        given = {"vertices": placed.direction_vertex, "directions": placed.direction}
        for method, solve in {"spread": spread.directions, "harmonic": through_arrows}.items():
            for order in (1, 4):
                seconds, field = best(partial(solve, mesh, order, **given), 1)
                index = indices(mesh, field)
                rows.append({"mesh": name, "field": method, "symmetry": order, "seconds": round(seconds, 3)})
                rows[-1] |= {"singularities": int((index != 0).sum()), "index sum": round(float(index.sum()), 6)}
                rows[-1] |= {"Euler characteristic": _euler(mesh)}
                print(f"  {rows[-1]}", flush=True)
    return rows


def _alone(words: list[Any], *settings: str) -> ours.Spent:
    """Wall seconds and peak memory of a ``texloom`` process, begun by a small one: memory counts from its parent's."""
    texloom = str(Path(sys.executable).with_name("texloom"))
    line = ["env", *settings, sys.executable, "-c", _BEGIN, texloom, *map(str, words)]
    seconds, done = once(lambda: subprocess.run(line, capture_output=True, text=True, check=True))
    return ours.Spent(seconds, int(done.stdout) / (2**20 if sys.platform == "darwin" else 2**10))


def _by_stage(item: tuple[str, float]) -> tuple[int, str]:
    order = ("points", "analysis", "start", "stencils", "order", "sweeps")
    return (order.index(item[0]) if item[0] in order else len(order), item[0])


def _texel(mesh: Mesh) -> float:
    """For so many points on the finest level."""
    return float(np.sqrt(mesh.face_areas.sum() * _DENSITY / POINTS))


def _bunny(data: Path) -> Surface:
    mesh = load(data, BUNNY)
    return Surface.build(mesh, smoothest(mesh, 1), texel=_texel(mesh))


def _arrows(mesh: Mesh) -> list[Arrow]:
    """Four places far from each other, with directions around an axis."""
    middle, axis = mesh.vertices.mean(axis=0), np.eye(3)[np.argmin(np.ptp(mesh.vertices, axis=0))]
    chosen = [int(np.linalg.norm(mesh.vertices - middle, axis=1).argmax())]
    while len(chosen) < 4:
        away = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[chosen], axis=2).min(axis=1)
        chosen.append(int(away.argmax()))
    ways = np.cross(axis, mesh.vertices[chosen] - middle)
    return [Arrow(vertex=vertex, direction=tuple(way)) for vertex, way in zip(chosen, ways.tolist(), strict=True)]


def _euler(mesh: Mesh) -> int:
    return len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)
