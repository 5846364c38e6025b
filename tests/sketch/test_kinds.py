"""Kinds follow colours; the deal is alike, even, and never the same side by side."""

import numpy as np
import pytest

from tests.sketch.drawn import voronoi
from texloom import draws
from texloom.errors import ExemplarError
from texloom.sketch.filling.kinds import Deal, kinds_of, neighbours, painted
from texloom.sketch.filling.maps import feature_maps
from texloom.sketch.filling.shapes import cell_shapes
from texloom.sketch.graph import straight
from texloom.sketch.random import random_cells

SAMPLE = voronoi(40, 4)
TEXTURE = random_cells((200.0, 260.0), cell=22, seed=3)
COLOURS = np.array([[0.9, 0.2, 0.1], [0.1, 0.7, 0.3], [0.2, 0.2, 0.9]], np.float32)


def shapes_of(graph):
    return cell_shapes(graph, graph.cells())


def deal(by="alike", kinds=None, usable=None, seed=5):
    beside = neighbours(TEXTURE, TEXTURE.cells())
    return Deal(by=by).run(shapes_of(SAMPLE), shapes_of(TEXTURE), beside, kinds=kinds, usable=usable, seed=seed)


@pytest.mark.parametrize("stretch", [1, 2])
def test_kinds_are_read_from_an_uneven_map_of_any_size(stretch: int):
    cells = SAMPLE.cells()
    cell = feature_maps(SAMPLE, cells).cell
    meant = np.where(np.arange(len(cells)) < 0.6 * len(cells), 0, 1 + np.arange(len(cells)) % 2)
    noise = np.random.default_rng(1).normal(0, 0.02, (*cell.shape, 3))
    colours = np.clip(COLOURS[meant[cell]] + noise, 0, 1).astype(np.float32)
    colours[::5] = 0.5  # lines over it
    kinds = kinds_of(cell, np.repeat(np.repeat(colours, stretch, axis=0), stretch, axis=1), len(cells))
    assert len(kinds.palette) == 3
    nearest = ((kinds.palette[:, None] - COLOURS) ** 2).sum(axis=2).argmin(axis=1)
    assert nearest[0] == 0, "what covers most comes first"
    np.testing.assert_array_equal(nearest[kinds.of_cell], meant)


def test_what_is_painted_gives_the_nearest_kind_of_most_texels():
    cells = TEXTURE.cells()
    cell = feature_maps(TEXTURE, cells).cell
    pattern = np.full((100, 130, 3), 0.15, np.float32)
    pattern[:, 65:] = (0.8, 0.3, 0.2)
    kinds = painted(cell, pattern, palette=COLOURS, count=len(cells))
    right = np.bincount(cell.ravel(), np.tile(np.arange(260) >= 130, 200), len(cells)) / np.bincount(cell.ravel())
    assert (kinds[right > 0.51] == 0).all()
    assert (kinds[right < 0.49] == kinds[0 if right[0] < 0.49 else right.argmin()]).all()
    assert (kinds[right < 0.49] != 0).all()


def test_a_cell_without_texels_is_of_the_first_kind():
    cell = np.zeros((4, 4), np.int32)
    colours = np.tile(COLOURS[1], (4, 4, 1))
    assert list(kinds_of(cell, colours, 3).of_cell) == [0, 0, 0]
    assert list(painted(cell, colours, palette=COLOURS, count=3)) == [1, 0, 0]


def test_neighbours_are_those_across_an_edge():
    graph = straight(
        (20.0, 30.0),
        np.array([[2, 2], [2, 10], [2, 20], [12, 2], [12, 10], [12, 20]], float),
        np.array([[0, 1], [1, 2], [3, 4], [4, 5], [0, 3], [1, 4], [2, 5]]),
    )
    start, beside = neighbours(graph, graph.cells())
    np.testing.assert_array_equal(start, [0, 1, 2])
    np.testing.assert_array_equal(beside, [1, 0])


