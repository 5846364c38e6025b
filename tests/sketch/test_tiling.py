from dataclasses import replace

import numpy as np
import pytest

from tests.sketch.drawn import euler, voronoi, wall
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.mesh.patch import seamless_patch
from texloom.sketch.mesh.strands import carry, strands
from texloom.sketch.mesh.tiling import on_plane, tile


def test_a_patch_is_repeated_as_often_as_it_fits_and_stretched_to_fill() -> None:
    patch = seamless_patch(wall(6, 3), 0)  # 72 × 90
    tiling = tile(patch, (150, 260), scale=1.0, tileable=True)
    np.testing.assert_allclose(tiling.graph.size, (150, 260))
    np.testing.assert_allclose(tiling.scale, [150 / 144, 260 / 270])
    cells = tiling.graph.cells()
    assert len(cells) == 2 * 3 * 18 and euler(tiling.graph) == 0
    np.testing.assert_allclose(cells.area, 12 * 30 * np.prod(tiling.scale))


def test_without_tiling_the_torus_has_room_for_the_texture_and_cells_keep_their_size() -> None:
    patch = seamless_patch(wall(6, 3), 0)
    tiling = tile(patch, (150, 90), scale=0.5, tileable=False)
    assert tiling.graph.size == (180, 90)
    np.testing.assert_allclose(tiling.graph.cells().area, 12 * 30 / 4)


@pytest.mark.parametrize("scale", [0.4, 1.0, 2.5])
def test_a_tiling_is_what_its_own_graph_gives(scale: float) -> None:
    patch = seamless_patch(voronoi(30, seed=3), 0)
    tiling = tile(patch, (300, 250), scale=scale, tileable=True)
    assert not len(tiling.graph.crossings()) and euler(tiling.graph) == 0
    anew = strands(tiling.graph)
    np.testing.assert_array_equal(anew.free, tiling.loose)
    by = np.random.default_rng(0).normal(size=tiling.graph.vertices.shape)
    expected = carry(by, free=anew.free, edges=tiling.graph.edges, ends=anew.ends, share=anew.share)
    moved = tiling.moved(by).vertices - tiling.graph.vertices
    np.testing.assert_allclose(moved, expected, atol=1e-9)
    np.testing.assert_allclose(moved[anew.free], by[anew.free], atol=1e-9)


def lined(side: float = 40.0) -> CellGraph:
    """Squares on a torus whose sides are curves of three edges, across its borders too."""
    corner = np.stack(np.divmod(np.arange(9), 3), axis=1) * side + 3.0
    number = np.arange(9).reshape(3, 3)
    ends = np.concatenate([np.stack([number, np.roll(number, -1, axis)], axis=2).reshape(-1, 2) for axis in (0, 1)])
    step = np.repeat(np.eye(2) * side / 3, 9, axis=0)
    inner = corner[ends[:, 0], None] + step[:, None] * np.array([1, 2])[:, None] + [1.5, -1.5]
    size = np.array([3 * side, 3 * side])
    vertices = (np.concatenate([corner, inner.reshape(-1, 2)]) + 0.5) % size - 0.5
    one = 9 + 2 * np.arange(18)
    edges = np.concatenate(
        [np.stack(pair, axis=1) for pair in ((ends[:, 0], one), (one, one + 1), (one + 1, ends[:, 1]))]
    )
    return straight((3 * side, 3 * side), vertices, edges, wrap=True)


@pytest.mark.parametrize("size", [(120, 120), (240, 360)])  # as drawn: a stretched curve has other shares
def test_what_carries_a_point_lies_on_the_same_tile_or_across_its_border(size: tuple[int, int]) -> None:
    tiling = tile(seamless_patch(lined(), 0), size, scale=1.0, tileable=True)
    runs = strands(tiling.graph)
    by = np.random.default_rng(1).normal(size=tiling.graph.vertices.shape)
    expected = carry(by, free=runs.free, edges=tiling.graph.edges, ends=runs.ends, share=runs.share)
    assert (~runs.free).sum() == len(by) * 4 / 5
    np.testing.assert_allclose(tiling.moved(by).vertices, tiling.graph.vertices + expected, atol=1e-9)


