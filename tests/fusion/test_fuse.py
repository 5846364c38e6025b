"""Fusions show each sample where it is asked for, meet within belts, and speak of the samples' own texels."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import ball, exemplar, flagged, holes
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.domain.surface import Surface
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.fusion.belts import lay_belts
from texloom.fusion.borders import cut_border
from texloom.fusion.fuse import Filling, Fused, fuse
from texloom.kernels.launch import thread_count, use
from texloom.output.gather import gather_sites
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling

SAMPLES = [exemplar(40), exemplar(32, seed=7), exemplar(48, seed=3).crop(slice(0, 36), slice(0, 48))]
FIELD = np.stack(np.broadcast_arrays(np.sin(np.arange(44) / 9), np.cos(np.arange(40)[:, None] / 9)), -1)
PLACES: dict[str, Domain] = {
    "plane": Grid(40, 44),
    "torus": Grid(40, 44, wrap=True),
    "field": Grid(40, 44, field=FIELD),
    "ball": ball(),
}
BOTH = pytest.mark.parametrize("belts", ["cut", "sample"])


def thirds(domain: Domain) -> ndarray:
    """Three labels: bands from the top to the bottom."""
    height = -domain.refined.mesh.vertices[:, 1] if isinstance(domain, Surface) else np.arange(domain.count)
    return (np.argsort(np.argsort(height)) * 3 // domain.count).astype(np.int32)


def halves(count: int) -> ndarray:
    return (np.arange(count) * 2 // count).astype(np.int32)


def part_shown(fused: Fused) -> ndarray:
    """The part of the vocabulary that each site's source lies in, -1 for none; up to a texel outside counts."""
    position = fused.result.sources.position[:, 0]
    found = np.full(len(position), -1)
    for number, part in enumerate(fused.joined.parts):
        low = np.array([part.row, part.column]) - 1
        inside = (position >= low) & (position <= low + np.array([part.rows, part.columns]) + 1)
        found[inside.all(1)] = number
    return found


@BOTH
@pytest.mark.parametrize("place", PLACES)
def test_each_sample_is_shown_where_it_is_asked_for(place: str, belts: Filling) -> None:
    domain = PLACES[place]
    labels = thirds(domain)
    fused = fuse(SAMPLES, labels, domain, belts=belts, scales=(6, 6, 8), seed=1)
    assert fused.result.sources.count == domain.count
    np.testing.assert_array_equal(part_shown(fused), fused.labels)
    outside = lay_belts(domain, labels, np.array([6.0, 6, 8])).nearest() < 0
    np.testing.assert_array_equal(fused.labels[outside], labels[outside])
    assert np.mean(fused.labels == labels) > 0.6


@BOTH
def test_a_map_of_one_label_is_that_sample_alone(belts: Filling) -> None:
    fused = fuse(SAMPLES, np.full(600, 1, np.int32), Grid(20, 30), belts=belts)
    assert (part_shown(fused) == 1).all()


@BOTH
def test_two_of_one_colour_meet_without_a_trace(belts: Filling) -> None:
    plain = [from_array(np.full((24, 20 + 4 * k, 3), 90, np.uint8)) for k in range(2)]
    fused = fuse(plain, halves(900), Grid(30, 30), belts=belts)
    assert np.unique(gather_sites(fused.result.sources, fused.exemplar.lead), axis=0).shape[0] == 1


@BOTH
@pytest.mark.parametrize("shape", [(1, 1), (1, 2), (2, 1), (5, 4)], ids=str)
def test_the_least_fusions(shape: tuple[int, int], belts: Filling) -> None:
    domain = Grid(*shape)
    fused = fuse([exemplar(8), exemplar(9, seed=1)], halves(domain.count), domain, belts=belts)
    np.testing.assert_array_equal(part_shown(fused), fused.labels)


@BOTH
def test_masked_texels_are_never_shown(belts: Filling) -> None:
    samples = [flagged(holes(40)), flagged(np.roll(holes(44), 9, 1))]
    fused = fuse(samples, halves(50 * 46), Grid(50, 46), belts=belts, seed=2)
    np.testing.assert_array_equal(gather_sites(fused.result.sources, fused.exemplar.maps["flag"]), 0)


