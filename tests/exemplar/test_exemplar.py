"""An exemplar checks what enters, once, and says what is wrong with numbers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom.errors import ExemplarError
from texloom.exemplar.colour import decode, encode
from texloom.exemplar.exemplar import Exemplar, Map, from_array


def data(shape=(9, 10, 1), value=0.5):
    return Map(np.full(shape, value, np.float32), "data", 32)


@given(st.sampled_from([np.uint8, np.uint16]), st.integers(0, 2**16 - 1))
def test_encode_inverts_decode(dtype, value):
    stored = np.array([value % (np.iinfo(dtype).max + 1)], dtype)
    assert np.rint(encode(decode(stored)) * np.iinfo(dtype).max).astype(dtype) == stored


def test_decode_is_the_standard_curve():
    light = decode(np.array([0, 10, 188, 255], np.uint8))
    np.testing.assert_allclose(light, [0, 10 / 255 / 12.92, ((188 / 255 + 0.055) / 1.055) ** 2.4, 1], rtol=1e-6)


def test_arrays_of_every_type_become_maps():
    grey = from_array(np.full((8, 9), 128, np.uint8)).lead
    assert grey.image.shape == (8, 9, 1) and grey.bits == 8 and grey.kind == "colour"
    deep = from_array(np.full((8, 9), 32768, np.uint16), name="height").lead
    assert deep.bits == 16 and deep.kind == "data"
    np.testing.assert_allclose(deep.image, 32768 / 65535)
    light = from_array(np.full((8, 9, 3), 0.25, np.float32)).lead
    assert light.bits == 32
    np.testing.assert_array_equal(light.image, 0.25)


def test_a_fourth_channel_is_opacity():
    values = np.full((8, 8, 4), 255, np.uint8)
    values[2, 3, 3] = 0
    exemplar = from_array(values)
    assert exemplar.mask is not None and np.argwhere(~exemplar.mask).tolist() == [[2, 3]]
    assert exemplar.maps["alpha"].image.shape == (8, 8, 1)
    assert from_array(np.full((8, 8, 4), 255, np.uint8)).mask is None


def test_crop_cuts_every_map_and_the_mask():
    mask = np.arange(90).reshape(9, 10) % 4 > 0
    rows = np.broadcast_to(np.arange(9, dtype=np.float32)[:, None, None], (9, 10, 1))
    cropped = Exemplar({"height": Map(rows, "data", 32), "ao": data()}, mask).crop(slice(1, 9), slice(2, 10))
    assert cropped.shape == (8, 8)
    np.testing.assert_array_equal(cropped.maps["height"].image[:, 0, 0], np.arange(1, 9))
    np.testing.assert_array_equal(cropped.mask, mask[1:, 2:])


@pytest.mark.parametrize(
    "maps, mask, message",
    [
        ({}, None, "at least one map"),
        ({"height": data((7, 20, 1))}, None, "20x7 texels, but synthesis needs 8x8"),
        ({"height": data(), "ao": data((10, 9, 1))}, None, "height is 10x9 and ao is 9x10"),
        ({"height": data()}, np.ones((9, 9), bool), "mask is 9x9"),
        ({"height": data()}, np.zeros((9, 10), bool), "none of 90 texels"),
        ({"height": data(value=np.nan)}, None, "height has 90 texels that are NaN"),
    ],
)
def test_what_cannot_be_used_is_refused(maps, mask, message):
    with pytest.raises(ExemplarError, match=message):
        Exemplar(maps, mask)


@pytest.mark.parametrize("array", [np.zeros((8, 8), np.int64), np.zeros((8, 8, 5), np.uint8), np.zeros(8, np.uint8)])
def test_arrays_that_are_no_image_are_refused(array):
    with pytest.raises(ExemplarError):
        from_array(array)
