"""``texloom textons``: learn a sample's textons once, for any number of meshes."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from texloom.cli import options
from texloom.cli.library import SUFFIX, facts_of
from texloom.cli.session import Session
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.output.report import Account
    from texloom.search.textons import Textons

FEATURES = ("window", "filters")
_LARGE = 1024  # pixels, the longest side of a picture in the report


def textons(
    context: typer.Context,
    sample: options.Sample,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE.textons")],
    count: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Textons; the square root of the texels if not given.")
    ] = None,
    window: Annotated[int, typer.Option(metavar="N", help="Texels a side of the window, odd.")] = 11,
    features: Annotated[
        str, typer.Option(metavar="NAME", help="What is compared: window, or filters (48 a channel).")
    ] = FEATURES[0],
    orientations: Annotated[int, typer.Option(metavar="N", help="Turns of the sample that are labelled.")] = 16,
    mask: options.Mask = None,
    seed: options.Seed = 0,
    map: Annotated[Path | None, typer.Option(metavar="FILE", help="A picture of the texton map.")] = None,
    report: options.Report = None,
    directx_normals: options.DirectX = False,
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Learn a sample's textons and keep them, with the sample, in one file for texloom surface --method texton."""
    options.choose("features", features, FEATURES)
    if output.suffix.lower() != SUFFIX:
        raise ParameterError(f"--output {output.name}: textons are kept in one file, name it {SUFFIX}")
    if map is not None and map.suffix.lower() not in options.IMAGE_SUFFIXES:
        raise ParameterError(f"--map {map.name}: a picture, name it .png")
    options.check_report(report)
    options.check_output(output, map, report)

    with Session(threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.exemplar.exemplar import to_map
            from texloom.io.stack import read_exemplar
            from texloom.output.image import write_image
            from texloom.output.textons_file import read_entry, save_textons
            from texloom.output.textons_picture import texton_colours
            from texloom.search.textons import TextonSettings, learn_textons

            TextonSettings(count=count, width=window, features=features, orientations=orientations, seed=seed)
            exemplar = read_exemplar(sample, mask=mask, directx_normals=directx_normals)
        with session.stage("learn"):
            learnt = learn_textons(
                exemplar,
                count=count,
                width=window,
                features=features,
                orientations=orientations,
                seed=seed,
                report=session.report,
            )
        made = options.settings("textons", sample, mask=mask, directx_normals=directx_normals)
        with session.stage("write"):
            session.wrote(save_textons(output, learnt, made=made))
            if map is not None:
                session.wrote(write_image(map, to_map(texton_colours(learnt), "colour"), settings=made))
        facts = facts_of(read_entry(output))
        if report is not None:
            with session.stage("report"):
                from texloom.output.report import write_report

                session.wrote(write_report(report, _account(learnt, facts, session, options.command_line(context))))
        session.finish(facts)


def _account(learnt: "Textons", facts: dict[str, Any], session: Session, command: str) -> "Account":
    """The page: the sample, its texton map, what the textons look like."""
    from texloom.cli.reports import sample_figures
    from texloom.output.report import Account, Figure, fitted
    from texloom.output.textons_picture import texton_colours, texton_tiles

    rows, columns = learnt.exemplar.shape
    most = f"{learnt.count} textons, one colour each"
    return Account(
        title=f"Textons of {facts['made']['sample']}",
        subtitle=f"{columns}×{rows} texels, {learnt.count} textons, {learnt.settings.orientations} orientations",
        command=command,
        settings={name: str(value) for name, value in facts.items() if name not in ("made", "maps") and value},
        figures={
            "Sample": sample_figures(learnt.exemplar),
            "Texton map": [Figure(fitted(texton_colours(learnt), _LARGE), most)],
            "Textons": [Figure(fitted(texton_tiles(learnt), _LARGE), "Their mean windows, the commonest first")],
        },
        seconds=dict(session.seconds),
    )