def test_triangles_of_a_tiling_join_across_the_borders_of_tiles() -> None:
    tiling = tile(seamless_patch(lined(), 0), (200, 330), scale=1.0, tileable=True)
    size, tiles = np.array(tiling.graph.size), len(tiling.graph.vertices) // len(tiling.patch.graph.vertices)
    count = len(tiling.share) // tiles
    own = tiling.corner % count < len(tiling.patch.graph.vertices)  # corners that are vertices, the first of the points
    vertex = tiling.corner // count * len(tiling.patch.graph.vertices) + tiling.corner % count
    joined = own[:, 0] & own[:, 1]
    along = np.tile(tiling.patch.web.sides[:, 0] * tiling.scale, (tiles, 1))[joined]
    gap = (tiling.graph.vertices[vertex[joined, 1]] - tiling.graph.vertices[vertex[joined, 0]] - along) / size
    assert joined.sum() > 50
    np.testing.assert_allclose(gap, np.rint(gap), atol=1e-9)


def test_a_torus_cut_open_keeps_all_cells_that_reach_into_the_texture() -> None:
    torus = tile(seamless_patch(voronoi(30, seed=3), 0), (128, 160), scale=0.7, tileable=False).graph
    far = np.arange(len(torus.vertices))[:, None] % [3, 2] - 1  # on any copy, for all are one
    plane = on_plane(replace(torus, vertices=torus.vertices + far * torus.size), (128, 160), 60)
    assert plane.size == (128, 160) and not plane.wrap
    assert not len(plane.crossings())
    cells, around = plane.cells(), torus.cells()
    size = np.array(torus.size)

    # Each cell whose middle lies in the texture, at its place and as large
    def inside(centroid: np.ndarray) -> np.ndarray:
        return np.all((centroid > 0) & (centroid < (127, 159)), axis=1)

    wrapped = (around.centroid + 0.5) % size - 0.5
    expected = np.sort(around.area[inside(wrapped)])
    np.testing.assert_allclose(np.sort(cells.area[inside(cells.centroid)]), expected)

    # Edges lead from vertex to vertex, and those in the texture have a cell on both sides
    np.testing.assert_allclose(
        plane.vertices[plane.edges[:, 1]], plane.vertices[plane.edges[:, 0]] + plane.curve[:, 2], atol=1e-9
    )
    reaching = np.unique(
        np.concatenate([cells.of_halfedge(len(plane.edges))[2 * e : 2 * e + 2] for e in within(plane)])
    )
    assert (reaching >= 0).all()


@pytest.mark.parametrize("widest", [0.0, 9.0])
def test_a_torus_cut_open_has_every_edge_that_ends_within_reach(widest: float) -> None:
    torus = tile(seamless_patch(voronoi(30, seed=3), 0), (128, 160), scale=0.7, tileable=False).graph
    plane = on_plane(torus, (128, 160), widest)
    low, high = -0.5 - widest, np.array([127.5, 159.5]) + widest
    expected = 0
    for copy in ((r, c) for r in range(-3, 4) for c in range(-3, 4)):
        ends = torus.curves[:, [0, 3]] + np.array(copy) * torus.size
        expected += ((ends > low) & (ends < high)).all(axis=2).any(axis=1).sum()
    assert len(plane.edges) == expected


def within(plane: CellGraph) -> np.ndarray:
    """Edges with an end in the texture."""
    ends = plane.curves[:, [0, 3]]
    inside = ((ends > -0.5) & (ends < np.array(plane.size) - 0.5)).sum(axis=2) == 2
    return np.flatnonzero(inside.sum(axis=1))
