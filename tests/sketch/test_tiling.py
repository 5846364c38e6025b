from dataclasses import replace

import numpy as np
import pytest

from tests.sketch.drawn import euler, voronoi, wall
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.patch import seamless_patch
from texloom.sketch.mesh.tiling import on_plane, tile
from texloom.sketch.mesh.web import web


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
    by = np.random.default_rng(0).normal(size=tiling.graph.vertices.shape)
    anew = web(tiling.graph)
    np.testing.assert_array_equal(anew.strands.free, tiling.free)
    np.testing.assert_array_equal(anew.strands.ends, tiling.ends)
    moved = tiling.moved(by)
    np.testing.assert_array_equal(moved.vertices[tiling.free], (tiling.graph.vertices + by)[tiling.free])

    # Every carrier is a vertex beside the corner it carries: vertex by vertex the same as those of the one patch
    size = np.array(tiling.graph.size)
    alone = np.flatnonzero(tiling.corner_share.ravel() == 0)
    at, of = tiling.corner.reshape(-1, 2)[alone], tiling.graph.vertices[tiling.carrier.reshape(-1, 2)[alone, 0]]
    step = size / np.rint(size / (np.array(patch.graph.size) * tiling.scale))
    gap = (of - at) / step
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


def within(plane: CellGraph) -> np.ndarray:
    """Edges with an end in the texture."""
    ends = plane.curves[:, [0, 3]]
    inside = ((ends > -0.5) & (ends < np.array(plane.size) - 0.5)).sum(axis=2) == 2
    return np.flatnonzero(inside.sum(axis=1))
