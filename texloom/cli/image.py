"""``texloom image``: a rectangle of any size from one sample or several."""

from pathlib import Path
from typing import Annotated

import typer

from texloom.cli import methods, options
from texloom.cli.analyses import check_analysis, with_analysis
from texloom.cli.session import Session


def image(
    context: typer.Context,
    samples: options.Samples,
    output: Annotated[Path, typer.Option("--output", "-o", help="An image, or a folder for a stack of maps.")],
    size: Annotated[str, typer.Option(metavar="W[xH]", help="Texels.")] = "512",
    tileable: Annotated[bool, typer.Option("--tileable", help="Opposite borders fit together.")] = False,
    field: Annotated[
        str | None, typer.Option(metavar="FIELD", help="uniform:DEGREES, radial, sine, ring, or a file of vectors.")
    ] = None,
    method: options.Method = None,
    search: options.Search = None,
    preset: options.Preset = None,
    order: options.Order = None,
    window: options.Window = None,
    pitch: options.Pitch = None,
    passes: options.Passes = None,
    threshold: options.Threshold = None,
    difference: options.Difference = None,
    analysis: options.AnalysisFile = None,
    mask: options.Mask = None,
    seed: options.Seed = 0,
    sources: options.SourcesOut = None,
    report: options.Report = None,
    directx_normals: options.DirectX = False,
    device: options.Device = "cpu",
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Grow an image of any size from samples used together; a stack of maps comes out aligned."""
    rows, columns = options.parse_size(size)
    refining = {"order": order, "window": window, "pitch": pitch, "passes": passes}
    refining |= {"threshold": threshold, "difference": difference}
    wanted = methods.wish(method, search, preset, **refining)
    options.check_mask(mask, samples)
    check_analysis(analysis, preset)
    options.check_report(report)
    options.check_output(output, sources, report, analysis)

    with Session(device=device, threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.cli.planes import plane
            from texloom.cli.reapply import image_domain
            from texloom.cli.samples import read_samples, tell_dropped
            from texloom.output.gather import gather_images
            from texloom.output.image import single_map, write_images
            from texloom.output.sources_file import SavedSources, save_sources
            from texloom.output.tiling import begin_at, quiet_start
            from texloom.synthesis.synthesize import synthesize

            joined = read_samples(samples, mask=mask, directx_normals=directx_normals)
            exemplar = joined.exemplar
            domain = plane(rows, columns, field=field, tileable=tileable)
            if options.is_file(output):
                single_map(exemplar.maps, output)
            chosen = wanted.build()
        if analysis is not None:
            chosen = with_analysis(chosen, analysis, exemplar, session)
        result = synthesize(exemplar, domain, chosen, seed=seed, report=session.report)
        session.add(result.seconds)
        settings = options.settings(
            "image", *samples, method=chosen, seed=seed, size=size, tileable=tileable, field=field, mask=mask
        )
        with session.stage("write"):
            grown = domain.in_image_axes(result.sources)
            maps = gather_images(grown, exemplar, rows=rows, columns=columns)
            if tileable:
                maps, grown = begin_at(quiet_start(maps.values()), maps, grown)
            session.wrote(write_images(output, maps, settings=settings))
            if sources is not None:
                kept = SavedSources(grown, image_domain(rows, columns, exemplar), settings)
                session.wrote(save_sources(sources, kept))
        if report is not None:
            with session.stage("report"):
                from texloom.cli.reports import Run, of_image
                from texloom.output.report import write_report

                run = Run(exemplar, result, settings, dict(session.seconds), options.command_line(context))
                session.wrote(write_report(report, of_image(run, domain, maps)))
        tell_dropped(joined)
        session.finish(
            {
                "method": wanted.method,
                "preset": preset,
                "seed": seed,
                "size": (columns, rows),
                "maps": list(maps),
                "dropped": list(joined.dropped),
                "patches": result.patches,
                "energy": list(result.energy),
                "curves": {name: list(values) for name, values in result.curves.items()},
                "stopped": result.stopped,
            }
        )
