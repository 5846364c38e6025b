"""Values through sources: identity, exactness, rotation laws, and a naive oracle."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, Map, to_map
from texloom.output.gather import gather_images, gather_points, gather_sites, identity_sources
from texloom.output.image import stored
from texloom.sources import SourceMap


def noise(rows=9, columns=7, channels=3, kind="data", seed=0):
    return Map(np.random.default_rng(seed).random((rows, columns, channels), dtype=np.float32), kind, 8)


def unit_normals(rows=8, columns=8, seed=1):
    vectors = np.random.default_rng(seed).normal(size=(rows, columns, 3)) + [0, 0, 3]
    vectors /= np.linalg.norm(vectors, axis=2, keepdims=True)
    return Map((0.5 * vectors + 0.5).astype(np.float32), "normal", 8)


def counts(f):
    """What texels -1, 0, 1 and 2 count for: the line between the middle two, less 4/3 of half the curvature."""
    a, b, c, d = np.eye(4)
    line, curvature = (1 - f) * b + f * c, (1 - f) * (a - 2 * b + c) + f * (b - 2 * c + d)
    return line - 4 / 3 * f * (1 - f) / 2 * curvature


def sample(image, row, column):
    """Cubic, edges repeated; bounded by the four texels around and their difference, and by [0, 1]."""
    rows, columns = image.shape[:2]
    row, column = np.clip(row, -1, rows), np.clip(column, -1, columns)
    down = np.clip(int(np.floor(row)) + np.arange(-1, 3), 0, rows - 1)
    across = np.clip(int(np.floor(column)) + np.arange(-1, 3), 0, columns - 1)
    texels = image[down][:, across]
    value = np.einsum("r,c,rcx->x", counts(row % 1), counts(column % 1), texels)
    low, high = texels[1:3, 1:3].min(axis=(0, 1)), texels[1:3, 1:3].max(axis=(0, 1))
    least, most = 2 * low - high, 2 * high - low
    least, most = np.where(low >= 0, np.maximum(least, 0), least), np.where(high <= 1, np.minimum(most, 1), most)
    return np.clip(value, least, most)


@pytest.mark.parametrize("kind", ["colour", "data", "normal"])
@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
def test_a_copy_gives_back_every_stored_integer(kind, depth):
    values = np.random.default_rng(2).integers(0, np.iinfo(depth).max + 1, (31, 17, 3)).astype(depth)
    exemplar = Exemplar({"map": to_map(values, kind)})
    copied = gather_images(identity_sources(31, 17), exemplar, rows=31, columns=17)["map"]
    np.testing.assert_array_equal(stored(copied, copied.bits), values)


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
def test_every_colour_value_survives_linear_light(depth):
    values = np.arange(np.iinfo(depth).max + 1, dtype=depth).reshape(-1, 16, 1)
    np.testing.assert_array_equal(stored(to_map(values, "colour"), values.dtype.itemsize * 8), values)


def test_sites_match_the_naive_blend():
    rng, map = np.random.default_rng(3), noise()
    position = rng.uniform(-2, 10, (40, 3, 2)).astype(np.float32)
    weight = rng.dirichlet(np.ones(3), 40).astype(np.float32)
    weight[:5] = [1, 0, 0]
    expected = [
        sum(w * sample(map.image, *p) for p, w in zip(ps, ws, strict=True))
        for ps, ws in zip(position, weight, strict=True)
    ]
    np.testing.assert_allclose(gather_sites(SourceMap(position, weight), map), expected, atol=2e-6)


def test_points_match_the_naive_blend():
    rng, map = np.random.default_rng(4), noise(20, 20)
    position = rng.uniform(3, 16, (12, 2, 2)).astype(np.float32)
    weight = rng.dirichlet(np.ones(2), 12).astype(np.float32)
    turn, scale = rng.uniform(-3, 3, (12, 2)).astype(np.float32), rng.uniform(0.5, 2, (12, 2)).astype(np.float32)
    sites, barycentric = rng.integers(0, 12, (30, 3)), rng.dirichlet(np.ones(3), 30)
    offsets = rng.uniform(-1, 1, (30, 3, 2))
    found = gather_points(
        SourceMap(position, weight, turn, scale), map, sites, barycentric=barycentric, offsets=offsets
    )
    expected = np.zeros((30, 3))
    for i in range(30):
        for s, b, (row, column) in zip(sites[i], barycentric[i], offsets[i], strict=True):
            for k in range(2):
                cosine, sine = np.cos(turn[s, k]), np.sin(turn[s, k])
                moved = np.array([cosine * row + sine * column, cosine * column - sine * row]) / scale[s, k]
                expected[i] += b * weight[s, k] * sample(map.image, *(position[s, k] + moved))
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_corners_that_agree_show_the_exemplar_itself():
    """Three coherent sites reproduce the exemplar at any point between them, whatever the weights."""
    map, sources = noise(12, 12), identity_sources(12, 12)
    point, corners = np.array([4.3, 5.6]), np.array([[4, 5], [5, 5], [4, 6]])
    value = gather_points(
        sources,
        map,
        (corners[:, 0] * 12 + corners[:, 1])[None],
        barycentric=np.array([[0.1, 0.3, 0.6]]),
        offsets=(point - corners)[None],
    )
    np.testing.assert_allclose(value[0], sample(map.image, *point), atol=1e-6)


def read(image, place):
    sources = SourceMap(place.astype(np.float32)[:, None], np.ones((len(place), 1), np.float32))
    return gather_sites(sources, Map(image.astype(np.float32)[..., None], "data", 32))[:, 0]


def test_fine_waves_survive():
    """Waves of four texels half-way between texels: 94 % of them, where a bilinear read leaves 71 %."""
    waves = np.cos(np.arange(64) * np.pi / 2)[None] + np.zeros((8, 1))
    place = np.stack([np.full(24, 4.0), np.arange(20, 44) + 0.5], axis=1)
    np.testing.assert_allclose(read(waves, place) / np.cos(place[:, 1] * np.pi / 2), 0.943, atol=0.001)


def test_straight_slopes_are_kept():
    row, column = np.mgrid[:20, :20] / 100
    place = np.random.default_rng(8).uniform(1, 18, (200, 2))
    np.testing.assert_allclose(read(row + 3 * column, place), place @ [0.01, 0.03], atol=1e-6)


def test_what_is_flat_stays_flat_beside_an_edge():
    """Nothing rings into the texels beside: so nothing masked shows either."""
    step = np.where(np.arange(12) < 6, 0.2, 0.9)[None] + np.zeros((9, 1))
    place = np.random.default_rng(6).uniform(0, 8, (400, 2)) + [0, 2]
    shown = read(step, place)
    np.testing.assert_array_equal(shown[place[:, 1] <= 5], np.float32(0.2))
    np.testing.assert_array_equal(shown[place[:, 1] >= 6], np.float32(0.9))


def test_shares_stay_shares_and_light_stays_light():
    rng = np.random.default_rng(7)
    specks, place = rng.integers(0, 2, (12, 12)), rng.uniform(0, 11, (500, 2))
    shown = read(specks, place)
    assert shown.min() == 0 and shown.max() == 1
    bright = read(8 * specks, place)
    assert bright.min() == 0 and 8.1 < bright.max() < 16


def test_a_corner_that_does_not_count_may_have_no_site():
    map, sources = noise(12, 12), identity_sources(12, 12)
    points = {"barycentric": np.array([[0.0, 1.0, 0.0]]), "offsets": np.full((1, 3, 2), 0.25)}
    found = gather_points(sources, map, np.array([[-1, 50, -1]]), **points)
    np.testing.assert_allclose(found[0], sample(map.image, 4.25, 2.25), atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(turn=st.floats(-7, 7), more=st.floats(-7, 7))
def test_turns_of_normals_add_up_and_keep_lengths(turn, more):
    map = unit_normals()
    sources = identity_sources(8, 8)
    turned = SourceMap(sources.position, sources.weight, np.full((64, 1), turn, np.float32))
    once = gather_sites(turned, map)
    np.testing.assert_allclose(np.linalg.norm(2 * once - 1, axis=1), 1, atol=1e-5)
    sites = np.repeat(np.arange(64)[:, None], 3, axis=1)
    whole = {"barycentric": np.tile([1.0, 0, 0], (64, 1)), "offsets": np.zeros((64, 3, 2))}
    both = gather_points(turned, map, sites, **whole, frame_turn=np.full((64, 3), more))
    sum_turned = SourceMap(sources.position, sources.weight, np.full((64, 1), turn + more, np.float32))
    np.testing.assert_allclose(both, gather_sites(sum_turned, map), atol=1e-5)


def test_a_quarter_turn_sends_x_to_y():
    map = Map(np.array([[[1.0, 0.5, 0.5]]], np.float32), "normal", 8)
    sources = SourceMap(
        np.zeros((1, 1, 2), np.float32), np.ones((1, 1), np.float32), np.full((1, 1), np.pi / 2, np.float32)
    )
    np.testing.assert_allclose(gather_sites(sources, map)[0], [0.5, 1.0, 0.5], atol=1e-6)


def test_a_blend_of_normals_is_renormalised():
    map = Map(np.array([[[1.0, 0.5, 0.5], [0.5, 1.0, 0.5]]], np.float32), "normal", 8)
    sources = SourceMap(np.array([[[0, 0], [0, 1]]], np.float32), np.full((1, 2), 0.5, np.float32))
    half = 0.5 + 0.5 * np.sqrt(0.5)
    np.testing.assert_allclose(gather_sites(sources, map)[0], [half, half, 0.5], atol=1e-6)


def test_a_wrong_size_and_a_thin_normal_map_are_refused():
    with pytest.raises(ParameterError, match="3×5"):
        gather_images(identity_sources(4, 4), Exemplar({"a": noise(9, 9)}), rows=3, columns=5)
    with pytest.raises(ParameterError, match="3 channels"):
        gather_sites(identity_sources(4, 4), noise(channels=2, kind="normal"))
