import numpy as np
import pytest

from tests.sketch.drawn import voronoi
from texloom.demo import draw
from texloom.exemplar.exemplar import Map
from texloom.output.gather import gather_points, gather_sites, identity_sources
from texloom.sketch.design import Design
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.mesh.tiling import on_plane
from texloom.sketch.random import random_cells
from texloom.sketch.sample import SketchSample
from texloom.sketch.surface import Designed, composed
from texloom.sources import SourceMap

ROWS, COLUMNS = 40, 50


def ramp(rows: int, columns: int) -> Map:
    """A map that is linear in both axes: bilinear reads of it are exact."""
    row, column = np.mgrid[:rows, :columns] / 200.0
    return Map(np.stack([row, column, 0.3 + row - 2 * column], axis=-1).astype(np.float32), "data", 32)


def strewn(count: int, low: float, high: float, *, sources: int = 1, seed: int = 0) -> SourceMap:
    random = np.random.default_rng(seed)
    position = random.uniform(low, high, (count, sources, 2))
    weight = random.uniform(0.1, 1, (count, sources))
    turn, scale = random.uniform(-3, 3, (count, sources)), random.uniform(0.5, 2, (count, sources))
    weight /= weight.sum(axis=1, keepdims=True)
    return SourceMap(*(values.astype(np.float32) for values in (position, weight, turn, scale)))


def similar(turn: float, scale: float) -> SourceMap:
    """All of a texture as one similar copy of the sample."""
    row, column = (
        values.ravel() - side / 2 for values, side in zip(np.mgrid[:ROWS, :COLUMNS], (ROWS, COLUMNS), strict=True)
    )
    place = [row * np.cos(turn) + column * np.sin(turn), column * np.cos(turn) - row * np.sin(turn)]
    position = (60 + np.stack(place, axis=-1) / scale).reshape(-1, 1, 2).astype(np.float32)
    ones = np.ones((len(position), 1), np.float32)
    return SourceMap(position, ones, ones * np.float32(turn), ones * np.float32(scale))


def points_of(sources: SourceMap, map: Map, offset: np.ndarray) -> np.ndarray:
    """What the sources show beside their sites."""
    number = np.arange(sources.count)[:, None].repeat(3, 1)
    alone = np.eye(3)[[0] * sources.count]
    return gather_points(sources, map, number, barycentric=alone, offsets=offset[:, None].repeat(3, 1))


def test_composed_sources_show_what_the_designed_texture_shows_there() -> None:
    inner, map = similar(0.7, 1.3), ramp(120, 120)
    middle = Map(gather_sites(inner, map).reshape(ROWS, COLUMNS, 3), "data", 32)
    outer = strewn(300, 8, 30, sources=3)
    sources = composed(outer, inner, (ROWS, COLUMNS))
    np.testing.assert_allclose(gather_sites(sources, map), gather_sites(outer, middle), atol=1e-5)
    offset = np.random.default_rng(2).uniform(-1, 1, (300, 2))
    np.testing.assert_allclose(points_of(sources, map, offset), points_of(outer, middle, offset), atol=1e-5)


def test_at_whole_texels_it_is_the_texels_own_source() -> None:
    inner = strewn(ROWS * COLUMNS, 0, 90)
    sources = composed(identity_sources(ROWS, COLUMNS), inner, (ROWS, COLUMNS))
    np.testing.assert_array_equal(sources.position, inner.position)
    np.testing.assert_array_equal(sources.turn, inner.turn)
    np.testing.assert_array_equal(sources.scale, inner.scale)


def test_sources_beyond_the_texture_continue_its_border() -> None:
    inner = similar(0.2, 1.0)
    outer = SourceMap(np.array([[[-0.4, 3.0]], [[ROWS - 0.6, 60.0]]], np.float32), np.ones((2, 1), np.float32))
    sources = composed(outer, inner, (ROWS, COLUMNS))
    np.testing.assert_allclose(sources.position, composed(outer, similar(0.2, 1.0), (ROWS, COLUMNS)).position)
    for n, texel in enumerate([3, ROWS * COLUMNS - 1]):
        away = outer.position[n, 0] - np.divmod(texel, COLUMNS)
        turned = away @ np.array([[np.cos(0.2), -np.sin(0.2)], [np.sin(0.2), np.cos(0.2)]])
        np.testing.assert_allclose(sources.position[n, 0], inner.position[texel, 0] + turned, atol=1e-4)


@pytest.fixture(scope="module")
def designed() -> tuple[Designed, SketchSample]:
    sample = SketchSample.of(
        [draw("scales", size=64)], [on_plane(random_cells((64.0, 64.0), cell=16.0, seed=1), (64, 64), 32.0)]
    )
    design = Design(sketch=voronoi(30, seed=1), sample=sample, mesh=TextureMesh(size=(ROWS, COLUMNS), scale=0.5))
    return Designed.of(design), sample


def test_a_designed_texture_has_all_maps_and_leads_back(designed: tuple[Designed, SketchSample]) -> None:
    texture, sample = designed
    assert list(texture.exemplar.maps) == list(sample.exemplar.maps) and texture.exemplar.shape == (ROWS, COLUMNS)
    sources = texture.in_samples(identity_sources(ROWS, COLUMNS))
    for name, map in sample.exemplar.maps.items():
        values = gather_sites(sources, map).reshape(ROWS, COLUMNS, -1)
        np.testing.assert_allclose(values, texture.exemplar.maps[name].image, atol=1e-6)


def test_between_texels_colours_agree_to_interpolation(designed: tuple[Designed, SketchSample]) -> None:
    """Within the range of the four texels around, a little widened: what lies between may be anything of them."""
    texture, sample = designed
    outer = strewn(500, 2, ROWS - 3, seed=4)
    sources = texture.in_samples(outer)
    ours = gather_sites(sources, sample.exemplar.lead)
    theirs = gather_sites(outer, texture.exemplar.lead)
    spread = np.abs(np.diff(texture.exemplar.lead.image, axis=0)).mean()
    assert np.abs(ours - theirs).mean() < 1.5 * spread
    far = texture.in_samples(SourceMap(outer.position[::-1], outer.weight))
    assert np.abs(gather_sites(far, sample.exemplar.lead) - theirs).mean() > 3 * np.abs(ours - theirs).mean()