@BOTH
def test_stacks_are_fused_as_one(belts: Filling) -> None:
    """Colour and normals stay aligned; a map that not all have is dropped."""
    more = Exemplar({**exemplar(32, 6).maps, "ao": exemplar(32, 1).lead})
    fused = fuse([exemplar(40, 6), more], halves(1200), Grid(30, 40), belts=belts)
    assert list(fused.exemplar.maps) == ["basecolor", "normal"] and fused.joined.dropped == ("ao",)


@pytest.fixture
def restored_threads() -> Iterator[None]:
    before = thread_count()
    yield
    use(threads=before)


@BOTH
@pytest.mark.parametrize("place", ["torus", "ball"])
def test_same_seed_same_sources_on_any_number_of_threads(place: str, belts: Filling, restored_threads: None) -> None:
    domain, results = PLACES[place], []
    for threads, seed in ((1, 5), (2, 5), (2, 6)):
        use(threads=threads)
        results.append(fuse(SAMPLES, thirds(domain), domain, belts=belts, seed=seed).result.sources.position)
    np.testing.assert_array_equal(results[0], results[1])
    assert not np.array_equal(results[1], results[2])


def test_methods_are_exchangeable_and_belts_have_their_own() -> None:
    asked: list[tuple[float, float]] = []

    def for_belt(smaller: float, larger: float) -> PatchSampling:
        asked.append((smaller, larger))
        return PatchSampling(patch=8)

    fused = fuse(
        SAMPLES[:2],
        halves(1600),
        Grid(40, 40),
        method=Optimize(start=PatchSampling(patch=8)),
        belts="sample",
        belt_method=for_belt,
        scales=(9.0, 5.0),
    )
    assert asked == [(5.0, 9.0)]
    np.testing.assert_array_equal(part_shown(fused), fused.labels)


def layers_of(first: ndarray, second: ndarray) -> list[Canvas]:
    """Two canvases that show these greys everywhere."""
    layers = []
    for shown in (first, second):
        canvas = Canvas.empty(shown.size, 4)
        canvas.colour[:, 0], canvas.label[:] = shown.ravel(), 0
        layers.append(canvas)
    return layers


def test_a_border_runs_where_both_pictures_agree() -> None:
    """Along a crooked line of equal texels, three to the right of the map's straight border."""
    grid = Grid(24, 40)
    row, column = np.mgrid[:24, :40]
    valley = 23 + (row // 6) % 2
    second = np.where(np.abs(column - valley) <= 1, 0.0, 1.0)
    shown = (column >= 20).astype(np.int32).ravel()
    cut_border(shown, lay_belts(grid, shown, np.array([16.0, 16.0])), (0, 1), layers_of(0 * second, second), grid)
    border = np.abs(np.argmax(shown.reshape(24, 40), 1) - (valley[:, 0] + 0.5))
    assert border.max() <= 1.5


def test_a_narrow_stroke_is_not_cut_off() -> None:
    """Where every border costs the same, a stroke of 5 texels stays, though its belts are 20 wide."""
    grid = Grid(50, 50)
    row, column = np.mgrid[:50, :50]
    stroke = (np.abs(row - 25) <= 2) & (column > 8) & (column < 42)
    labels = stroke.astype(np.int32).ravel()
    shown = labels.copy()
    layers = layers_of(np.zeros((50, 50)), np.ones((50, 50)))
    cut_border(shown, lay_belts(grid, labels, np.array([20.0, 20.0])), (0, 1), layers, grid)
    assert shown[labels == 1].mean() > 0.5 and shown[labels == 0].mean() < 0.05


@pytest.mark.parametrize(
    ("labels", "belts", "message"),
    [
        (np.zeros(99, np.int32), "cut", "99 labels for 100 sites"),
        (np.full(100, 2, np.int32), "cut", "labels go from 2 to 2, but there are 2 samples"),
        (np.full(100, -1, np.int32), "cut", "labels go from -1"),
        (np.zeros(100, np.int32), "wide", "unknown belts 'wide': choose cut or sample"),
    ],
)
def test_what_does_not_fit_is_refused(labels: ndarray, belts: Filling, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        fuse(SAMPLES[:2], labels, Grid(10, 10), belts=belts)
