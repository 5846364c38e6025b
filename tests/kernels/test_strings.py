"""What a string costs at a place between texels, where a step leads from there, and what a box hides."""

import numpy as np
import warp as wp
from numpy import ndarray

from tests.naive import bilinear
from texloom.kernels.launch import launch
from texloom.kernels.strings import fit_between, hidden_texels, nudged

RNG = np.random.default_rng(5)
ROWS, COLUMNS, POINTS = 14, 17, 6


@wp.kernel(enable_backward=False)
def probe(
    start: int, place: wp.array(dtype=wp.vec2), enough: float, by_colour: int, image: wp.array(dtype=float),
    channels: int, labels: wp.array2d(dtype=wp.int16), flat: wp.array(dtype=wp.int16),
    distance: wp.array2d(dtype=float), texton: wp.array(dtype=int), offset: wp.array(dtype=wp.vec2i),
    wanted: wp.array(dtype=float), hidden: wp.array2d(dtype=int),
    error: wp.array(dtype=float), step: wp.array(dtype=wp.vec2), masked: wp.array(dtype=int),
):  # fmt: skip
    """All three, for the string from 2 on."""
    i = start + wp.tid()
    length = texton.shape[0] - 2
    rows = labels.shape[0]
    columns = labels.shape[1]
    error[i] = fit_between(
        place[i], 2, length, enough, by_colour, rows, columns, image, channels, flat, distance, texton, offset, wanted
    )
    step[i] = nudged(place[i], 2, length, rows, columns, image, channels, offset, wanted)
    masked[i] = hidden_texels(place[i], place[i] + wp.vec2(2.5, 3.0), hidden)


def probed(
    place: ndarray, image: ndarray, labels: ndarray, distance: ndarray, string: tuple[ndarray, ndarray, ndarray],
    *, mask: ndarray | None = None, enough: float = 1e9, by_colour: bool = True,
) -> tuple[ndarray, ndarray, ndarray]:  # fmt: skip
    """Errors, places after a step, and masked texels, at places (column, row)."""
    texton, offset, wanted = (np.concatenate([part[:2], part]) for part in string)  # two of another string before
    hidden = np.pad((~mask).cumsum(0).cumsum(1), ((1, 0), (1, 0))) if mask is not None else np.zeros((1, 1))
    inputs = [place.astype(np.float32), enough, int(by_colour), image.astype(np.float32).reshape(-1), image.shape[2]]
    inputs += [labels.astype(np.int16), labels.astype(np.int16).reshape(-1), distance.astype(np.float32)]
    inputs += [texton.astype(np.int32), offset.astype(np.int32), wanted.astype(np.float32).reshape(-1)]
    outputs = [np.empty(len(place), np.float32), np.empty((len(place), 2), np.float32), np.empty(len(place), np.int32)]
    launch(probe, len(place), inputs=[*inputs, hidden.astype(np.int32)], outputs=outputs)
    return outputs[0], outputs[1], outputs[2]


def anything() -> tuple[ndarray, ndarray, ndarray, tuple[ndarray, ndarray, ndarray]]:
    """Image, labels with one masked texel, distances, and a string (textons, offsets, colours wanted)."""
    labels = RNG.integers(0, 5, (ROWS, COLUMNS))
    labels[7, 7] = -1
    offset = RNG.integers(-3, 4, (POINTS, 2))
    string = RNG.integers(0, 5, POINTS), offset, RNG.random((POINTS, 3))
    return RNG.random((ROWS, COLUMNS, 3)), labels, RNG.random((5, 5)), string


def test_colours_are_bilinear_and_textons_those_of_the_nearest_texel_also_at_borders():
    image, labels, distance, string = anything()
    place = RNG.random((300, 2)) * [COLUMNS - 1, ROWS - 1]  # offsets lead up to three texels beyond the sample
    place[:3] = [0, 0], [COLUMNS - 1, ROWS - 1], [0.5, ROWS - 1.5]
    for by_colour in (True, False):
        error, _, _ = probed(place, image, labels, distance, string, by_colour=by_colour)
        for i, (column, row) in enumerate(place.astype(np.float32).astype(float)):
            expected = 0.0
            for texton, (dc, dr), wanted in zip(*string, strict=True):
                r, c = row + dr, column + dc
                near = labels[
                    tuple(np.clip([int(np.floor(r + 0.5)), int(np.floor(c + 0.5))], 0, [ROWS - 1, COLUMNS - 1]))
                ]
                expected += distance[texton, near] if near >= 0 else 1e6
                expected += by_colour * np.sqrt(((bilinear(image, r, c) - wanted) ** 2).sum())
            np.testing.assert_allclose(error[i], expected, rtol=1e-4)


def test_a_string_is_given_up_where_it_cannot_win():
    image, labels, distance, string = anything()
    labels[labels < 0] = 0
    place = RNG.random((50, 2)) * [COLUMNS - 1, ROWS - 1]
    whole, _, _ = probed(place, image, labels, distance, string)
    given_up, _, _ = probed(place, image, labels, distance, string, enough=float(np.median(whole)))
    wins = whole <= np.median(whole)
    np.testing.assert_array_equal(given_up[wins], whole[wins])
    assert (given_up[~wins] > np.median(whole)).all() and (given_up <= whole).all() and (given_up < whole).any()


def test_steps_lead_to_where_the_colours_are():
    row, column = np.mgrid[:ROWS, :COLUMNS]
    image = np.stack([np.sin(row / 4 + column / 7), np.cos(column / 5 - row / 9), row * column / 99], axis=-1)
    offset = RNG.integers(-3, 4, (POINTS, 2))
    target = np.array([8.3, 6.6])
    wanted = np.stack([bilinear(image, target[1] + dr, target[0] + dc) for dc, dr in offset])
    string = np.zeros(POINTS, int), offset, wanted
    at = target + RNG.uniform(-0.6, 0.6, (40, 2))
    for _ in range(3):
        _, at, _ = probed(at, image, np.zeros((ROWS, COLUMNS)), np.zeros((1, 1)), string)
    np.testing.assert_allclose(at, np.broadcast_to(target, at.shape), atol=1e-2)
    far = target + RNG.uniform(-5, 5, (40, 2))
    _, at, _ = probed(far, image, np.zeros((ROWS, COLUMNS)), np.zeros((1, 1)), string)
    assert (np.abs(at - far) <= 1 + 1e-5).all()


def test_a_plain_image_leads_nowhere():
    string = np.zeros(POINTS, int), RNG.integers(-3, 4, (POINTS, 2)), np.zeros((POINTS, 3))
    place = RNG.random((9, 2)) * 8
    _, at, _ = probed(place, np.ones((ROWS, COLUMNS, 3)), np.zeros((ROWS, COLUMNS)), np.zeros((1, 1)), string)
    np.testing.assert_array_equal(at, place.astype(np.float32))


def test_every_texel_that_a_box_touches_counts():
    image, labels, distance, string = anything()
    mask = RNG.random((ROWS, COLUMNS)) < 0.8
    place = np.concatenate([RNG.random((200, 2)) * [13, 10], [[0, 0], [3, 2], [13.5, 10]]])
    _, _, masked = probed(place, image, labels, distance, string, mask=mask)
    for i, (column, row) in enumerate(place):
        under = ~mask[int(row) : int(np.ceil(row + 3)) + 1, int(column) : int(np.ceil(column + 2.5)) + 1]
        assert masked[i] == under.sum()
