"""Pictures of sweeps: scored beside other methods, on coarse structures, and where a sweep closes on itself."""

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from benchmarks import report
from benchmarks.data import SEED
from benchmarks.sweep_scenes import BUNNY, SCORES, Scene, load
from texloom.domain.order import sweep_order
from texloom.domain.surface import Surface
from texloom.field.direction import from_vectors
from texloom.io.stack import read_exemplar
from texloom.output.camera import Camera, turntable
from texloom.output.gather import gather_sites
from texloom.output.preview import Skin, preview
from texloom.sources import SourceMap
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.sweep import Sweep
from texloom.synthesis.synthesize import Method, synthesize
from texloom.systems.resampling import optimization
from texloom.systems.sweep import sweeps

PAIRS = (
    ("scales-green-cells-192", "armadillo-15k"),
    ("bricks-brown-192", "spot-3k"),
    ("chainmail-128", "two-knots-6k"),
    ("tiles-azulejo-256", "fandisk-6k"),
    ("stones-brown-wall-128", "head-max-planck-5k"),
    ("roof-slate-scales-128", "lilium-open-3k"),
)
METHODS: dict[str, Method] = {
    "optimize": Optimize(),
    "patches": PatchSampling(),
    "sweep": Sweep(),
    "sweep, random": Sweep(start="random"),
    "talk": sweeps(),
    "scaled patches": optimization(),
}
COARSE = ("stones-flagstone-192", "tiles-azulejo-256", "mud-cracked-400", "weave-wood-basket-192")
LEVELS: dict[str, Method] = {
    "optimize": Optimize(),
    **{f"sweep, {levels} level{'s'[: levels - 1]}": Sweep(levels=levels) for levels in (1, 2, 3, 4)},
    "scaled patches": optimization(),
}
CLOSED = ("torus-2k", BUNNY)
SMALL = ("scales-green-cells-192", "stones-brown-wall-128", "granite-white-128")
_SEAM_TEXELS, _SEEDS = 8_000, 2
_VIEW = 384  # pixels

Table = dict[str, dict[str, dict[str, float]]]
"""Scores by pair (or sample) and method."""


def pairs(data: Path) -> Table:
    """Six samples on six meshes, all methods on the same sites."""
    return {f"{sample} on {mesh}": _grown(data, sample, mesh, METHODS, "pairs") for sample, mesh in PAIRS}


def structure(data: Path) -> Table:
    """Samples with coarse structures: how much more levels help, beside patches that shrink."""
    return {sample: _grown(data, sample, BUNNY, LEVELS, "structure") for sample in COARSE}


def seam(data: Path) -> list[dict[str, Any]]:
    """The seam ratio where a sweep around an axis meets itself, a row for each method and mesh."""
    rows = []
    methods = {"talk": sweeps(), "sweep, random": Sweep(start="random"), "sweep": Sweep()}
    for mesh in CLOSED:
        surface = _around(data, mesh)
        for name, method in methods.items():
            ratios = {sample: _seam_ratio(data, sample, surface, method) for sample in SMALL}
            rows.append({"mesh": mesh, "method": name, **ratios, "mean": float(np.mean(list(ratios.values())))})
            print(f"  {rows[-1]}", flush=True)
    return rows


def tables(scores: Table) -> str:
    """A table for each score, the means below."""
    methods = list(next(iter(scores.values())))
    parts = []
    for name in SCORES:
        body = [[what, *(row[method][name] for method in methods)] for what, row in scores.items()]
        means = [float(np.mean([row[method][name] for row in scores.values()])) for method in methods]
        parts.append(f"### {name}\n\n" + report.table(["", *methods], [*body, ["**mean**", *means]]))
    return "\n\n".join(parts)


def _grown(data: Path, sample: str, mesh: str, methods: dict[str, Method], what: str) -> dict[str, dict[str, float]]:
    """Scores of every method, and a sheet of their previews."""
    scene, made, shown = Scene.of(data, sample, mesh), {}, []
    for name, method in methods.items():
        sources, made[name] = scene.grow(method)
        shown.append(_previews(scene, sources))
    print(f"  {sample}: " + ", ".join(f"{name} {row['swd']:.3f}" for name, row in made.items()), flush=True)
    _save_sheet(f"sweep-{what}-{sample}-{mesh}", np.concatenate(shown, axis=1))
    return made


def _previews(scene: Scene, sources: SourceMap) -> np.ndarray:
    """Two sides of the surface, one above the other."""
    mesh, colours = scene.surface.refined.mesh, gather_sites(sources, scene.exemplar.lead)[:, :3]
    views = turntable(2, Camera(azimuth=25.0))
    shown = preview(
        mesh.vertices, mesh.faces, Skin(colours=colours), normals=mesh.vertex_normals, size=_VIEW, views=views
    )
    return np.concatenate([shown[:, :_VIEW], shown[:, _VIEW:]])


def _save_sheet(name: str, picture: np.ndarray) -> None:
    """Methods from left to right. Not kept in the repository: most samples may not be shipped."""
    path = report.RESULTS.parents[1] / "out" / f"{name}.png"
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(picture).save(path)


def _around(data: Path, name: str) -> Surface:
    """A closed mesh with a field that runs around its shortest axis, without a start."""
    mesh = load(data, name)
    axis = np.eye(3)[np.argmin(np.ptp(mesh.vertices, axis=0))]
    field = from_vectors(mesh, 1, np.cross(axis, mesh.vertices - mesh.vertices.mean(axis=0)))
    return Surface.build(mesh, field, texel=float(np.sqrt(mesh.face_areas.sum() / _SEAM_TEXELS)))


def _seam_ratio(data: Path, sample: str, surface: Surface, method: Method) -> float:
    """Mean colour step along edges whose ends found most of what is near before them, over that along all others."""
    exemplar = read_exemplar(data / "exemplars" / f"{sample}.png")
    seam = _enclosed(surface)[surface.edges].all(axis=1)
    low, high = surface.edges.T
    step = np.zeros(len(low))
    for seed in range(SEED, SEED + _SEEDS):
        values = gather_sites(synthesize(exemplar, surface, method, seed=seed).sources, exemplar.lead)
        step += np.abs(values[low] - values[high]).mean(axis=1) / surface.refined.mesh.edge_lengths
    return float(step[seam].mean() / step[~seam].mean())


def _enclosed(surface: Surface) -> np.ndarray:
    """Sites of whose neighbours within 2.5 texels more than 0.6 come before them in the sweep."""
    rank = np.empty(surface.count, np.int64)
    rank[sweep_order(surface)] = np.arange(surface.count)
    sites = surface.neighbourhoods(np.arange(surface.count, dtype=np.int32), 2).sites[:, 1:]
    before = (sites >= 0) & (rank[sites] < rank[:, None])
    return before.sum(axis=1) > 0.6 * (sites >= 0).sum(axis=1)
