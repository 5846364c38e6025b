"""Cells are found where an example has them."""

from functools import partial

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter
from scipy.spatial import cKDTree

from tests.data import DATA, needs_data
from texloom.errors import ExemplarError
from texloom.exemplar.exemplar import Exemplar, to_map
from texloom.io.stack import read_exemplar
from texloom.sketch.filling.maps import feature_maps
from texloom.sketch.graph import Segments
from texloom.sketch.random import random_cells
from texloom.sketch.reading.detect import detect


def lined(seed: int, *, dark: bool) -> tuple[Exemplar, np.ndarray]:
    """Random cells with lines between them, noise all over; the places of the lines."""
    graph = random_cells((160.0, 160.0), cell=24, seed=seed)
    line = places(graph.flattened(0.1, margin=4.0))
    place = np.stack(np.mgrid[:160, :160], axis=2).reshape(-1, 2)
    near = cKDTree(line).query(place)[0].reshape(160, 160)
    shade = 0.6 - 0.35 * np.exp(-(near**2) / 4) * (1 if dark else -1)
    noise = np.random.default_rng(seed).normal(0, 0.03, (160, 160))
    return example(np.repeat((shade + noise)[..., None], 3, axis=2)), line


def coloured(seed: int) -> tuple[Exemplar, np.ndarray]:
    """Random cells, each of a colour, without lines, noise all over; the places of their borders."""
    graph = random_cells((160.0, 160.0), cell=24, seed=seed)
    cell = feature_maps(graph, graph.cells()).cell
    draw = np.random.default_rng(seed)
    picture = draw.uniform(0.1, 0.9, (cell.max() + 2, 3))[cell] + draw.normal(0, 0.03, (160, 160, 3))
    return example(picture), places(graph.flattened(0.1, margin=4.0))


def example(picture: np.ndarray) -> Exemplar:
    """Of colours in [0, 1]."""
    return Exemplar({"basecolor": to_map(np.uint8(np.clip(picture, 0, 1) * 255), "colour")})


def places(on: Segments) -> np.ndarray:
    """Close to each other along chords."""
    share = np.linspace(0, 1, 40)[:, None, None]
    return (on.start + share * (on.end - on.start)).reshape(-1, 2)


@pytest.mark.parametrize(
    "paint", [partial(lined, dark=True), partial(lined, dark=False), coloured], ids=["dark", "bright", "coloured"]
)
def test_painted_cells_are_found_where_they_are(paint):
    picture, line = paint(3)
    graph = detect(picture)
    found = graph.flattened(0.1)
    assert np.percentile(cKDTree(line).query(found.start)[0], 90) < 1.0
    inside = line[((line > 0) & (line < 159)).all(axis=1)]
    assert (cKDTree(places(found)).query(inside)[0] < 2).mean() > 0.97
    assert len(graph.crossings()) == 0


def test_noise_alone_is_refused_or_planar():
    noise = np.random.default_rng(0).integers(0, 256, (64, 64, 3), dtype=np.uint8)
    try:
        graph = detect(Exemplar({"basecolor": to_map(noise, "colour")}))
    except ExemplarError:
        return
    assert len(graph.crossings()) == 0


def test_an_even_example_is_refused():
    with pytest.raises(ExemplarError, match="no cells"):
        detect(Exemplar({"basecolor": to_map(np.full((64, 64, 3), 90, np.uint8), "colour")}))


def test_repeated_spots_are_each_in_the_middle_of_a_tile():
    spot = np.zeros((30, 24))
    spot[13:17, 10:14] = 1
    picture = 0.7 - 0.6 * np.tile(spot, (6, 6)) + 0.1 * noise(0, shape=(180, 144), blur=6.0)
    graph = detect(example(np.repeat(picture[..., None], 3, axis=2)))
    cells = graph.cells()
    np.testing.assert_allclose(cells.area, 30 * 24, rtol=0.02)
    assert len(cells) >= 16
    middle = np.stack(np.meshgrid(14.5 + 30 * np.arange(6), 11.5 + 24 * np.arange(6), indexing="ij"), axis=2)
    assert cKDTree(middle.reshape(-1, 2)).query(places(graph.flattened(0.1)))[0].min() > 6


@pytest.mark.parametrize("wide", [11, 16, 20])
def test_a_chessboard_has_its_squares(wide):
    """It repeats, too, but so do its lines."""
    board = (np.indices((128, 128)) // wide).sum(axis=0) % 2 * 0.8 + 0.1
    graph = detect(example(np.repeat(board[..., None], 3, axis=2) + 0.02 * noise(0, shape=(128, 128, 3), blur=0.0)))
    np.testing.assert_allclose(np.median(graph.cells().area), wide**2, rtol=0.1)
    assert len(graph.cells()) == (-(-128 // wide) - 2) ** 2


def test_stripes_are_no_tiles():
    row, column = np.mgrid[:128, :128]
    picture = 0.5 + 0.3 * np.sin((row + 0.2 * column) / 2) + 0.03 * noise(1, shape=(128, 128), blur=0.0)
    with pytest.raises(ExemplarError, match="no cells"):
        detect(example(np.repeat(picture[..., None], 3, axis=2)))


def noise(seed: int, *, shape: tuple[int, ...], blur: float) -> np.ndarray:
    """Of variance 1."""
    grain = gaussian_filter(np.random.default_rng(seed).normal(size=shape), blur)
    return grain / grain.std()


@needs_data
@pytest.mark.parametrize(
    "name, fewest, most",  # whole cells counted by eye in the picture, give or take a fifth
    [
        ("bricks-red-128", 80, 110),
        ("bricks-brown-192", 40, 75),
        ("stones-brown-wall-128", 35, 55),
        ("stones-flagstone-192", 6, 11),
        ("scales-green-cells-192", 120, 160),
        ("pebbles-grey-242", 12, 25),
        ("beans-192", 28, 45),
        ("mud-cracked-400", 55, 95),
        ("cells-green-161-64", 9, 13),
        ("weave-wood-basket-192", 17, 26),
        ("roof-slate-scales-128", 80, 120),
        ("chainmail-128", 84, 126),
        ("cracker-128", 4, 6),
    ],
)
def test_stones_bricks_and_scales_are_found(name, fewest, most):
    graph = detect(read_exemplar(DATA / "exemplars" / f"{name}.png"))
    assert fewest <= len(graph.cells()) <= most
    assert len(graph.crossings()) == 0


@needs_data
def test_diamonds_of_tiles_are_not_their_ornament():
    """Nine around the flowers and those between them, of which some are cut by the picture's edge."""
    graph = detect(read_exemplar(DATA / "exemplars" / "tiles-azulejo-256.png"))
    np.testing.assert_allclose(graph.cells().area, 85.25**2 / 2, rtol=0.02)
    assert 8 <= len(graph.cells()) <= 13
