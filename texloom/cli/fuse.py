"""``texloom fuse``: several samples in one picture, where a map wants them."""

from pathlib import Path
from typing import Annotated, cast

import typer

from texloom.cli import methods, options
from texloom.cli.session import Session
from texloom.errors import ParameterError

BELTS = ("cut", "sample")
Palette = Annotated[
    str | None, typer.Option(metavar="COLOURS", help="red,#00f,...: the map's colour a sample; found if not given.")
]
Belts = Annotated[
    str | None,
    typer.Option(metavar="NAME", help="cut (the default): textures overlap and are cut; sample: a mixed one between."),
]


def fuse(
    context: typer.Context,
    map: Annotated[
        str,
        typer.Argument(
            metavar="MAP", help="A picture, a colour for each sample; or discs: one sample fades to the other."
        ),
    ],
    samples: options.Samples,
    output: Annotated[Path, typer.Option("--output", "-o", help="An image, or a folder for a stack of maps.")],
    size: Annotated[str | None, typer.Option(metavar="W[xH]", help="Texels; the map's if not given.")] = None,
    palette: Palette = None,
    strewn: Annotated[
        bool, typer.Option("--discs", help="The map's brightness is the chance of the second sample's discs.")
    ] = False,
    tileable: Annotated[bool, typer.Option("--tileable", help="Opposite borders fit together.")] = False,
    belts: Belts = None,
    method: options.Method = None,
    preset: options.Preset = None,
    seed: options.Seed = 0,
    sources: options.SourcesOut = None,
    report: options.Report = None,
    directx_normals: options.DirectX = False,
    device: options.Device = "cpu",
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Fuse samples into one picture without seams, each where a map has its colour."""
    wanted = methods.wish(method, None, preset)
    shape = None if size is None else options.parse_size(size)
    if belts is not None and preset is not None:
        raise ParameterError(f"--belts {belts}: --preset {preset} says how belts are filled, leave --belts out")
    belts = options.choose("belts", belts or BELTS[preset is not None], BELTS)
    options.check_report(report)
    options.check_output(output, sources, report)

    with Session(device=device, threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.cli import fusing
            from texloom.cli.reapply import image_domain
            from texloom.cli.samples import read_each, tell_dropped
            from texloom.domain.grid import Grid
            from texloom.exemplar.join import join
            from texloom.fusion import fuse as fusion
            from texloom.output.gather import gather_images
            from texloom.output.image import single_map, write_images
            from texloom.output.sources_file import SavedSources, save_sources

            chosen, belt_method = wanted.grower("fuse"), wanted.belt_method()
            stacks = read_each(samples, directx_normals=directx_normals)
            colours = fusing.parse_palette(palette)
            wish, (rows, columns) = fusing.of_image(map, shape, stacks, palette=colours, strewn=strewn, wrap=tileable)
            domain = Grid(rows, columns, wrap=tileable)
            if options.is_file(output):
                single_map(join(stacks).exemplar.maps, output)
        fused = fusion.fuse(
            stacks,
            wish.labels,
            domain,
            method=chosen,
            belts=cast(fusion.Filling, belts),
            belt_method=belt_method,
            seed=seed,
            report=session.report,
        )
        result, exemplar = fused.result, fused.exemplar
        session.add(result.seconds)
        settings = options.settings(
            "fuse", *samples, method=chosen, map=Path(map).name, belts=belts, seed=seed, tileable=tileable
        )
        with session.stage("write"):
            pictures = gather_images(result.sources, exemplar, rows=rows, columns=columns)
            session.wrote(write_images(output, pictures, settings=settings))
            if sources is not None:
                kept = SavedSources(result.sources, image_domain(rows, columns, exemplar), settings)
                session.wrote(save_sources(sources, kept))
        if report is not None:
            with session.stage("report"):
                from texloom.cli.reports import Run, of_image
                from texloom.output.report import write_report

                run = Run(exemplar, result, settings, dict(session.seconds), options.command_line(context))
                session.wrote(write_report(report, of_image(run, domain, pictures)))
        tell_dropped(fused.joined)
        session.finish(
            {
                "method": wanted.method,
                "preset": preset,
                "seed": seed,
                "size": (columns, rows),
                "samples": wish.told(samples, fused.labels),
                "maps": list(pictures),
                "dropped": list(fused.joined.dropped),
                "patches": result.patches,
                "energy": list(result.energy),
                "stopped": result.stopped,
            }
        )
