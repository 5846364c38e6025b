"""``texloom apply``: saved sources shown with other stacks."""

from pathlib import Path
from typing import Annotated

import typer

from texloom.cli import options
from texloom.cli.session import Session


def apply(
    sources: Annotated[Path, typer.Argument(metavar="SOURCES", help="A .npz that --sources has saved.")],
    stacks: Annotated[
        list[Path], typer.Argument(metavar="STACK", help="An image or a folder of maps for each sample, of its size.")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="An image, or a folder for a stack of maps.")],
    directx_normals: options.DirectX = False,
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Apply saved sources to other stacks of maps, each aligned with the sample it takes the place of."""
    options.check_output(output)
    with Session(threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.cli.reapply import reapply, rejoin
            from texloom.cli.samples import read_each, tell_dropped
            from texloom.output.image import write_images
            from texloom.output.sources_file import load_sources

            saved = load_sources(sources)
            joined = rejoin(saved, read_each(stacks, directx_normals=directx_normals), sources.name)
        with session.stage("gather"):
            maps = reapply(saved, joined.exemplar, sources.name)
        with session.stage("write"):
            settings = {**saved.settings, "applied to": ", ".join(stack.name for stack in stacks)}
            session.wrote(write_images(output, maps, settings=settings))
        tell_dropped(joined)
        rows, columns = next(iter(maps.values())).image.shape[:2]
        session.finish({"size": (columns, rows), "maps": list(maps), "dropped": list(joined.dropped)})
