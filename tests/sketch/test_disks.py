from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.sketch.drawn import euler, voronoi, wall
from texloom import draws
from texloom.kernels.launch import thread_count, use
from texloom.sketch.mesh.disks import _discs, refined
from texloom.sketch.mesh.patch import seamless_patch
from texloom.sketch.mesh.tiling import Tiling, tile


def tiling_of(count: int, seed: int, *, size: tuple[int, int] = (160, 220), scale: float = 1.0) -> Tiling:
    return tile(seamless_patch(voronoi(count, seed), seed), size, scale=scale, tileable=True)


@pytest.fixture
def restored_threads() -> Iterator[None]:
    before = thread_count()
    yield
    use(threads=before)


def test_without_a_radius_nothing_moves() -> None:
    tiling = tiling_of(30, 1)
    graph = refined(tiling, 0, radius=0.0, iterations=3, strength=0.5)
    np.testing.assert_allclose(graph.vertices, tiling.graph.vertices, atol=1e-9)


def test_discs_lie_within_the_sketch_and_do_not_overlap() -> None:
    tiling = tiling_of(30, 1, size=(300, 500), scale=0.6)
    reach, cells, origin, disc, middle = _discs(tiling, 5, 4)
    assert reach == pytest.approx(0.25 * 200 * tiling.scale.min()) and cells.min() >= 3
    size, count = np.array(tiling.graph.size), cells.prod()
    corner = np.stack(np.divmod(np.arange(count), cells[1]), axis=1) * (size / cells)
    for iteration in range(4):
        at = origin[iteration] + corner + disc[iteration * count : (iteration + 1) * count]
        gap = at[:, None] - at
        gap -= np.rint(gap / size) * size
        apart = np.hypot(gap[..., 0], gap[..., 1])[~np.eye(count, dtype=bool)]
        assert apart.min() >= 2 * reach
    sketch = np.array([200, 200]) * tiling.scale
    assert (middle >= reach - 0.5).all() and (middle <= sketch - reach - 0.5).all()
    assert np.ptp(middle, axis=0).min() > 0.8 * (sketch - 2 * reach).min()


def naive_step(tiling: Tiling, seed: int, radius: float, strength: float) -> np.ndarray:  # eqs 7-8, one iteration
    reach, cells, origin, disc, middle = _discs(tiling, seed, 1)
    size, joints = np.array(tiling.graph.size), (tiling.patch.joints + 0.5) * tiling.scale - 0.5
    step = np.zeros_like(tiling.graph.vertices)
    for v in np.flatnonzero(tiling.loose):
        for cell, centre in enumerate(disc):
            from_middle = tiling.graph.vertices[v] - origin[0] - centre
            from_middle = from_middle - np.array(divmod(cell, cells[1])) * (size / cells)
            from_middle = from_middle - np.rint(from_middle / size) * size
            if np.hypot(*from_middle) > reach:
                continue
            gap = joints - (middle[cell] + from_middle)
            distance = np.hypot(*gap.T)
            seen = (distance <= radius) & (np.hypot(*(joints - middle[cell]).T) <= reach)
            if seen.any():
                weight = 1 / distance[seen]
                step[v] = strength * (weight[:, None] * gap[seen]).sum(axis=0) / weight.sum()
    noise = draws.uniform(seed, 1, index=np.arange(2 * tiling.loose.sum())).reshape(-1, 2)
    step[tiling.loose] += (noise * 2 - 1) * 0.04 * radius
    return step


def test_vertices_are_drawn_as_the_paper_says_where_nothing_is_in_the_way() -> None:
    tiling = tiling_of(40, 2, size=(300, 400))
    loose = replace(tiling, corner=tiling.corner[:0])
    graph = refined(loose, 7, radius=25.0, iterations=1, strength=0.6)
    step = naive_step(tiling, 7, 25.0, 0.6)
    assert np.hypot(*step.T).max() > 5
    np.testing.assert_allclose(graph.vertices, loose.moved(step).vertices, atol=1e-4)
    assert len(graph.crossings())  # something was in the way


def test_a_larger_radius_is_less_regular() -> None:
    tiling = tile(seamless_patch(wall(8, 4, (20.0, 48.0)), 0), (160, 192), scale=1.0, tileable=True)
    area = [refined(tiling, 3, radius=r, iterations=4, strength=0.5).cells().area.std() for r in (2.0, 8.0, 20.0)]
    assert area[0] < area[1] / 2 < area[2] / 4 and area[0] > 0


def test_repetition_goes() -> None:
    tiling = tiling_of(30, 1, size=(320, 320))
    graph = refined(tiling, 3, radius=25.0, iterations=4, strength=0.5)
    tiles = len(graph.vertices) // len(tiling.patch.graph.vertices)
    assert tiles > 1
    moved = (graph.vertices - tiling.graph.vertices)[tiling.loose].reshape(tiles, -1, 2)
    assert np.hypot(*(moved[0] - moved[1]).T).mean() > 3


def test_threads_change_nothing_and_seeds_do(restored_threads: None) -> None:
    tiling = tiling_of(30, 1)
    graphs = []
    for threads, seed in ((1, 4), (3, 4), (3, 5)):
        use(threads=threads)
        graphs.append(refined(tiling, seed, radius=15.0, iterations=3, strength=0.5))
    np.testing.assert_array_equal(graphs[0].vertices, graphs[1].vertices)
    assert not np.array_equal(graphs[1].vertices, graphs[2].vertices)


@settings(max_examples=25, deadline=None)
@given(
    count=st.integers(4, 60),
    seed=st.integers(0, 10**6),
    radius=st.floats(0, 60),
    strength=st.floats(0, 1),
    scale=st.floats(0.3, 2),
)
def test_nothing_ever_crosses_or_flips(count: int, seed: int, radius: float, strength: float, scale: float) -> None:
    assume(len(voronoi(count, seed).cells()) > 1)  # fewer make no patch of closed cells
    tiling = tiling_of(count, seed, scale=scale)
    cells = tiling.graph.cells()
    graph = refined(tiling, seed, radius=radius, iterations=4, strength=strength)
    assert not len(graph.crossings())
    assert not graph.flipped(cells).any()
    assert euler(graph) == euler(tiling.graph) and len(graph.cells()) == len(cells)
    if cells.area.sum() == pytest.approx(np.prod(graph.size)):
        assert graph.cells().area.sum() == pytest.approx(np.prod(graph.size))


def test_discs_come_from_all_sketches() -> None:
    sketches = voronoi(30, 1), voronoi(20, 2, size=(120.0, 150.0)), wall(6, 3)
    tiling = tile(seamless_patch(sketches, 0), (600, 900), scale=0.5, tileable=True)
    reach, *_, middle = _discs(tiling, 5, 4)
    sheets = (tiling.patch.sheets.reshape(-1, 2, 2) + 0.5) * tiling.scale - 0.5
    within = (middle >= sheets[:, None, 0] + reach - 1e-9) & (middle <= sheets[:, None, 1] - reach + 1e-9)
    owner = within.all(axis=2)
    assert (owner.sum(axis=0) == 1).all()
    np.testing.assert_allclose(owner.mean(axis=1), 1 / 3, atol=0.12)


def test_one_sketch_among_one_is_that_sketch() -> None:
    sketch = voronoi(30, 1)
    one, alone = (tile(seamless_patch(given, 1), (160, 220), scale=1.0, tileable=True) for given in ((sketch,), sketch))
    moved = [refined(tiling, 3, radius=15.0, iterations=2, strength=0.5).vertices for tiling in (one, alone)]
    np.testing.assert_array_equal(*moved)
