"""The published table of local resampling (Chen, Liu & Dong, table 1) beside ours, and how cost grows."""

import resource
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import report
from benchmarks.data import SEED
from texloom.domain.surface import Surface
from texloom.exemplar.exemplar import Exemplar
from texloom.field.smooth import smoothest
from texloom.io.mesh import read_mesh
from texloom.io.stack import read_exemplar
from texloom.mesh.mesh import Mesh
from texloom.progress import silent
from texloom.search import SEARCHES
from texloom.synthesis.least_squares import LeastSquares, lay
from texloom.systems import resampling

TABLE_MESH = "spot-loop-187k.ply"
COARSE_MESH = "spot-3k.obj"
SAMPLE = "scales-green-cells-192.png"
SIDE = 96  # texels of the sample used, as published

# (method, search): analysis and synthesis seconds on a Pentium 4, 3.0 GHz; 96² sample, 32² patches, 196 k vertices.
PUBLISHED = {
    ("optimize", "exhaustive"): (0.55, 1521.0),
    ("optimize", "pca"): (3.83, 24.8),
    ("optimize", "pca-clusters"): (4.55, 31.6),
    ("optimize", "clusters"): (7.88, 55.6),
    ("patches", "exhaustive"): (0.55, 76.1),
    ("patches", "pca"): (9.64, 1.80),
    ("patches", "pca-clusters"): (9.73, 3.06),
    ("patches", "clusters"): (8.17, 5.25),
}


def main(data: Path) -> None:
    """Print and write the tables."""
    exemplar = read_exemplar(data / "exemplars" / SAMPLE).crop(slice(0, SIDE), slice(0, SIDE))
    surface, preparation = prepare(lambda: read_mesh(data / "meshes" / TABLE_MESH).mesh)
    growth = [preparation]
    rows = [time_row(exemplar, surface, method, search) for method, search in PUBLISHED]
    stages = time_stages(exemplar, surface)
    del surface
    coarse = read_mesh(data / "meshes" / COARSE_MESH).mesh
    growth.insert(0, prepare(lambda: midpoints(midpoints(coarse)))[1])
    fine = read_mesh(data / "meshes" / TABLE_MESH).mesh
    growth.append(prepare(lambda: midpoints(fine))[1])
    _write(rows, stages, growth)


def prepare(load: Any) -> tuple[Surface, dict[str, Any]]:
    """Read, field, sites and all 32² patches of a mesh, one site a vertex, timed apart."""
    clock = [time.perf_counter()]
    mesh = load()
    clock.append(time.perf_counter())
    field = smoothest(mesh, 1)
    clock.append(time.perf_counter())
    texel = float(np.sqrt(mesh.face_areas.sum() / len(mesh.vertices)))
    surface = Surface.build(mesh, field, texel=texel, spacing=np.inf)
    assert surface.flow is not None
    clock.append(time.perf_counter())
    patches = lay(surface, 32, SEED)
    clock.append(time.perf_counter())
    names = ("read", "field", "sites", "patches")
    seconds = dict(zip(names, np.diff(clock).round(2).tolist(), strict=True))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024**2
    row = {"vertices": len(mesh.vertices), **seconds, "total": round(clock[-1] - clock[0], 2)}
    row |= {"patches laid": patches.count, "peak GiB so far": round(peak, 2)}
    print(f"  prepare: {row}", flush=True)
    return surface, row


def time_row(exemplar: Exemplar, surface: Surface, method: str, search: str) -> dict[str, Any]:
    """One cell of the table, single-level, patches laid beforehand."""
    optimization, sampling = resampling.single_level(SEARCHES[search])
    chosen = optimization if method == "optimize" else sampling
    laid: Any = {32: lay(surface, 32, SEED)} if isinstance(chosen, LeastSquares) else chosen.lay(surface, SEED)
    start = time.perf_counter()
    analysis = chosen.analyse(exemplar)
    analysed = time.perf_counter() - start
    seconds = []
    for _ in range(1 if search == "exhaustive" else 3):
        start = time.perf_counter()
        result = chosen.solve(analysis, surface, laid, seed=SEED, report=silent)
        seconds.append(time.perf_counter() - start)
    row = {"method": method, "search": search, "analysis": analysed, "synthesis": min(seconds)}
    row |= {"patches": result.patches, "iterations": len(result.energy) or 1}
    print(f"  {row}", flush=True)
    return row


def time_stages(exemplar: Exemplar, surface: Surface) -> dict[str, Any]:
    """The six-stage schedule of section 4.4, patches laid beforehand."""
    method = resampling.optimization()
    analysis = method.analyse(exemplar)
    laid = {extent: lay(surface, extent, SEED) for extent in sorted({stage.extent for stage in method.schedule})}
    start = time.perf_counter()
    result = method.solve(analysis, surface, laid, seed=SEED, report=silent)
    row = {"seconds": time.perf_counter() - start, "patches": result.patches, "iterations": len(result.energy)}
    print(f"  six stages: {row}", flush=True)
    return row


def midpoints(mesh: Mesh) -> Mesh:
    """Every triangle cut into four at the middles of its edges."""
    middle = mesh.vertices[mesh.edges].mean(1)
    edge = mesh.halfedge_edges.reshape(-1, 3) + len(mesh.vertices)
    a, b, c = mesh.faces.T
    ab, bc, ca = edge.T
    faces = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return Mesh(
        np.concatenate([mesh.vertices, middle]),
        np.concatenate([np.stack(corners, 1) for corners in faces]).astype(np.int32),
    )


def _write(rows: list[dict[str, Any]], stages: dict[str, Any], growth: list[dict[str, Any]]) -> None:
    header = ["method", "search", "patches", "analysis s", "published", "synthesis s", "published", "times faster"]
    body = []
    for row in rows:
        analysis, synthesis = PUBLISHED[row["method"], row["search"]]
        faster = synthesis / row["synthesis"]
        body.append(
            [
                *(row["method"], row["search"], row["patches"], round(row["analysis"], 3), analysis),
                *(round(row["synthesis"], 3), synthesis, round(faster)),
            ]
        )
    sections = [
        f"{TABLE_MESH}, {SIDE}² sample, 32² patches, one level, ten iterations, seed {SEED}; the published figures are "
        "of a Pentium 4 at 3.0 GHz and 196 k vertices.",
        report.table(header, body),
        f"The six-stage schedule of section 4.4: {stages['seconds']:.2f} s, {stages['iterations']} iterations in all.",
        "## Preparation and its growth\n\nReading, field, sites and all 32² patches, in seconds; one site a vertex.",
        report.table(list(growth[0]), [list(row.values()) for row in growth]),
    ]
    numbers = {"rows": rows, "stages": stages, "growth": growth}
    report.write("table1", title="Local resampling, table 1", sections=sections, numbers=numbers)
