"""Several samples joined: each texel lies where its part says, nothing mixes at borders, what differs is made alike."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom.errors import ExemplarError
from texloom.exemplar.exemplar import Exemplar, Map, from_array, kind_of
from texloom.exemplar.join import arrange, join
from texloom.output.gather import gather_sites
from texloom.sources import SourceMap

SIZES = st.lists(st.tuples(st.integers(8, 40), st.integers(8, 40)), min_size=2, max_size=7)


def flat(
    rows: int, columns: int, value: float, *, name: str = "basecolor", channels: int = 3, bits: int = 8
) -> Exemplar:
    return Exemplar({name: Map(np.full((rows, columns, channels), value, np.float32), kind_of(name), bits)})


def noise(rows: int, columns: int, seed: int) -> Exemplar:
    return from_array(np.random.default_rng(seed).integers(0, 256, (rows, columns, 3), np.uint8))


@given(SIZES)
def test_every_sample_lies_where_its_part_says(sizes):
    samples = [noise(*size, seed) for seed, size in enumerate(sizes)]
    joined = join(samples)
    assert [(part.rows, part.columns) for part in joined.parts] == sizes
    for sample, part in zip(samples, joined.parts, strict=True):
        np.testing.assert_array_equal(joined.exemplar.lead.image[part.slices], sample.lead.image)
    assert joined.exemplar.usable.sum() == sum(rows * columns for rows, columns in sizes)  # parts are disjoint


@given(SIZES)
def test_two_texels_around_each_sample_repeat_its_border(sizes):
    samples = [noise(*size, seed) for seed, size in enumerate(sizes)]
    joined = join(samples)
    image = joined.exemplar.lead.image
    for sample, part in zip(samples, joined.parts, strict=True):
        row, column = np.indices((part.rows + 4, part.columns + 4)) - 2
        there = part.row + row, part.column + column
        inside = (there[0] >= 0) & (there[1] >= 0) & (there[0] < image.shape[0]) & (there[1] < image.shape[1])
        nearest = sample.lead.image[row.clip(0, part.rows - 1), column.clip(0, part.columns - 1)]
        np.testing.assert_array_equal(image[there[0][inside], there[1][inside]], nearest[inside])


@given(SIZES)
def test_a_read_beyond_a_border_is_that_of_the_sample_alone(sizes):
    """Sources may lie up to a texel outside: there the joined exemplar shows what the sample would."""
    samples = [noise(*size, seed) for seed, size in enumerate(sizes)]
    joined = join(samples)
    for sample, part in zip(samples, joined.parts, strict=True):
        last = np.array([part.rows - 1, part.columns - 1])
        place = np.random.default_rng(0).uniform(-1, 2, (20, 2)).clip(-1, 1) * last + [[0.7, -0.9]]
        place = place.clip(-1, last + 1)

        def read(exemplar: Exemplar, at: np.ndarray) -> np.ndarray:
            position = at[:, None].astype(np.float32)
            return gather_sites(SourceMap(position, np.ones((len(at), 1), np.float32)), exemplar.lead)

        np.testing.assert_allclose(
            read(joined.exemplar, place + [part.row, part.column]), read(sample, place), atol=1e-4
        )


def test_a_part_is_used_alone_with_its_own_mask():
    mask = np.zeros((10, 12), bool)
    mask[2:, 3:] = True
    joined = join([flat(9, 8, 0.1), flat(10, 12, 0.2).with_mask(mask), flat(20, 20, 0.3)])
    second = joined.within(1)
    np.testing.assert_array_equal(second.usable[joined.parts[1].slices], mask)
    assert second.usable.sum() == mask.sum()
    assert joined.within(0, 2).usable.sum() == 9 * 8 + 20 * 20
    assert joined.within(1).maps is joined.exemplar.maps
    np.testing.assert_array_equal(joined.within(0, 1, 2).usable, joined.exemplar.usable)


def test_the_least_side_is_that_of_the_samples_in_use():
    joined = join([flat(30, 16, 0.1), flat(10, 40, 0.2)])
    assert joined.exemplar.least_side == 10
    assert joined.within(0).least_side == 16
    assert flat(30, 16, 0.1).least_side == 16
    mask = np.zeros((30, 16), bool)
    mask[3, 2] = mask[9, 10] = True
    assert flat(30, 16, 0.1).with_mask(mask).least_side == 7
    assert join([flat(30, 16, 0.1).with_mask(mask), flat(10, 40, 0.2)]).exemplar.least_side == 7


def test_one_sample_is_that_sample():
    sample = flat(9, 8, 0.1)
    joined = join([sample])
    assert joined.exemplar is sample and joined.within(0) is sample
    assert (joined.parts[0].rows, joined.parts[0].columns) == (9, 8)


def test_samples_joined_before_keep_their_parts():
    inner = join([flat(9, 8, 0.1), flat(10, 12, 0.2)])
    outer = join([flat(30, 30, 0.3), inner.exemplar])
    assert len(outer.parts) == 2 and len(outer.exemplar.parts) == 3
    for part, value in zip(outer.exemplar.parts, (0.3, 0.1, 0.2), strict=True):
        np.testing.assert_allclose(outer.exemplar.lead.image[part.slices], value)
        assert outer.exemplar.usable[part.slices].all()
    assert outer.exemplar.least_side == 8


def test_samples_lie_compactly_and_on_the_grid_of_the_search():
    assert join([flat(192, 192, 0.1)] * 2).exemplar.shape == (192, 392)
    assert join([flat(100, 100, 0.1)] * 9).exemplar.shape == (308, 308)
    parts = join([flat(13, 21, 0.1), flat(50, 9, 0.1), flat(8, 8, 0.1)]).parts
    assert all(part.row % 8 == 0 and part.column % 8 == 0 for part in parts)


def test_places_can_be_given():
    samples = [flat(9, 8, 0.1), flat(10, 12, 0.2)]
    parts = join(samples[::-1]).parts[::-1]
    joined = arrange(samples, parts)
    assert joined.parts == parts == joined.exemplar.parts
    np.testing.assert_allclose(joined.exemplar.lead.image[parts[0].slices], 0.1)


def test_grey_becomes_colour_and_the_deepest_depth_is_kept():
    joined = join([flat(8, 8, 0.25, channels=1, bits=8), flat(8, 8, 0.5, channels=3, bits=16)])
    lead = joined.exemplar.lead
    assert lead.image.shape[2] == 3 and lead.bits == 16 and lead.kind == "colour"
    np.testing.assert_array_equal(lead.image[joined.parts[0].slices], np.float32(0.25))


def test_maps_that_some_lack_are_dropped_and_named():
    first = Exemplar(dict(flat(8, 8, 0.1).maps) | dict(flat(8, 8, 0.2, name="height", channels=1).maps))
    second = Exemplar(
        dict(flat(9, 9, 0.3, name="height", channels=1).maps)
        | dict(flat(9, 9, 0.1).maps)
        | dict(flat(9, 9, 0.1, name="ao", channels=1).maps)
    )
    joined = join([first, second])
    assert list(joined.exemplar.maps) == ["basecolor", "height"] and joined.dropped == ("ao",)
    only = join([first, flat(8, 8, 0.2, name="height", channels=1)])
    assert list(only.exemplar.maps) == ["height"] and only.dropped == ("basecolor",)


def test_where_one_sample_has_opacity_the_others_are_opaque():
    values = np.full((8, 9, 4), 100, np.uint8)
    values[0, 0, 3] = 0
    joined = join([flat(8, 8, 0.5), from_array(values)])
    alpha = joined.exemplar.maps["alpha"].image
    assert list(joined.exemplar.maps) == ["basecolor", "alpha"] and not joined.dropped
    np.testing.assert_array_equal(alpha[joined.parts[0].slices], 1.0)
    np.testing.assert_array_equal(alpha[joined.parts[1].slices][..., 0] * 255, values[..., 3])
    assert not joined.exemplar.usable[joined.parts[1].row, joined.parts[1].column]


@pytest.mark.parametrize(
    ("samples", "message"),
    [
        ([], "no sample to join"),
        ([flat(8, 8, 0.1), flat(8, 8, 0.1, name="height", channels=1)], "sample 2 has height"),
        ([flat(8, 8, 0.1, channels=2), flat(8, 8, 0.1)], r"basecolor differs .* \(2 of colour, 3 of colour\)"),
    ],
)
def test_what_cannot_be_joined_is_said(samples, message):
    with pytest.raises(ExemplarError, match=message):
        join(samples)
