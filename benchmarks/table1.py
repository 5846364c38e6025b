"""The published table of local resampling (Chen, Liu & Dong, table 1) beside ours, and how cost grows with the mesh."""

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from benchmarks import report
from benchmarks.data import SEED

MESHES = ("spot-loop-47k.ply", "spot-loop-187k.ply", "spot-loop-750k.ply")
TABLE_MESH = "spot-loop-187k.ply"

# (method, search): analysis and synthesis seconds on a Pentium 4, 3.0 GHz; 96² sample, 32² patches, 196 k vertices.
PUBLISHED = {
    ("optimize", "exhaustive"): (0.55, 1521.0),
    ("optimize", "pca-ann"): (3.83, 24.8),
    ("optimize", "pca-clusters"): (4.55, 31.6),
    ("optimize", "clusters"): (7.88, 55.6),
    ("patches", "exhaustive"): (0.55, 76.1),
    ("patches", "pca-ann"): (9.64, 1.80),
    ("patches", "pca-clusters"): (9.73, 3.06),
    ("patches", "clusters"): (8.17, 5.25),
}


def main(data: Path) -> None:
    if importlib.util.find_spec("texloom.systems.resampling") is None:
        print("  texloom.systems.resampling is not there yet: nothing to time")
        return
    resampling: Any = importlib.import_module("texloom.systems.resampling")

    rows = []
    for (method, search), published in PUBLISHED.items():
        row: dict[str, Any] = resampling.table1(data / "meshes" / TABLE_MESH, method=method, search=search, seed=SEED)
        rows.append({"method": method, "search": search, **row, "published": published})
        print(f"  {method} {search}: {row}", flush=True)
    growth = [resampling.preparation(data / "meshes" / mesh) for mesh in MESHES if (data / "meshes" / mesh).is_file()]
    _write(rows, growth)


def _write(rows: list[dict[str, Any]], growth: list[dict[str, Any]]) -> None:
    header = [
        "method",
        "search",
        "analysis s",
        "synthesis s",
        "patches",
        "published analysis s",
        "published synthesis s",
    ]
    body = [
        [row["method"], row["search"], row["analysis"], row["synthesis"], row["patches"], *row["published"]]
        for row in rows
    ]
    sections = [
        f"{TABLE_MESH}, 96² sample, 32² patches, one level, seed {SEED}; published on a Pentium 4 at 3.0 GHz and 196 k "
        "vertices.",
        report.table(header, body),
        "## Preparation and its growth\n\nReading, field, refinement and all patches, in seconds.",
        report.table(list(growth[0]), [list(row.values()) for row in growth]) if growth else "No meshes to measure.",
    ]
    report.write(
        "table1", title="Local resampling, table 1", sections=sections, numbers={"rows": rows, "growth": growth}
    )
