"""Cells are found where an example has them."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tests.data import DATA, needs_data
from texloom.errors import ExemplarError
from texloom.exemplar.exemplar import Exemplar, to_map
from texloom.io.stack import read_exemplar
from texloom.sketch.random import random_cells
from texloom.sketch.reading.detect import detect


def painted(seed: int, *, dark: bool) -> tuple[Exemplar, np.ndarray]:
    """Random cells with lines between them, noise all over; the places of the lines."""
    graph = random_cells((160.0, 160.0), cell=24, seed=seed)
    on = graph.flattened(0.1, margin=4.0)
    share = np.linspace(0, 1, 40)[:, None, None]
    line = (on.start + share * (on.end - on.start)).reshape(-1, 2)
    place = np.stack(np.mgrid[:160, :160], axis=2).reshape(-1, 2)
    near = cKDTree(line).query(place)[0].reshape(160, 160)
    shade = 0.6 - 0.35 * np.exp(-(near**2) / 4) * (1 if dark else -1)
    noise = np.random.default_rng(seed).normal(0, 0.03, (160, 160))
    picture = np.uint8(np.clip(shade + noise, 0, 1) * 255)[..., None]
    return Exemplar({"basecolor": to_map(np.repeat(picture, 3, axis=2), "colour")}), line


@pytest.mark.parametrize("dark", [True, False])
def test_painted_cells_are_found_where_they_are(dark):
    example, line = painted(3, dark=dark)
    graph = detect(example)
    found = graph.flattened(0.1)
    assert np.percentile(cKDTree(line).query(found.start)[0], 90) < 1.0
    inside = line[((line > 0) & (line < 159)).all(axis=1)]
    share = np.linspace(0, 1, 20)[:, None, None]
    dense = (found.start + share * (found.end - found.start)).reshape(-1, 2)
    assert (cKDTree(dense).query(inside)[0] < 2).mean() > 0.97
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
    ],
)
def test_stones_bricks_and_scales_are_found(name, fewest, most):
    graph = detect(read_exemplar(DATA / "exemplars" / f"{name}.png"))
    assert fewest <= len(graph.cells()) <= most
    assert len(graph.crossings()) == 0


@needs_data
def test_an_example_without_cells_is_refused():
    with pytest.raises(ExemplarError, match="no cells"):
        detect(read_exemplar(DATA / "exemplars" / "cracker-128.png"))