def test_neighbours_never_show_the_same_and_all_that_may_be_shown_is():
    sample = random_cells((110.0, 130.0), cell=18, seed=8)
    start, beside = neighbours(TEXTURE, TEXTURE.cells())
    shapes = shapes_of(sample)
    source = Deal().run(shapes, shapes_of(TEXTURE), (start, beside), seed=5).source
    for cell, shown in enumerate(source):
        assert shown not in source[beside[start[cell] : start[cell + 1]]]
    used = np.bincount(source, minlength=len(shapes))
    assert not used[~shapes.whole].any()
    assert (used[shapes.whole] > 0).mean() > 0.9
    assert used.max() <= 2.5 * len(source) / shapes.whole.sum()


def test_ours_is_more_alike_than_the_papers():
    sample, texture = shapes_of(SAMPLE), shapes_of(TEXTURE)
    apart = {}
    for by in ("alike", "random"):
        source = deal(by).source
        size = np.log(sample.relative[source]) - np.log(texture.relative)
        apart[by] = np.abs(size).mean() + np.abs(sample.elongation[source] - texture.elongation).mean()
    assert apart["alike"] < 0.7 * apart["random"]


def test_samples_of_many_and_of_few_cells_are_shown_as_often():
    shapes = shapes_of(random_cells((110.0, 130.0), cell=14, seed=8))
    owner = (np.arange(len(shapes)) >= len(shapes) // 4).astype(np.int32)
    texture, beside = shapes_of(TEXTURE), neighbours(TEXTURE, TEXTURE.cells())
    shown = owner[Deal().run(shapes, texture, beside, owner=owner, seed=5).source]
    assert 0.4 < shown.mean() < 0.6
    alone = Deal().run(shapes, texture, beside, seed=5).source
    assert owner[alone].mean() > 0.7
    same = Deal().run(shapes, texture, beside, owner=np.zeros_like(owner), seed=5).source
    np.testing.assert_array_equal(alone, same)


@pytest.mark.parametrize("by", ["alike", "random"])
def test_kinds_are_kept_and_what_has_none_takes_any(by):
    sample, texture = len(SAMPLE.cells()), len(TEXTURE.cells())
    of_sample = (np.arange(sample) % 2).astype(np.int32)
    of_texture = (draws.bits(1, index=np.arange(texture)) % np.uint32(3)).astype(np.int32)
    source = deal(by, (of_sample, of_texture)).source
    known = of_texture < 2
    np.testing.assert_array_equal(of_sample[source[known]], of_texture[known])
    assert shapes_of(SAMPLE).whole[source].all() and len(np.unique(source[~known])) > 1


def test_only_what_is_usable_is_shown_unless_nothing_of_the_kind_is():
    whole = shapes_of(SAMPLE).whole
    usable = np.zeros(len(whole), bool)
    usable[np.flatnonzero(whole)[:2]] = True
    assert set(deal(usable=usable).source) == set(np.flatnonzero(usable))
    assert len(set(deal(usable=np.zeros(len(whole), bool)).source)) > 2


def test_long_cells_are_turned_along_each_other():
    sample, texture, dealt = shapes_of(SAMPLE), shapes_of(TEXTURE), deal()
    long = (sample.elongation[dealt.source] > 0.25) & (texture.elongation > 0.25)
    gap = sample.axis[dealt.source] - texture.axis - dealt.turn
    gap -= np.rint(gap / np.pi) * np.pi
    assert long.any() and np.abs(gap[long]).max() < 1e-5
    assert not dealt.turn[~long].any() and np.abs(dealt.turn).max() <= np.pi / 2 + 1e-6


def test_the_seed_decides():
    np.testing.assert_array_equal(deal(seed=1).source, deal(seed=1).source)
    assert (deal(seed=1).source != deal(seed=2).source).any()


def test_a_sample_without_cells_is_refused():
    none = straight((20.0, 20.0), np.array([[1.0, 1], [9, 9]]), np.array([[0, 1]]))
    beside = neighbours(TEXTURE, TEXTURE.cells())
    with pytest.raises(ExemplarError, match="no cells"):
        Deal().run(shapes_of(none), shapes_of(TEXTURE), beside, seed=0)
    dealt = Deal().run(shapes_of(TEXTURE), shapes_of(none), neighbours(none, none.cells()), seed=0)
    assert len(dealt.source) == 0
