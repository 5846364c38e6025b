"""Sweeps: the same for the same seed, in the sample and its mask, on surfaces of every kind."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy import ndarray

from tests.meshes import as_mesh, cylinder, flat_square, single_triangle, sphere, torus, two_parts
from tests.synthesis.samples import ball, blobs, exemplar, flagged, holes
from texloom.domain.grid import Grid
from texloom.domain.neighbourhoods import Stencils
from texloom.domain.surface import Surface
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import from_array
from texloom.exemplar.join import join
from texloom.field.direction import from_constant
from texloom.field.smooth import smoothest
from texloom.kernels.launch import thread_count, use
from texloom.mesh.mesh import Mesh
from texloom.output.gather import gather_sites
from texloom.sources import SourceMap
from texloom.synthesis.sweep import Shape, Sweep, in_shape
from texloom.synthesis.synthesize import synthesize

METHODS = {
    "blocks": Sweep(),
    "random": Sweep(start="random"),
    "sequential": Sweep(order="sequential", passes=1),
    "talk": Sweep(start="random", shape="causal", order="sequential", search="tree"),
}
EVERY = pytest.mark.parametrize("name", METHODS)
BOTH_STARTS = pytest.mark.parametrize("name", ["blocks", "talk"])
BALL = ball(700)


def on(mesh: Mesh, texels: int, order: int) -> Surface:
    return Surface.build(mesh, smoothest(mesh, order), texel=float(np.sqrt(mesh.face_areas.sum() / texels)))


SURFACES: dict[str, Callable[[], Surface]] = {
    "torus": lambda: on(torus(), 700, 1),
    "cylinder": lambda: on(cylinder(), 700, 2),
    "parts": lambda: on(two_parts(), 700, 4),
    "far away": lambda: on(as_mesh(sphere(2).vertices * 1e-6 + 1e2, sphere(2).faces), 500, 6),
    "one triangle": lambda: on(single_triangle(), 20, 1),
}


def check(sources: SourceMap, domain: Surface, mask: ndarray) -> None:
    """One source a site, in the sample but for a texel that patches may lie outside, and where it may be used."""
    assert sources.position.shape == (domain.count, 1, 2)
    np.testing.assert_array_equal(sources.weight, 1)
    assert np.isfinite(sources.position).all() and (sources.turn is None or np.isfinite(sources.turn).all())
    assert sources.position.min() >= -1 and (sources.position <= mask.shape).all()
    texel = np.clip(np.rint(sources.position[:, 0]).astype(int), 0, np.array(mask.shape) - 1)
    assert mask[tuple(texel.T)].all()


@BOTH_STARTS
@pytest.mark.parametrize("place", SURFACES)
def test_every_site_gets_a_source_inside_the_sample(name: str, place: str) -> None:
    sample, domain = exemplar(48), SURFACES[place]()
    result = synthesize(sample, domain, METHODS[name], seed=1)
    check(result.sources, domain, sample.usable)
    levels = 1 if place == "one triangle" else 2
    assert len(result.energy) == levels * METHODS[name].passes
    assert result.energy[-1] < result.energy[0] or place == "one triangle"


@pytest.mark.parametrize("seed", [0, 2])
def test_large_samples_are_not_left_either(seed: int) -> None:
    """What begins at the border of the coarsest sample comes to lie ever farther outside, if nothing stops it."""
    sample, domain = from_array(blobs(180)[:, :170]), ball(1300)
    check(synthesize(sample, domain, Sweep(passes=1), seed=seed).sources, domain, sample.usable)


@EVERY
def test_same_seed_same_sources_on_any_number_of_threads(name: str) -> None:
    before, made = thread_count(), []
    try:
        for threads in (1, 2):
            use(threads=threads)
            made.append(synthesize(exemplar(48), BALL, METHODS[name], seed=3))
    finally:
        use(threads=before)
    assert made[0].energy == made[1].energy
    one, other = (result.sources for result in made)
    np.testing.assert_array_equal(one.position, other.position)
    assert one.turn is not None and other.turn is not None
    np.testing.assert_array_equal(one.turn, other.turn)


def test_another_seed_gives_another_result() -> None:
    one, other = (synthesize(exemplar(48), BALL, Sweep(levels=1, passes=1), seed=seed).sources for seed in (1, 2))
    assert not np.array_equal(one.position, other.position)


@BOTH_STARTS
@pytest.mark.parametrize("kind", ["holes", "scratch"])
def test_masked_texels_are_never_shown(name: str, kind: str) -> None:
    """Also between the texels of the coarser levels: a scratch is one texel wide, in odd rows and columns."""
    mask = holes(90) if kind == "holes" else np.ones((90, 90), bool)
    if kind == "scratch":
        mask[:, 45] = mask[31] = False
    sample = flagged(mask)
    sources = synthesize(sample, BALL, METHODS[name], seed=2).sources
    check(sources, BALL, mask)
    np.testing.assert_array_equal(gather_sites(sources, sample.maps["flag"]), 0)


def test_a_mask_too_fine_for_coarse_levels_leaves_the_finer_ones() -> None:
    mask = np.ones((96, 96), bool)
    mask[::16] = False
    check(synthesize(flagged(mask), BALL, Sweep(), seed=2).sources, BALL, mask)


@BOTH_STARTS
def test_of_joined_samples_both_are_used_and_no_gap(name: str) -> None:
    joined = join([from_array(blobs(60, 3, 1)[:, :50]), from_array(blobs(70, 3, 2)[:44])])
    usable = joined.exemplar.usable
    assert not usable.all()
    sources = synthesize(joined.exemplar, BALL, METHODS[name], seed=2).sources
    check(sources, BALL, usable)
    row = sources.position[:, 0, 0]
    assert 0.02 < (row < joined.parts[1].row - 2).mean() < 0.98


def test_every_map_of_a_stack_comes_out() -> None:
    sample = exemplar(48, 6)
    sources = synthesize(sample, BALL, Sweep(), seed=1).sources
    for m in sample.maps.values():
        values = gather_sites(sources, m)
        assert values.shape == (BALL.count, m.image.shape[2]) and np.isfinite(values).all()
        assert np.abs(values.mean(axis=0) - m.image.mean(axis=(0, 1))).max() < 0.15


@pytest.mark.parametrize(("side", "levels"), [(41, 1), (42, 2), (84, 3)])
def test_small_samples_have_fewer_levels(side: int, levels: int) -> None:
    """Three windows across the coarsest."""
    domain = ball(1300)  # enough for three levels
    assert len(synthesize(exemplar(side), domain, Sweep(levels=9, passes=1), seed=1).energy) == levels


def test_in_the_plane_symmetries_make_no_difference() -> None:
    """Where all frames agree, a field of many directions is one of a single one."""
    mesh, energy = flat_square(8, 24.0), []
    for order in (1, 2, 4, 6):
        domain = Surface.build(mesh, from_constant(mesh, order, np.array([1.0, 0.0, 0.0])), texel=1.0)
        np.testing.assert_allclose(np.abs(domain.direction[:, 0]), 1, atol=1e-6)
        energy.append(synthesize(exemplar(48), domain, Sweep(start="random"), seed=1).energy[-1])
    np.testing.assert_allclose(energy, energy[0], rtol=0.4)


def test_a_constant_sample_gives_its_colour() -> None:
    sample = from_array(np.full((24, 20, 3), 77, np.uint8))
    for name in ("blocks", "talk"):
        result = synthesize(sample, BALL, METHODS[name])
        check(result.sources, BALL, sample.usable)
        assert all(energy < 1e-10 for energy in result.energy)


def test_reports_rise_to_one_and_seconds_are_told() -> None:
    said: dict[str, list[float]] = {}
    result = synthesize(exemplar(48), BALL, Sweep(), report=lambda what, done: said.setdefault(what, []).append(done))
    assert said["sweeps"] == pytest.approx([0.25, 0.5, 0.75, 1.0])
    assert set(result.seconds) == {"points", "analysis", "start", "stencils", "order", "sweeps"}
    assert min(result.seconds.values()) >= 0 and result.stopped == "passes"


@pytest.mark.parametrize(
    ("shape", "picture"),
    [
        ("full", "##### ##### ##### ##### #####"),
        ("causal", "###.. ###.. ##... ##... ##..."),
        ("half", "###.. ###.. ##... ###.. ###.."),
    ],
)
def test_the_shapes_of_the_talk(shape: Shape, picture: str) -> None:
    """Rows of a neighbourhood, the sweep coming along its columns; the middle one is what is sought."""
    offset = np.stack(np.divmod(np.arange(25), 5), axis=1).astype(np.float32)[None] - 2
    sites = np.zeros((1, 25, 1), np.int32)
    chosen = np.zeros(25, bool)
    chosen[in_shape(Stencils(sites, None, offset), shape)] = True
    rows = ["".join("#" if there else "." for there in row) for row in chosen.reshape(5, 5)]
    assert " ".join(rows) == picture


@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        ("start 'nothing'", {"start": "nothing"}),
        ("shape 'round'", {"shape": "round"}),
        ("order 'any'", {"order": "any"}),
        ("search 'hash'", {"search": "hash"}),
        ("window 4", {"window": 4}),
        ("window 1", {"window": 1}),
        ("levels 0", {"levels": 0}),
        ("passes 0", {"passes": 0}),
        ("alike -1", {"alike": -1}),
    ],
)
def test_a_bad_parameter_is_named(words: str, wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=words):
        Sweep(**wrong)  # pyright: ignore[reportArgumentType]


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(ParameterError, match="points of a mesh"):
        synthesize(exemplar(32), Grid(20, 20), Sweep())
    with pytest.raises(ExemplarError, match="24 texels across .* no whole neighbourhood of 25"):
        synthesize(exemplar(24), BALL, Sweep(window=25))
    mask = np.zeros((32, 32), bool)
    mask[::5] = True
    with pytest.raises(ExemplarError, match="mask"):
        synthesize(exemplar(32).with_mask(mask), BALL, Sweep())
