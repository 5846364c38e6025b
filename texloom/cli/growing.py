"""Texture grown over a mesh texel by texel: what ``texloom surface`` does for the methods that work on sites."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from texloom.cli import bring_home, fusing, options
from texloom.cli.analyses import with_analysis
from texloom.cli.fields import read_guided, texel_length
from texloom.cli.meshes import Texture
from texloom.cli.reapply import surface_domain
from texloom.cli.samples import read_each, tell_dropped
from texloom.cli.session import Session
from texloom.cli.surface_wish import SurfaceWish
from texloom.domain.surface import Surface
from texloom.exemplar.join import join
from texloom.fusion import fuse as fusion
from texloom.output.sources_file import SavedSources, save_sources
from texloom.synthesis.synthesize import synthesize


def grow(wish: SurfaceWish, session: Session) -> Texture:
    """Read the samples; then what textures one mesh after the other."""
    assert wish.method is not None
    with session.stage("read"):
        stacks = read_each(wish.samples, mask=wish.mask, directx_normals=wish.directx_normals)
        joined = join(stacks)
        colours = fusing.parse_palette(wish.fusion.palette)
        chosen = wish.method.build()
    learnt, drawn, mended = joined.exemplar, None, []
    if wish.cells.sketches:
        with session.stage("design"):
            from texloom.cli.sketches import designed

            laid = {"drawings": wish.cells.drawings, "radius": wish.cells.radius}
            drawn, mended = designed(wish.cells.sketches, stacks, wish.samples, **laid, seed=wish.seed)
            learnt = drawn.exemplar
    if wish.analysis is not None and wish.fusion.map is None:
        chosen = with_analysis(chosen, wish.analysis, learnt, session)
    tell_dropped(joined)
    guides, method = wish.guides, wish.method

    def texture(mesh: Path, output: Path) -> Mapping[str, Any]:
        model, field, sizes = read_guided(mesh, wish, session)
        with session.stage("sites"):
            length = texel_length(model.mesh, stacks[0].shape[1], texel=wish.texel, repeats=wish.repeats, few=True)
            domain = Surface.build(model.mesh, field, texel=length, scale=sizes)
        assigned, shown, belts = {}, joined, None
        if wish.fusion.map is not None:
            belts = wish.fusion.belts
            with session.stage("map"):
                where = fusing.of_surface(wish.fusion.map, model, domain, len(stacks), palette=colours)
            fused = fusion.fuse(
                stacks,
                where.labels,
                domain,
                method=method.grower("fuse"),
                belts=cast(fusion.Filling, belts),
                seed=wish.seed,
                report=session.report,
            )
            shown, result = fused.joined, fused.result
            assigned = {"samples": where.told(wish.samples, fused.labels)}
        else:
            result = synthesize(learnt, domain, chosen, seed=wish.seed, report=session.report)
            if drawn is not None:
                result = replace(result, sources=drawn.in_samples(result.sources))
        session.add(result.seconds)
        settings = options.settings(
            "surface",
            *wish.samples,
            method=chosen,
            seed=wish.seed,
            mesh=mesh.name,
            texel=length,
            direction=guides.direction,
            scale=guides.scale,
            symmetry=guides.symmetry,
            mask=wish.mask,
            sketch=", ".join(Path(word).name for word in wish.cells.sketches) or None,
            sample_sketch=", ".join(path.name for path in wish.cells.drawings) or None,
            radius=wish.cells.radius,
            fuse=None if wish.fusion.map is None else Path(wish.fusion.map).name,
            belts=belts,
        )
        grown = bring_home.Grown(model, domain, result.sources, shown.exemplar)
        with session.stage("write"):
            homecoming = bring_home.bring_home(
                grown, output, home=wish.home, atlas=bring_home.AtlasWish(*wish.atlas), settings=settings
            )
            session.wrote(homecoming.files)
            if wish.preview is not None:
                session.wrote(bring_home.write_preview(wish.preview, grown, homecoming.skin))
            if wish.sources is not None:
                kept = surface_domain(domain, homecoming.atlas, shown.exemplar)
                session.wrote(save_sources(wish.sources, SavedSources(result.sources, kept, settings)))
        if wish.report is not None:
            with session.stage("report"):
                from texloom.cli.reports import Run, of_surface
                from texloom.output.report import write_report

                run = Run(shown.exemplar, result, settings, dict(session.seconds), wish.command)
                session.wrote(write_report(wish.report, of_surface(run, grown, homecoming.skin)))
        return {
            "method": method.method,
            "preset": wish.preset,
            "seed": wish.seed,
            "sites": domain.count,
            "texel": length,
            **assigned,
            "maps": list(shown.exemplar.maps),
            "dropped": list(joined.dropped),
            "patches": result.patches,
            "energy": list(result.energy),
            "stopped": result.stopped,
            "as": wish.home,
            "uv": homecoming.uv,
            "mends": [*mended, *model.mends],
        }

    return texture
