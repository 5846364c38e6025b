"""``texloom inspect``: what a file holds, and what is wrong with it."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from texloom.cli import options
from texloom.cli.session import Session
from texloom.errors import FileError


def inspect(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="An image, a folder of maps, a mesh, or saved sources.")],
    material: Annotated[str | None, typer.Option(metavar="NAME", help="Look at this material of a mesh only.")] = None,
    as_json: options.Json = False,
) -> None:
    """Say what a file holds: sizes, maps, parts, defects and what would be mended."""
    if not file.exists():
        raise FileError(f"{file}: no such file or folder")
    with Session(as_json=as_json) as session, session.stage("read"):
        suffix = file.suffix.lower()
        describe: Callable[[Path], dict[str, Any]] = _describe_stack
        if suffix in options.MESH_SUFFIXES:
            session.finish(_describe_mesh(file, material))
        elif suffix == ".npz":
            session.finish(_describe_sources(file))
        else:
            session.finish(describe(file))


def _describe_stack(path: Path) -> dict[str, Any]:
    from texloom.io.stack import read_exemplar

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
    return {"kind": "stack" if path.is_dir() else "image", "size": (columns, rows), "maps": maps, "masked": masked}


def _describe_sources(path: Path) -> dict[str, Any]:
    from texloom.output.sources_file import load_sources

    saved = load_sources(path)
    sources = saved.sources
    return {
        "kind": "sources",
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
