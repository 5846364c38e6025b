"""Stages: a change makes anew what depends on it, to the bit; a moved vertex only what is around it."""

from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.ndimage import maximum_filter

from tests.sketch.drawn import voronoi
from tests.sketch.test_sample import GRAPH, picture, share_to_the_right, two_colours
from texloom.errors import ParameterError
from texloom.sketch.design import Design
from texloom.sketch.filling.kinds import Deal
from texloom.sketch.filling.maps import changed, feature_maps
from texloom.sketch.filling.pixels import PixelSynthesis
from texloom.sketch.filling.shapes import cell_shapes
from texloom.sketch.filling.warp import Initialization
from texloom.sketch.graph import straight
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.random import random_cells
from texloom.sketch.sample import SketchSample

STAGES = ("patch", "tiling", "graph", "cells", "maps", "shapes", "assignment", "guide", "start", "canvas")
MESH = TextureMesh(size=(60, 72), scale=1.2, radius=12.0)
FAR = 4 * 2  # texels that a pass carries: four parts of it, each half a neighbourhood
SAMPLE = SketchSample.of([picture(GRAPH)], [GRAPH], colours=two_colours((72, 64)))
OTHER = SketchSample.of([picture(GRAPH, hue=2, seed=1)], [GRAPH.resized((72.0, 64.0))])
LAST = {
    "sketch": "guide",
    "sample": "patch tiling graph cells maps shapes",
    "size": "patch guide",
    "scale": "patch guide",
    "tileable": "patch guide",
    "radius": "patch tiling guide",
    "iterations": "patch tiling guide",
    "strength": "patch tiling guide",
    "pattern": "patch tiling graph cells maps shapes guide",
    "deal": "patch tiling graph cells maps shapes guide",
    "initialization": "patch tiling graph cells maps shapes assignment guide",
    "pixels": "patch tiling graph cells maps shapes assignment start",
    "seed": "guide",
}
VALUES: dict[str, Any] = {
    "sketch": voronoi(14, 8, (50.0, 60.0)),
    "sample": OTHER,
    "size": MESH.size[::-1],
    "scale": 1.5,
    "tileable": True,
    "radius": 3.0,
    "iterations": 2,
    "strength": 0.2,
    "pattern": two_colours((30, 30), down=True),
    "deal": Deal(by="random"),
    "initialization": Initialization(lines="nearest"),
    "pixels": PixelSynthesis(passes=2, window=7, turned=False),
    "seed": 5,
}


@cache
def base() -> Design:
    """A design with every stage made."""
    sketch = random_cells((44.0, 52.0), cell=13, seed=2)
    return made(Design(sketch=sketch, sample=SAMPLE, mesh=MESH, pattern=two_colours((6, 7)), seed=1))


@cache
def torus() -> Design:
    """The same, larger, on a torus."""
    return made(base().changed(mesh=replace(MESH, size=(96, 100), tileable=True)))


def made(design: Design) -> Design:
    for stage in STAGES:
        getattr(design, stage)
    return design


def alike(one: Any, other: Any) -> bool:
    """The same to the bit, field by field."""
    if is_dataclass(one):
        return all(alike(getattr(one, field.name), getattr(other, field.name)) for field in fields(one))
    return np.array_equal(one, other)


def pushed(design: Design, cell: int, by: float) -> np.ndarray:
    """The vertices of a design with the first of a cell pushed towards the cell's middle, ``by`` of the way."""
    vertex = design.graph.edges.ravel()[design.cells.halfedge[design.cells.start[cell]]]
    vertices = design.graph.vertices.copy()
    gap = design.cells.centroid[cell] - vertices[vertex]
    size = np.array(design.graph.size)
    vertices[vertex] += by * (gap - np.rint(gap / size) * size * design.graph.wrap)
    return vertices


