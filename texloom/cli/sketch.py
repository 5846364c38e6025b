"""``texloom sketch``: draw the cells, get the texture."""

from pathlib import Path
from typing import Annotated

import typer

from texloom.cli import options
from texloom.cli.session import Session
from texloom.cli.sketch_wish import PRESET, SketchWish, check


def sketch(
    context: typer.Context,
    drawing: Annotated[
        str, typer.Argument(metavar="SKETCH", help="An SVG, a drawing, a picture with cells to detect; or random.")
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="An image, or a folder for a stack of maps; with --mesh-only an SVG.")
    ],
    samples: Annotated[
        list[Path] | None,
        typer.Argument(metavar="SAMPLE...", help="An image, or a folder of maps (basecolor.png, normal.png, ...)."),
    ] = None,
    further: options.Sketches = None,
    size: Annotated[str, typer.Option(metavar="W[xH]", help="Texels.")] = "512",
    scale: Annotated[
        float | None,
        typer.Option(metavar="S", help="Texels a texel of the sketch; cells as large as the sample's if not given."),
    ] = None,
    radius: options.Radius = None,
    tileable: Annotated[bool, typer.Option("--tileable", help="Opposite borders fit together.")] = False,
    sample_sketch: options.SampleSketch = None,
    kinds: Annotated[
        Path | None,
        typer.Option(metavar="MAP", help="With --pattern: a picture of the sample, a colour a kind of cell."),
    ] = None,
    pattern: Annotated[
        Path | None,
        typer.Option(metavar="IMAGE", help="Where each kind, or of several samples each, goes: its colour."),
    ] = None,
    inside: Annotated[
        str | None, typer.Option(metavar="NAME", help="Cells are laid in radial, or by scale; by what they show.")
    ] = None,
    mesh_only: Annotated[bool, typer.Option("--mesh-only", help="Write the cells as SVG, without texture.")] = False,
    preset: Annotated[str | None, typer.Option(metavar="KEY", help=f"A paper's own parameters: {PRESET}.")] = None,
    mask: options.Mask = None,
    seed: options.Seed = 0,
    sources: options.SourcesOut = None,
    report: options.Report = None,
    directx_normals: options.DirectX = False,
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Design a texture by its cells: those of a sketch, laid over any size, filled from the cells of a sample."""
    wanted = SketchWish(
        sketches=[drawing, *(further or [])],
        samples=samples or [],
        drawings=sample_sketch or [],
        output=output,
        size=options.parse_size(size),
        scale=scale,
        radius=radius,
        tileable=tileable,
        kinds=kinds,
        pattern=pattern,
        inside=inside,
        mesh_only=mesh_only,
        preset=preset,
        mask=mask,
        seed=seed,
        sources=sources,
        report=report,
        directx_normals=directx_normals,
        command=options.command_line(context),
    )
    check(wanted)
    options.check_mask(mask, wanted.samples)
    options.check_report(report)
    options.check_output(output, sources, report)

    with Session(threads=threads, as_json=as_json) as session:
        if mesh_only:
            from texloom.cli.designing import draw as work
        else:
            from texloom.cli.designing import design as work
        session.finish(work(wanted, session))
