"""Textures designed by sketches, and drawings of their cells: what ``texloom sketch`` does."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from texloom.cli import options
from texloom.cli.reapply import image_domain
from texloom.cli.samples import read_each, tell_dropped
from texloom.cli.session import Session
from texloom.cli.sketch_wish import SketchWish
from texloom.cli.sketches import picture, read_cells, read_sketches, told_kinds
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import Exemplar, to_map
from texloom.exemplar.join import join
from texloom.output.gather import gather_images
from texloom.output.image import single_map, stored, write_images
from texloom.output.sketch_svg import write_sketch_svg
from texloom.output.sources_file import SavedSources, save_sources
from texloom.output.tiling import begin_at, quiet_start
from texloom.sketch.design import Design
from texloom.sketch.filling.warp import Initialization
from texloom.sketch.mesh.patch import Patch, Sketches
from texloom.sketch.mesh.shown import shown_curves
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.sample import SketchSample
from texloom.synthesis.result import Result
from texloom.systems import sketch as published


@dataclass(frozen=True, eq=False)
class Inputs:
    """What was read: sketches, the sample's cells (None: there is no sample), how large, and what was mended."""

    sketches: Sketches
    sample: SketchSample | None
    mesh: TextureMesh
    mends: list[str]


def draw(wish: SketchWish, session: Session) -> Mapping[str, Any]:
    """Write the texture mesh alone."""
    with session.stage("read"):
        stacks = read_each(wish.samples, mask=wish.mask, directx_normals=wish.directx_normals)
    inputs = _inputs(wish, stacks, session)
    with session.stage("mesh"):
        patch = inputs.mesh.patch(inputs.sketches, wish.seed)
        graph = inputs.mesh.refined(inputs.mesh.tiled(patch), wish.seed)
    with session.stage("write"):
        curves = shown_curves(graph)
        session.wrote(write_sketch_svg(wish.output, graph.size, curves, settings=_settings(wish, inputs)))
    return {**_told(wish, inputs, patch), "edges": len(curves)}


def design(wish: SketchWish, session: Session) -> Mapping[str, Any]:
    """Write the texture."""
    rows, columns = wish.size
    with session.stage("read"):
        stacks = read_each(wish.samples, mask=wish.mask, directx_normals=wish.directx_normals)
        pattern = None if wish.pattern is None else picture(wish.pattern)
        joined = join(stacks)
        if options.is_file(wish.output):
            single_map(joined.exemplar.maps, wish.output)
    inputs = _inputs(wish, stacks, session)
    assert inputs.sample is not None
    inside: Any = wish.inside or inputs.sample.inside
    made = _designed(wish, inputs, inside, pattern)
    for stage, last in {"mesh": "graph", "maps": "maps", "start": "start", "pixels": "canvas"}.items():
        with session.stage(stage):
            getattr(made, last)
    settings = _settings(wish, inputs) | {"inside": inside}
    with session.stage("write"):
        grown = made.sources
        maps = gather_images(grown, joined.exemplar, rows=rows, columns=columns)
        if wish.tileable:
            maps, grown = begin_at(quiet_start(maps.values()), maps, grown)
        session.wrote(write_images(wish.output, maps, settings=settings))
        if wish.sources is not None:
            kept = SavedSources(grown, image_domain(rows, columns, joined.exemplar), settings)
            session.wrote(save_sources(wish.sources, kept))
    if wish.report is not None:
        with session.stage("report"):
            from texloom.cli.reports import Run, of_image
            from texloom.output.report import Figure, write_report

            run = Run(joined.exemplar, Result(grown), settings, dict(session.seconds), wish.command)
            account = of_image(run, Grid(rows, columns, wrap=wish.tileable), maps)
            cells = {"The sample's": made.sample.maps, "The texture's": made.maps}
            drawn = [Figure(stored(to_map(m.closeness[..., None], "data"), 8), name) for name, m in cells.items()]
            figures = {**account.figures, "Lines between cells": drawn}
            session.wrote(write_report(wish.report, replace(account, figures=figures)))
    tell_dropped(joined)
    shown = np.unique(made.maps.cell[made.maps.cell >= 0])
    kinds = told_kinds(made.sample, made.kinds[shown], [path.name for path in wish.samples])
    return {
        **_told(wish, inputs, made.patch),
        "inside": inside,
        "cells": len(shown),
        "kinds": [] if pattern is None and len(kinds) == 1 else kinds,
        "maps": list(maps),
        "dropped": list(joined.dropped),
    }


def _inputs(wish: SketchWish, stacks: Sequence[Exemplar], session: Session) -> Inputs:
    """The cells of samples and sketches."""
    with session.stage("cells"):
        sample, mends = None, []
        if stacks:
            sample, mends = read_cells(stacks, wish.samples, drawings=wish.drawings, kinds=wish.kinds)
        cell = None if sample is None else sample.cell_size
        drawn = read_sketches(wish.sketches, size=wish.size, cell=cell, seed=wish.seed)
        wanted = {"scale": wish.scale, "radius": wish.radius, "tileable": wish.tileable}
        mesh = TextureMesh.of(drawn.graphs[0], wish.size, cell=cell, **wanted)
        return Inputs(drawn.graphs, sample, mesh, drawn.mends + mends)


def _designed(wish: SketchWish, inputs: Inputs, inside: Any, pattern: np.ndarray | None) -> Design:
    """Our design, or the paper's."""
    sample = inputs.sample
    assert sample is not None
    if wish.preset is not None:
        sketches, mesh, seed = inputs.sketches, inputs.mesh, wish.seed
        return published.design(sketches, sample, mesh, inside=inside, pattern=pattern, seed=seed)
    return Design(
        sketch=inputs.sketches,
        sample=sample,
        mesh=inputs.mesh,
        pattern=pattern,
        initialization=Initialization(inside=inside),
        seed=wish.seed,
    )


def _settings(wish: SketchWish, inputs: Inputs) -> dict[str, str]:
    """What is stored in what is written."""
    files = {"mask": wish.mask, "kinds": wish.kinds, "pattern": wish.pattern}
    return options.settings(
        "sketch",
        *wish.samples,
        sketch=", ".join(Path(word).name for word in wish.sketches),
        sample_sketch=", ".join(path.name for path in wish.drawings) or None,
        preset=wish.preset,
        seed=wish.seed,
        size=f"{wish.size[1]}x{wish.size[0]}",
        scale=inputs.mesh.scale,
        radius=inputs.mesh.radius,
        tileable=wish.tileable,
        **{name: None if path is None else path.name for name, path in files.items()},
    )


def _told(wish: SketchWish, inputs: Inputs, patch: Patch) -> dict[str, Any]:
    """What is told of every design."""
    return {
        "method": "sketch",
        "preset": wish.preset,
        "seed": wish.seed,
        "size": (wish.size[1], wish.size[0]),
        "sketch": Path(wish.sketches[patch.sketch]).name,
        "scale": inputs.mesh.scale,
        "radius": inputs.mesh.radius,
        "mirrored": patch.mirrored,
        "note": patch.note,
        "mends": inputs.mends,
    }
