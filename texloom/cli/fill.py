"""``texloom fill``: holes in a picture, or in a stack of maps, filled with more of it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from texloom.cli import methods, options
from texloom.cli.session import Session

if TYPE_CHECKING:
    import numpy as np

    from texloom.exemplar.exemplar import Exemplar
    from texloom.synthesis.fill import Filled


def fill(
    context: typer.Context,
    picture: Annotated[
        Path, typer.Argument(metavar="IMAGE", help="A picture, or a folder of maps (basecolor.png, normal.png, ...).")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="An image, or a folder for a stack of maps.")],
    mask: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="An image, white where to fill; if not given, what is transparent."),
    ] = None,
    sample: Annotated[
        Path | None, typer.Option(metavar="SAMPLE", help="What to fill with, an image or a folder; else the picture.")
    ] = None,
    tileable: Annotated[
        bool, typer.Option("--tileable", help="The picture is a tile: fill across its borders.")
    ] = False,
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
    """Fill holes in a picture so that they cannot be told; what surrounds them stays, bit by bit."""
    wanted = methods.wish(method, None, preset)
    options.check_report(report)
    options.check_output(output, sources, report)

    with Session(device=device, threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.cli.reapply import image_domain
            from texloom.domain.grid import Grid
            from texloom.io.stack import read_exemplar
            from texloom.output.filled import filled_maps
            from texloom.output.image import single_map, write_images
            from texloom.output.sources_file import SavedSources, save_sources
            from texloom.synthesis import fill as filling

            chosen = wanted.grower("fill")
            known, hole = _read(picture, mask, directx_normals=directx_normals)
            other = None if sample is None else read_exemplar(sample, directx_normals=directx_normals)
            if options.is_file(output):
                single_map(known.maps, output)
        filled = filling.fill(known, hole, sample=other, method=chosen, wrap=tileable, seed=seed, report=session.report)
        result, (rows, columns) = filled.result, known.shape
        session.add(result.seconds)
        samples = [picture] if sample is None else [picture, sample]
        settings = options.settings("fill", *samples, method=chosen, mask=mask, seed=seed, tileable=tileable)
        with session.stage("write"):
            maps = filled_maps(filled)
            session.wrote(write_images(output, maps, settings=settings))
            if sources is not None:
                kept = SavedSources(result.sources, image_domain(rows, columns, filled.exemplar), settings)
                session.wrote(save_sources(sources, kept))
        if report is not None:
            with session.stage("report"):
                from texloom.cli.reports import Run, of_image
                from texloom.output.report import write_report

                shown = filled.exemplar if hole.all() or sample is not None else filled.exemplar.with_mask(~hole)
                run = Run(shown, result, settings, dict(session.seconds), options.command_line(context))
                session.wrote(write_report(report, of_image(run, Grid(rows, columns, wrap=tileable), maps)))
        session.finish(
            {
                "method": wanted.method,
                "preset": preset,
                "seed": seed,
                "size": (columns, rows),
                "maps": list(maps),
                "filled": int(hole.sum()),
                "border": _border(filled),
                "patches": result.patches,
                "energy": list(result.energy),
                "curves": {name: list(values) for name, values in result.curves.items()},
                "stopped": result.stopped,
            }
        )


def _read(path: Path, mask: Path | None, *, directx_normals: bool) -> "tuple[Exemplar, np.ndarray]":
    """The picture and its hole. Without a mask what is transparent is filled, and the picture gets opaque."""
    import numpy as np

    from texloom.errors import ParameterError
    from texloom.exemplar.exemplar import Exemplar
    from texloom.io.stack import read_exemplar, read_mask

    picture = read_exemplar(path, directx_normals=directx_normals)
    used = picture.mask
    if used is not None:
        # Read as it is: a folder's mask tells what to imitate, but what lies outside stays too.
        picture = read_exemplar(path, mask=np.ones(picture.shape, bool), directx_normals=directx_normals)
    if mask is not None:
        return (picture if used is None else picture.with_mask(used)), read_mask(mask)
    if used is None and "alpha" not in picture.maps:
        raise ParameterError(f"{path.name} has no transparent part: give --mask, an image that is white where to fill")
    hole = np.zeros(picture.shape, bool) if used is None else ~used
    if "alpha" in picture.maps:
        hole |= _transparent(picture.maps["alpha"].image[..., 0])
    return Exemplar({name: map for name, map in picture.maps.items() if name != "alpha"}), hole


def _transparent(alpha: "np.ndarray") -> "np.ndarray":
    """What is not opaque, and what lies beside a soft rim: it is often tinged with the colour of what was cut out."""
    import numpy as np
    from scipy.ndimage import binary_dilation

    return (alpha < 1) | np.asarray(binary_dilation((alpha > 0) & (alpha < 1), iterations=2), bool)


def _border(filled: "Filled") -> float | None:
    """How visible the hole's border is in the first map: about 1 if it cannot be told."""
    import math

    from texloom.metrics.border import border_step
    from texloom.output.filled import filled_maps
    from texloom.output.image import stored

    lead = next(iter(filled_maps(filled).values()))
    step = border_step(stored(lead, min(lead.bits, 16)), filled.hole)
    return None if math.isnan(step) else step
