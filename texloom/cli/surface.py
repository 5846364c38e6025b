"""``texloom surface``: texture over a mesh, along a field, back on the user's own mesh."""

from pathlib import Path
from typing import Annotated, cast

import typer

from texloom.cli import methods, options
from texloom.cli.analyses import check_analysis, with_analysis
from texloom.cli.fuse import BELTS, Belts, Palette
from texloom.cli.session import Session
from texloom.errors import ParameterError

HOMES = ("vertex", "atlas")
_REPEATS = 3.0  # sample widths across the mesh where neither --repeats nor --texel is given,
_MOST_TEXELS = 1.2e6  # or fewer of a large sample, so that it takes seconds and an atlas of 2048² holds it


def surface(
    context: typer.Context,
    mesh: Annotated[Path, typer.Argument(metavar="MESH", help="OBJ, PLY, OFF, STL, GLB or glTF.")],
    samples: options.Samples,
    output: Annotated[Path, typer.Option("--output", "-o", help="A .glb, .obj or .ply.")],
    fuse: Annotated[
        str | None,
        typer.Option(metavar="MAP", help="Where each sample goes: a mesh with colours, vertex, or a painted texture."),
    ] = None,
    palette: Palette = None,
    belts: Belts = None,
    repeats: Annotated[
        float | None,
        typer.Option(metavar="R", help="Sample widths across the longest side; 3, or what a million texels hold."),
    ] = None,
    texel: Annotated[
        float | None, typer.Option(metavar="SIZE", help="A texel's length in world units instead.")
    ] = None,
    direction: Annotated[
        str, typer.Option(metavar="FIELD", help="smooth, curvature, x,y,z, a file of arrows, or rbf:FILE.")
    ] = "smooth",
    scale: Annotated[Path | None, typer.Option(metavar="FILE", help="Arrows or an array: larger, smaller.")] = None,
    symmetry: Annotated[int, typer.Option(metavar="N", help="1, 2, 4 or 6 directions at a point.")] = 1,
    progressive: Annotated[
        bool, typer.Option("--progressive/--uniform", help="Follow the scales given, or lay all at one size.")
    ] = True,
    home: Annotated[
        str | None, typer.Option("--as", metavar="HOME", help="vertex (colours) or atlas; by -o if not given.")
    ] = None,
    atlas_size: Annotated[
        int | None, typer.Option(metavar="N", min=16, max=16_384, help="Texels a side; by the texture if not given.")
    ] = None,
    gutter: Annotated[int, typer.Option(metavar="N", min=0, max=256, help="Texels painted around charts.")] = 8,
    fresh_atlas: Annotated[bool, typer.Option("--fresh-atlas", help="New UVs, whatever the mesh has.")] = False,
    material: Annotated[str | None, typer.Option(metavar="NAME", help="Texture only this material.")] = None,
    preview: Annotated[Path | None, typer.Option(metavar="FILE", help="A picture from four sides (.png).")] = None,
    method: options.Method = None,
    search: options.Search = None,
    preset: options.Preset = None,
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
    """Grow texture over a mesh of any shape, along a direction and a scale field; several samples where a map says."""
    chosen_home = _home(home, output)
    wanted = methods.wish(method, search, preset)
    options.check_mask(mask, samples)
    _check_fusion(fuse, palette, preset)
    belts = options.choose("belts", belts or BELTS[0], BELTS)
    if repeats is not None and texel is not None:
        raise ParameterError("--repeats and --texel both set the size of the texture: give one of them")
    check_analysis(analysis, preset)
    options.check_report(report)
    options.check_output(output, preview, sources, report, analysis)

    with Session(device=device, threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.cli import bring_home, fusing
            from texloom.cli.fields import direction_field, scale_field
            from texloom.cli.reapply import surface_domain
            from texloom.cli.samples import read_each, tell_dropped
            from texloom.domain.surface import Surface, texel_for_repeats
            from texloom.exemplar.join import join
            from texloom.fusion import fuse as fusion
            from texloom.io.mesh import read_mesh
            from texloom.output.sources_file import SavedSources, save_sources
            from texloom.synthesis.synthesize import synthesize

            stacks = read_each(samples, mask=mask, directx_normals=directx_normals)
            joined = join(stacks)
            colours = fusing.parse_palette(palette)
            model = read_mesh(mesh, material=material)
        with session.stage("field"):
            field = direction_field(model, direction, order=symmetry)
            sizes = scale_field(model, scale, direction) if progressive else None
        with session.stage("sites"):
            length = texel or texel_for_repeats(model.mesh, repeats or _REPEATS, stacks[0].shape[1])
            if texel is None and repeats is None:
                length = max(length, (float(model.mesh.face_areas.sum()) / _MOST_TEXELS) ** 0.5)
            domain = Surface.build(model.mesh, field, texel=length, scale=sizes)
            chosen = wanted.build()
        assigned = {}
        if fuse is not None:
            with session.stage("map"):
                wish = fusing.of_surface(fuse, model, domain, len(stacks), palette=colours)
            fused = fusion.fuse(
                stacks,
                wish.labels,
                domain,
                method=wanted.grower("fuse"),
                belts=cast(fusion.Filling, belts),
                seed=seed,
                report=session.report,
            )
            joined, result = fused.joined, fused.result
            assigned = {"samples": wish.told(samples, fused.labels)}
        else:
            if analysis is not None:
                chosen = with_analysis(chosen, analysis, joined.exemplar, session)
            result = synthesize(joined.exemplar, domain, chosen, seed=seed, report=session.report)
        exemplar = joined.exemplar
        session.add(result.seconds)
        settings = options.settings(
            "surface",
            *samples,
            method=chosen,
            seed=seed,
            mesh=mesh.name,
            texel=length,
            direction=direction,
            scale=scale,
            symmetry=symmetry,
            mask=mask,
            fuse=None if fuse is None else Path(fuse).name,
            belts=None if fuse is None else belts,
        )
        grown = bring_home.Grown(model, domain, result.sources, exemplar)
        with session.stage("write"):
            homecoming = bring_home.bring_home(
                grown,
                output,
                home=chosen_home,
                atlas=bring_home.AtlasWish(atlas_size, gutter, fresh_atlas),
                settings=settings,
            )
            session.wrote(homecoming.files)
            if preview is not None:
                session.wrote(bring_home.write_preview(preview, grown, homecoming.skin))
            if sources is not None:
                kept = surface_domain(domain, homecoming.atlas, exemplar)
                session.wrote(save_sources(sources, SavedSources(result.sources, kept, settings)))
        if report is not None:
            with session.stage("report"):
                from texloom.cli.reports import Run, of_surface
                from texloom.output.report import write_report

                run = Run(exemplar, result, settings, dict(session.seconds), options.command_line(context))
                session.wrote(write_report(report, of_surface(run, grown, homecoming.skin)))
        tell_dropped(joined)
        session.finish(
            {
                "method": wanted.method,
                "preset": preset,
                "seed": seed,
                "sites": domain.count,
                "texel": length,
                **assigned,
                "maps": list(exemplar.maps),
                "dropped": list(joined.dropped),
                "patches": result.patches,
                "energy": list(result.energy),
                "stopped": result.stopped,
                "as": chosen_home,
                "uv": homecoming.uv,
                "mends": list(model.mends),
            }
        )


def _check_fusion(fuse: str | None, palette: str | None, preset: str | None) -> None:
    """Raises: ParameterError, for options that do not go together."""
    if fuse is None and palette is not None:
        raise ParameterError(f"--palette {palette} names the colours of a map: add --fuse MAP")
    if preset == "refine":
        raise ParameterError(
            "--preset refine goes line by line, which a mesh has none of: give --method refine instead"
        )
    if fuse is not None and preset is not None:
        raise ParameterError(f"--fuse and --preset {preset} exclude each other: that paper's methods take one sample")


def _home(home: str | None, output: Path) -> str:
    """Vertex colours or an atlas; checked against the suffix of the output."""
    suffixes = {"vertex": (".glb", ".ply"), "atlas": (".glb", ".obj")}
    chosen = options.choose("home", home or ("vertex" if output.suffix.lower() == ".ply" else "atlas"), HOMES)
    if output.suffix.lower() not in suffixes[chosen]:
        raise ParameterError(f"{output.name}: --as {chosen} is written as {' or '.join(suffixes[chosen])}")
    return chosen
