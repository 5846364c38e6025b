"""What every method promises, on places of every kind: sources that are right, whole and repeatable."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import ball, exemplar, flagged, holes
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.kernels.launch import thread_count, use
from texloom.metrics import seam_ratio
from texloom.output.gather import gather_sites
from texloom.sources import SourceMap
from texloom.synthesis.boundary import BoundarySampling
from texloom.synthesis.least_squares import LeastSquares, Stage, stages
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.refine import Refine
from texloom.synthesis.synthesize import Method, synthesize

METHODS: dict[str, Method] = {
    "optimize": Optimize(),
    "k-coherence": Optimize(alike=2),
    "patches": PatchSampling(),
    "refine": Refine(),
    "least-squares": LeastSquares(schedule=(Stage(2, 8), Stage(1, 8)), iterations=3),
    "boundary": BoundarySampling(patch=16, zone=3, steps=(2, 1)),
}
TINY: dict[str, Method] = METHODS | {
    "least-squares": LeastSquares(schedule=stages(8), iterations=2),
    "boundary": BoundarySampling(patch=8, zone=2, steps=(1,)),
}
"""The same on an exemplar of 8 × 8."""

EVERY = pytest.mark.parametrize("name", METHODS)
OURS = pytest.mark.parametrize("name", ["optimize", "patches", "refine"])
FIELD = np.stack(np.broadcast_arrays(np.sin(np.arange(24) / 9), np.cos(np.arange(24)[:, None] / 9)), -1)
PLACES: dict[str, Domain] = {
    "plane": Grid(26, 21),
    "torus": Grid(26, 21, wrap=True),
    "field": Grid(24, 24, field=FIELD),
    "ball": ball(),
}


@pytest.fixture
def restored_threads() -> Iterator[None]:
    before = thread_count()
    yield
    use(threads=before)


def equal(one: SourceMap, two: SourceMap) -> bool:
    turns = (one.turn is None) == (two.turn is None) and (one.turn is None or np.array_equal(one.turn, two.turn))
    return turns and np.array_equal(one.position, two.position) and np.array_equal(one.weight, two.weight)


def check(sources: SourceMap, domain: Domain, shape: tuple[int, int]) -> None:
    """Up to four sources a site, shares of one, inside the exemplar (on traced patches, up to a texel outside)."""
    count, k, _ = sources.position.shape
    assert count == domain.count and 1 <= k <= 4
    assert np.isfinite(sources.position).all()
    np.testing.assert_allclose(sources.weight.sum(1), 1, atol=1e-5)
    assert (sources.weight >= 0).all()
    straight = isinstance(domain, Grid) and domain.field is None
    margin = 0 if straight else 1
    assert sources.position.min() >= -margin
    assert (sources.position <= np.array(shape) - 1 + margin).all()
    if straight:
        np.testing.assert_array_equal(sources.position, np.rint(sources.position))


@EVERY
@pytest.mark.parametrize("place", PLACES)
def test_every_site_gets_a_source_inside_the_exemplar(name: str, place: str) -> None:
    sample, domain = exemplar(32), PLACES[place]
    check(synthesize(sample, domain, METHODS[name], seed=1).sources, domain, sample.shape)


@EVERY
@pytest.mark.parametrize("place", ["torus", "ball"])
def test_same_seed_same_sources_on_any_number_of_threads(name: str, place: str, restored_threads: None) -> None:
    results = []
    for threads in (1, 2, 2):
        use(threads=threads)
        results.append(synthesize(exemplar(32), PLACES[place], METHODS[name], seed=5))
    for other in results[1:]:
        assert equal(results[0].sources, other.sources)
        assert results[0].energy == other.energy


@EVERY
def test_another_seed_gives_another_result(name: str) -> None:
    one, two = (synthesize(exemplar(32), PLACES["torus"], METHODS[name], seed=seed) for seed in (1, 2))
    assert not equal(one.sources, two.sources)


@EVERY
@pytest.mark.parametrize("channels", [1, 3, 6], ids=["grey", "colour", "stack"])
def test_any_number_of_channels(name: str, channels: int) -> None:
    sample = exemplar(24, channels)
    check(synthesize(sample, Grid(20, 20), METHODS[name]).sources, Grid(20, 20), sample.shape)


@EVERY
def test_a_constant_exemplar_gives_its_colour(name: str) -> None:
    sample = from_array(np.full((24, 20, 3), 77, np.uint8))
    result = synthesize(sample, PLACES["torus"], METHODS[name])
    check(result.sources, PLACES["torus"], sample.shape)
    values = gather_sites(result.sources, sample.lead)
    np.testing.assert_allclose(values, np.broadcast_to(sample.lead.image[0, 0], values.shape), rtol=1e-5)
    assert all(energy < 1e-10 for energy in result.energy)


@EVERY
@pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
@pytest.mark.parametrize("shape", [(1, 1), (5, 7), (1, 30), (20, 9)], ids=str)
def test_the_least_exemplar_and_outputs_smaller_than_a_patch(name: str, shape: tuple[int, int], wrap: bool) -> None:
    for sample, method in ((exemplar(8), TINY[name]), (exemplar(33), METHODS[name])):
        domain = Grid(*shape, wrap=wrap)
        check(synthesize(sample, domain, method, seed=2).sources, domain, sample.shape)


@EVERY
@pytest.mark.parametrize("shape", [(8, 40), (41, 9)], ids=str)
def test_narrow_exemplars(name: str, shape: tuple[int, int]) -> None:
    sample = exemplar(48).crop(slice(0, shape[0]), slice(0, shape[1]))
    check(synthesize(sample, Grid(30, 30), TINY[name]).sources, Grid(30, 30), shape)


def shown_masked(sources: SourceMap, mask: ndarray) -> int:
    """Sources of some weight at masked texels."""
    texel = np.clip(np.rint(sources.position).astype(int), 0, np.array(mask.shape) - 1)
    return int(np.count_nonzero(~mask[texel[..., 0], texel[..., 1]] & (sources.weight > 0)))


@EVERY
@pytest.mark.parametrize("wrap", [False, True], ids=["plane", "torus"])
@pytest.mark.parametrize("seed", [0, 1])
def test_masked_texels_are_never_shown(name: str, wrap: bool, seed: int) -> None:
    mask = holes(40)
    sample = flagged(mask)
    sources = synthesize(sample, Grid(50, 46, wrap), METHODS[name], seed=seed).sources
    assert shown_masked(sources, mask) == 0
    np.testing.assert_array_equal(gather_sites(sources, sample.maps["flag"]), 0)


@OURS
def test_a_masked_exemplar_is_used_where_it_may_be(name: str) -> None:
    """Both sides of a hole are seen in the result."""
    mask = np.ones((40, 40), bool)
    mask[:, 18:22] = False
    column = synthesize(flagged(mask), Grid(60, 60), METHODS[name]).sources.position[..., 1]
    assert 0.2 < (column < 18).mean() < 0.8


@OURS
@pytest.mark.parametrize("seed", [0, 3])
def test_a_torus_has_no_seam(name: str, seed: int) -> None:
    sample = exemplar(40)
    values = gather_sites(synthesize(sample, Grid(48, 40, wrap=True), METHODS[name], seed=seed).sources, sample.lead)
    image = values.reshape(48, 40, 3)
    assert seam_ratio(image) <= 1
    assert seam_ratio(np.roll(image, (7, 11), (0, 1))) <= 1


def test_interrupting_leaves_cleanly() -> None:
    """A report may stop the work; the next run is not the worse for it."""
    before = {name: synthesize(exemplar(32), PLACES["plane"], method, seed=4) for name, method in METHODS.items()}
    for name, method in METHODS.items():
        reports: list[tuple[str, float]] = []

        def stop(stage: str, done: float, reports: list = reports) -> None:
            reports.append((stage, done))
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            synthesize(exemplar(32), PLACES["plane"], method, seed=4, report=stop)
        assert len(reports) == 1
        assert equal(synthesize(exemplar(32), PLACES["plane"], method, seed=4).sources, before[name].sources)


def test_an_interrupt_gives_the_products_their_threads_back() -> None:
    from threadpoolctl import threadpool_info

    def stop(stage: str, done: float) -> None:
        raise KeyboardInterrupt

    synthesize(exemplar(32), PLACES["plane"])  # loads every library
    before = [pool["num_threads"] for pool in threadpool_info()]
    with pytest.raises(KeyboardInterrupt):
        synthesize(exemplar(32), PLACES["plane"], report=stop)
    assert [pool["num_threads"] for pool in threadpool_info()] == before


@EVERY
def test_reports_rise_to_one(name: str) -> None:
    said: dict[str, list[float]] = {}
    synthesize(
        exemplar(32),
        PLACES["plane"],
        METHODS[name],
        report=lambda stage, done: said.setdefault(stage, []).append(done),
    )
    assert said
    for done in said.values():
        assert done == sorted(done) and done[0] > 0
        assert done[-1] == pytest.approx(1) or name in ("least-squares", "refine")  # these may converge before


def test_the_exemplar_is_left_as_it_was() -> None:
    sample: Exemplar = flagged(holes(32))
    before = {name: m.image.copy() for name, m in sample.maps.items()}
    for method in METHODS.values():
        synthesize(sample, PLACES["plane"], method)
    for name, image in before.items():
        np.testing.assert_array_equal(sample.maps[name].image, image)