def inner(design: Design) -> int:
    """The cell of the middle texel."""
    rows, columns = design.maps.shape
    return int(design.maps.cell[rows // 2, columns // 2])


def rim(inside: np.ndarray, width: int, *, wrap: bool) -> np.ndarray:
    """Texels so near the border of a region, on either side."""
    size = (2 * width + 1, 2 * width + 1)
    mode = "wrap" if wrap else "nearest"
    near = [np.asarray(maximum_filter(side, size, mode=mode), bool) for side in (inside, ~inside)]
    return near[0] & near[1]


@pytest.mark.parametrize("name", VALUES)
def test_a_change_keeps_what_does_not_depend_on_it_and_is_as_made_afresh(name):
    value = {name: VALUES[name]}
    inputs = value if name in vars(base()) else {"mesh": replace(MESH, **value)}
    design = base().changed(**inputs)
    kept = {stage for stage in STAGES if stage in vars(design)}
    assert kept == set(LAST[name].split())
    assert all(vars(design)[stage] is vars(base())[stage] for stage in kept)
    fresh = replace(base(), **inputs)
    assert not set(STAGES) & set(vars(fresh))
    for stage in STAGES:
        assert alike(getattr(design, stage), getattr(fresh, stage)), stage
    assert not alike(design.canvas, base().canvas)


def test_an_equal_mesh_is_no_change():
    design = base().changed(mesh=replace(MESH))
    assert all(vars(design)[stage] is vars(base())[stage] for stage in STAGES)


@pytest.mark.parametrize("design", [base, torus])
@pytest.mark.parametrize("by", [0.0, 0.5])
def test_a_moved_vertex_is_as_all_made_anew(design, by):
    before = design()
    then = [np.copy(getattr(before.canvas, field.name)) for field in fields(before.canvas)]
    maps_then, start_then = np.copy(before.maps.away), np.copy(before.start.position)
    vertices = pushed(before, inner(before), by)
    after = before.moved(vertices)
    np.testing.assert_array_equal(after.graph.vertices, vertices)
    for field, value in zip(fields(before.canvas), then, strict=True):
        np.testing.assert_array_equal(getattr(before.canvas, field.name), value)
    np.testing.assert_array_equal(before.maps.away, maps_then)
    np.testing.assert_array_equal(before.start.position, start_then)

    maps = feature_maps(after.graph, after.cells, blur=before.maps.blur)
    shapes = cell_shapes(after.graph, after.cells)
    sample = SAMPLE.maps, SAMPLE.shapes
    laying = Initialization(inside=SAMPLE.inside)
    start = laying.run(sample, (maps, shapes), before.assignment, seed=before.seed)
    assert alike(after.maps, maps) and alike(after.start, start)
    canvas = before.pixels.run(before.guide, maps, start, before.kinds)
    inside = np.zeros(maps.shape, bool)
    inside[changed(before.maps, before.graph, after.graph, before.cells)] = True
    near_rim = rim(inside, before.pixels.passes * FAR, wrap=maps.wrap)
    for name in ("position", "turn", "colour"):
        old, new = (getattr(each.canvas, name).reshape(*maps.shape, -1) for each in (before, after))
        np.testing.assert_array_equal(old[~inside], new[~inside])
        whole = getattr(canvas, name).reshape(new.shape)
        np.testing.assert_array_equal(whole[~near_rim], new[~near_rim])
        assert (whole != new).any(axis=2).mean() < 0.05
    assert alike(after.canvas, before.canvas) == (by == 0)
    assert (0 if by else -1) < inside.mean() < 0.8


def test_a_moved_design_keeps_what_it_shows_and_changes_on():
    after = base().moved(pushed(base(), inner(base()), 0.4))
    assert after.assignment is base().assignment and after.guide is base().guide
    more = PixelSynthesis(passes=3)
    on = after.changed(pixels=more)
    assert on.graph is after.graph and on.start is after.start
    assert alike(on.canvas, more.run(on.guide, after.maps, after.start, after.kinds))


def test_a_cell_that_would_turn_over_is_one_error():
    with pytest.raises(ParameterError, match="would turn over"):
        base().moved(pushed(base(), inner(base()), 6.0))
    assert alike(base().canvas, made(replace(base())).canvas)


@pytest.mark.parametrize("by", ["alike", "random"])
def test_a_patterns_colours_choose_the_kinds(by):
    graphs = [GRAPH, voronoi(14, 5, (60.0, 60.0))]
    sample = SketchSample.of([picture(graph, hue=n) for n, graph in enumerate(graphs)], graphs)
    pattern = sample.kinds.palette[two_colours((6, 6))[..., 0].astype(int)]
    design = base().changed(sample=sample, pattern=pattern, deal=Deal(by=by))
    cell = design.maps.cell
    share = share_to_the_right(cell, len(design.cells))
    sure = np.abs(share - 0.5) > 0.1
    assert sure.sum() > 10
    np.testing.assert_array_equal(design.kinds[sure], share[sure] > 0.5)
    place = np.rint(design.canvas.position).astype(int)
    for number, part in enumerate(sample.exemplar.parts):
        corner = np.array((part.row, part.column))
        within = np.all((place >= corner) & (place < corner + (part.rows, part.columns)), axis=1)
        shown = (design.kinds[cell] == number) & (design.maps.away > design.maps.reach + 3)
        assert within.reshape(cell.shape)[shown].all()


def test_without_a_pattern_every_kind_is_shown():
    assert set(base().changed(pattern=None).kinds) == {0, 1}


def test_a_texture_without_cells_is_one_error():
    ring = np.array([[2.0, 2.0], [2.0, 8.0], [8.0, 8.0]])
    lone = straight((60.0, 60.0), ring, np.array([[0, 1], [1, 2]]), wrap=True)
    with pytest.raises(ParameterError, match="no piece of the sketch goes on as closed cells"):
        _ = base().changed(sketch=lone).cells


def test_only_texels_that_stay_keep_the_scale_of_the_start():
    sources = base().sources
    assert sources.scale is not None
    kept = (sources.position[:, 0] == base().start.position.reshape(-1, 2)).all(axis=1)
    assert 0.2 < kept.mean() < 1
    np.testing.assert_array_equal(sources.scale[kept, 0], base().start.scale.ravel()[kept])
    assert (sources.scale[~kept] == 1).all()


def test_edges_that_would_cross_are_refused():
    design, crossed = base(), 0
    draw = np.random.default_rng(1)
    for vertex in draw.choice(len(design.graph.vertices), 20, replace=False):
        vertices = design.graph.vertices.copy()
        vertices[vertex] += draw.normal(0, 9, 2)
        try:
            crossed += len(design.moved(vertices).graph.crossings()) > 0
        except ParameterError:
            continue
    assert crossed == 0


@pytest.mark.parametrize("shape", [(4, 4, 1), (4, 4, 4), (0, 4, 3)])
def test_a_pattern_of_another_shape_is_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ParameterError, match="a pattern is rows × columns × 3 colours"):
        base().changed(pattern=np.zeros(shape, np.float32))


def test_moves_of_other_vertices_are_refused() -> None:
    design = base()
    vertices = design.graph.vertices
    for wrong in (vertices[:-1], np.where(vertices > 9, np.nan, vertices)):
        with pytest.raises(ParameterError, match="places of 2 finite numbers"):
            design.moved(wrong)
