"""``texloom inspect``: what a file holds, and what is wrong with it."""

import json
import zipfile
from pathlib import Path
from typing import Annotated, Any

import typer

from texloom.cli import options
from texloom.cli.library import SUFFIX as TEXTONS
from texloom.cli.library import facts_of, list_library, textons_in
from texloom.cli.session import Session
from texloom.errors import FileError, ParameterError


def inspect(
    context: typer.Context,
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="An image, a folder of maps, a mesh, saved sources, a saved analysis, textons or a folder of them.",
        ),
    ],
    material: Annotated[str | None, typer.Option(metavar="NAME", help="Look at this material of a mesh only.")] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="FILE.html", help="A page of a sample: its spectrum and its lattice.")
    ] = None,
    as_json: options.Json = False,
) -> None:
    """Say what a file holds: sizes, maps, scale and period of a sample, parts, defects and what would be mended."""
    if not file.exists():
        raise FileError(f"{file}: no such file or folder")
    options.check_report(report)
    options.check_output(report)
    if report is not None and file.suffix.lower() in (*options.MESH_SUFFIXES, ".npz", TEXTONS):
        raise ParameterError(f"--report tells of a sample, and {file.name} is none: give an image or a folder of maps")
    with Session(as_json=as_json) as session, session.stage("read"):
        if file.suffix.lower() in options.MESH_SUFFIXES:
            session.finish(_describe_mesh(file, material))
        elif file.suffix.lower() == TEXTONS:
            from texloom.output.textons_file import read_entry

            session.finish(facts_of(read_entry(file)))
        elif file.is_dir() and (library := textons_in(file)):
            facts, table = list_library(library)
            session.finish(facts, text=table)
        elif file.is_file() and zipfile.is_zipfile(file):
            session.finish(_describe_archive(file))
        elif file.suffix.lower() == ".npz":
            raise FileError(f"{file.name} holds neither sources nor an analysis, or is damaged: save it again")
        else:
            session.finish(_describe_stack(file, context, report, session, as_json))


def _describe_stack(
    path: Path, context: typer.Context, report: Path | None, session: Session, as_json: bool
) -> dict[str, Any]:
    from texloom.cli import structure as told
    from texloom.exemplar.suggest import structure
    from texloom.io.stack import read_exemplar
    from texloom.output.report import write_report

    exemplar = read_exemplar(path)
    rows, columns = exemplar.shape
    maps = {
        name: {
            "kind": map.kind,
            "channels": map.image.shape[2],
            "bits": map.bits,
            "range": [float(map.image.min()), float(map.image.max())],
        }
        for name, map in exemplar.maps.items()
    }
    masked = 0.0 if exemplar.mask is None else 1.0 - float(exemplar.mask.mean())
    found = structure(exemplar)
    if report is not None:
        session.wrote(write_report(report, told.account(path, exemplar, found, options.command_line(context))))
    described = {"kind": "stack" if path.is_dir() else "image", "size": (columns, rows), "maps": maps, "masked": masked}
    return described | (told.facts(found) | told.curves(found) if as_json else told.lines(found))


def _describe_archive(path: Path) -> dict[str, Any]:
    """Saved sources, or a saved analysis, by the mark in its header."""
    import numpy as np

    try:
        with np.load(path, allow_pickle=False) as archive:
            header = json.loads(str(archive["header"]))
            if "texloom_analysis" in header:
                levels = [archive[name].shape for name in sorted(archive.files) if name.startswith("appearance")]
                return _describe_analysis(header, levels)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
        raise FileError(f"{path.name} holds neither sources nor an analysis, or is damaged: save it again") from None
    return _describe_sources(path)


def _describe_analysis(header: dict[str, Any], levels: list[tuple[int, ...]]) -> dict[str, Any]:
    """What was learnt from an exemplar; ``levels`` are the shapes of its appearance, finest first."""
    return {
        "kind": "analysis",
        "version": header["texloom_analysis"],
        "fingerprint": header["fingerprint"],
        "sample": (levels[0][1], levels[0][0]),
        "levels": len(levels),
        "dimensions": levels[0][2] - 1,
        "learnt for": header["requests"],
    }


def _describe_sources(path: Path) -> dict[str, Any]:
    from texloom.output.sources_file import load_sources

    saved = load_sources(path)
    sources, domain = saved.sources, saved.domain
    rows, columns = (int(domain[name]) if name in domain else 0 for name in ("rows", "columns"))
    return {
        "kind": "sources",
        "of": "an image" if rows else "a surface",
        "size": (columns, rows) if rows else (),
        "texel": float(domain["surface.texel"]) if "surface.texel" in domain else None,
        "atlas": tuple(reversed(domain["atlas.nearest"].shape)) if "atlas.nearest" in domain else (),
        "sample": tuple(int(side) for side in reversed(domain.get("sample", ()))),
        "sites": sources.count,
        "sources a site": sources.weight.shape[1],
        "turned": sources.turn is not None,
        "scaled": sources.scale is not None,
        "settings": dict(saved.settings),
    }


def _describe_mesh(path: Path, material: str | None) -> dict[str, Any]:
    import numpy as np

    from texloom.io.mesh import read_mesh

    model = read_mesh(path, material=material)
    mesh = model.mesh
    characteristic = len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)
    return {
        "kind": "mesh",
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "parts": _parts(mesh.faces, len(mesh.vertices)),
        "boundary vertices": int(np.count_nonzero(mesh.boundary_vertices)),
        "Euler characteristic": characteristic,
        "area": float(mesh.face_areas.sum()),
        "extent": [float(side) for side in np.ptp(mesh.vertices, axis=0)],
        "uv": model.uv is not None,
        "mends": list(model.mends),
    }


def _parts(faces: Any, vertices: int) -> int:
    """Connected components of the vertices."""
    import numpy as np
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    return connected_components(coo_matrix((np.ones(len(start)), (start, end)), (vertices, vertices)))[0]
