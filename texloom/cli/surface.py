"""``texloom surface``: texture over meshes, along a field, back on the user's own."""

from pathlib import Path
from typing import Annotated

import typer

from texloom.cli import methods, options
from texloom.cli.analyses import check_analysis
from texloom.cli.fuse import BELTS, Belts, Palette
from texloom.cli.meshes import Meshes, over_meshes
from texloom.cli.session import Session
from texloom.cli.surface_wish import CellsWish, Fusion, Guides, QuiltWish, SurfaceWish
from texloom.errors import ParameterError

HOMES = {"vertex": (".glb", ".ply"), "atlas": (".glb", ".obj"), "sample-uv": (".glb", ".obj")}


def surface(
    context: typer.Context,
    mesh: Annotated[
        Path, typer.Argument(metavar="MESH", help="OBJ, PLY, OFF, STL, GLB or glTF; or a folder, or a .txt of many.")
    ],
    samples: options.Samples,
    output: Annotated[Path, typer.Option("--output", "-o", help="A .glb, .obj or .ply; for many meshes a folder.")],
    fuse: Annotated[
        str | None,
        typer.Option(metavar="MAP", help="Where each sample goes: a mesh with colours, vertex, or a painted texture."),
    ] = None,
    palette: Palette = None,
    belts: Belts = None,
    sketch: options.Sketches = None,
    sample_sketch: options.SampleSketch = None,
    radius: options.Radius = None,
    repeats: Annotated[
        float | None,
        typer.Option(metavar="R", help="Sample widths across the longest side; 3, or what a million texels hold."),
    ] = None,
    texel: Annotated[
        float | None, typer.Option(metavar="SIZE", help="A texel's length in world units instead.")
    ] = None,
    direction: Annotated[
        str, typer.Option(metavar="FIELD", help="smooth, curvature, x,y,z, a file of arrows, rbf:FILE or spread:FILE.")
    ] = "smooth",
    scale: Annotated[Path | None, typer.Option(metavar="FILE", help="Arrows or an array: larger, smaller.")] = None,
    symmetry: Annotated[int, typer.Option(metavar="N", help="1, 2, 4 or 6 directions at a point.")] = 1,
    progressive: Annotated[
        bool, typer.Option("--progressive/--uniform", help="Follow the scales given, or lay all at one size.")
    ] = True,
    home: Annotated[
        str | None,
        typer.Option("--as", metavar="HOME", help="vertex (colours), atlas or sample-uv; by -o if not given."),
    ] = None,
    atlas_size: Annotated[
        int | None, typer.Option(metavar="N", min=16, max=16_384, help="Texels a side; by the texture if not given.")
    ] = None,
    gutter: Annotated[int, typer.Option(metavar="N", min=0, max=256, help="Texels painted around charts.")] = 8,
    fresh_atlas: Annotated[bool, typer.Option("--fresh-atlas", help="New UVs, whatever the mesh has.")] = False,
    material: Annotated[str | None, typer.Option(metavar="NAME", help="Texture only this material.")] = None,
    preview: Annotated[Path | None, typer.Option(metavar="FILE", help="A picture from four sides (.png).")] = None,
    method: options.SurfaceMethod = None,
    search: options.SurfaceSearch = None,
    preset: options.SurfacePreset = None,
    levels: options.Levels = None,
    start: options.Start = None,
    shape: options.Shape = None,
    order: options.SweepOrder = None,
    window: options.SweepWidth = None,
    passes: options.SweepPasses = None,
    patch: Annotated[
        float | None,
        typer.Option(metavar="N", min=0, help="With texton: texels across a patch of faces; 0 leaves each alone."),
    ] = None,
    rounds: Annotated[int | None, typer.Option(metavar="N", min=0, help="With texton: choices made anew.")] = None,
    blend: Annotated[
        float | None,
        typer.Option(metavar="PHI", min=0, help="With texton: edges that show more are blended; inf blends none."),
    ] = None,
    distance: Annotated[
        float | None, typer.Option(metavar="D", help="With texton: from the viewer, world units; the whole mesh shows.")
    ] = None,
    edges: Annotated[
        Path | None, typer.Option(metavar="FILE", help="With texton: a picture of the edges that do not fit (.png).")
    ] = None,
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
    quilting = QuiltWish(patch, rounds, blend, distance, published=preset == "texton")
    sweeping = {"levels": levels, "start": start, "shape": shape, "order": order, "window": window, "passes": passes}
    quilts = preset == "texton" or (method == "texton" and preset is None)
    if quilts:
        quilting.check(
            method, search=search, fuse=fuse, sketch=", ".join(sketch or []) or None, analysis=analysis, **sweeping
        )
    else:
        quilting.refuse(edges, samples)
    if repeats is not None and texel is not None:
        raise ParameterError("--repeats and --texel both set the size of the texture: give one of them")
    meshes = Meshes.of(mesh, output)
    meshes.check(preview, sources, report, edges)
    wanted = SurfaceWish(
        meshes=meshes,
        material=material,
        samples=samples,
        mask=mask,
        directx_normals=directx_normals,
        repeats=repeats,
        texel=texel,
        guides=Guides(direction, scale, symmetry, progressive),
        cells=CellsWish(sketch or [], sample_sketch or [], radius),
        fusion=Fusion(fuse, palette, options.choose("belts", belts or BELTS[0], BELTS)),
        method=None if quilts else methods.wish(method, search, preset, surface=True, **sweeping),
        quilting=quilting if quilts else None,
        preset=preset,
        analysis=analysis,
        seed=seed,
        home=_home(home, meshes, "sample-uv" if quilts else "atlas"),
        atlas=(atlas_size, gutter, fresh_atlas),
        preview=preview,
        sources=sources,
        report=report,
        edges=edges,
        command=options.command_line(context),
    )
    options.check_mask(mask, samples)
    wanted.cells.check(samples)
    _check_fusion(fuse, palette, preset)
    if fuse is not None and method == "sweep":
        raise ParameterError("--method sweep grows whole textures and cannot continue one: choose another for --fuse")
    if fuse is not None and sketch:
        raise ParameterError(
            f"--fuse and --sketch {sketch[0]} exclude each other: one says where samples go, one cells"
        )
    if not quilts:
        check_analysis(analysis, preset)
    options.check_report(report)
    _check_pictures(preview=preview, edges=edges)
    options.check_output(meshes.output, preview, sources, report, analysis, edges)

    with Session(device=device, threads=threads, as_json=as_json) as session:
        if quilts:
            from texloom.cli.quilting import quilt as texture
            from texloom.kernels.launch import thread_count

            failed = over_meshes(meshes, texture(wanted, session), session, at_once=thread_count())
        else:
            from texloom.cli.growing import grow as texture

            failed = over_meshes(meshes, texture(wanted, session), session)
    if failed:
        raise typer.Exit(2)


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


def _check_pictures(**pictures: Path | None) -> None:
    """Raises: ParameterError, for a picture of a kind that is not written."""
    for name, path in pictures.items():
        if path is not None and path.suffix.lower() not in options.IMAGE_SUFFIXES:
            raise ParameterError(f"--{name} {path.name}: a picture, name it .png")


def _home(home: str | None, meshes: Meshes, usual: str) -> str:
    """The home asked for, or that of the suffix; checked against the suffix of the output."""
    suffix = meshes.suffix
    chosen = options.choose("home", home or ("vertex" if suffix == ".ply" else usual), tuple(HOMES))
    if suffix not in HOMES[chosen]:
        raise ParameterError(f"{meshes.output.name}: --as {chosen} is written as {' or '.join(HOMES[chosen])}")
    if chosen == "sample-uv" and usual != "sample-uv":
        raise ParameterError("--as sample-uv is for --method texton: other methods show several places in one face")
    return chosen
