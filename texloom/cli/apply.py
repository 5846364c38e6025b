"""``texloom apply``: saved sources shown with another stack."""

from pathlib import Path
from typing import Annotated

import typer

from texloom.cli import options
from texloom.cli.session import Session


def apply(
    sources: Annotated[Path, typer.Argument(metavar="SOURCES", help="A .npz that --sources has saved.")],
    stack: Annotated[
        Path, typer.Argument(metavar="STACK", help="An image, or a folder of maps, of the sample's size.")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="An image, or a folder for a stack of maps.")],
    directx_normals: options.DirectX = False,
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Apply saved sources to another stack of maps, aligned with the sample they came from."""
    options.check_output(output)
    with Session(threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.cli.reapply import reapply
            from texloom.io.stack import read_exemplar
            from texloom.output.image import write_images
            from texloom.output.sources_file import load_sources

            saved = load_sources(sources)
            exemplar = read_exemplar(stack, directx_normals=directx_normals)
        with session.stage("gather"):
            maps = reapply(saved, exemplar, sources.name)
        with session.stage("write"):
            session.wrote(write_images(output, maps, settings={**saved.settings, "applied to": stack.name}))
        rows, columns = next(iter(maps.values())).image.shape[:2]
        session.finish({"size": (columns, rows), "maps": list(maps)})
