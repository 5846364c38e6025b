"""Pictures of textons: one colour a texton, and what each looks like."""

import numpy as np

from texloom.exemplar.exemplar import from_array
from texloom.output.textons_picture import texton_colours, texton_tiles
from texloom.search.textons import learn_textons

RNG = np.random.default_rng(4)


def test_every_texton_has_its_colour():
    mask = np.ones((40, 32), bool)
    mask[:6] = False
    textons = learn_textons(from_array(RNG.integers(0, 256, (40, 32), dtype=np.uint8), mask=mask), orientations=2)
    for turn in (0, 1):
        colours = texton_colours(textons, turn)
        assert colours.shape == (40, 32, 3) and (colours[:6] == colours[0, 0]).all()
        pairs = {
            (label, tuple(colour))
            for label, colour in zip(textons.labels[turn].ravel(), colours.reshape(-1, 3), strict=True)
        }
        assert len(pairs) == len({label for label, _ in pairs}) == len({colour for _, colour in pairs})


def test_tiles_show_the_mean_window_of_the_commonest_first():
    rows = (np.arange(48)[:, None] // 12 % 2 * 255 + np.zeros(48, int)).astype(np.uint8)
    textons = learn_textons(from_array(rows), count=6, width=5, orientations=1)
    sheet = texton_tiles(textons)[::3, ::3, 0]
    commonest = np.argmax(np.diff(textons.bucket_start))
    padded = np.pad(rows, 2, mode="symmetric")
    at = np.argwhere(textons.labels[0] == commonest)
    mean = np.mean([padded[row : row + 5, column : column + 5] for row, column in at], axis=0)
    np.testing.assert_allclose(sheet[:5, :5], mean, atol=0.51)
    assert (sheet[5] == 255).all()
