"""Every map that shows structure has its say in matching; flat maps have none."""

import numpy as np

from texloom.exemplar.colour import encode
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.exemplar.features import match_image, visible

RNG = np.random.default_rng(5)


def stack(mask=None, **images):
    kinds = {"basecolor": "colour", "normal": "normal"}
    return Exemplar({n: Map(i.astype(np.float32), kinds.get(n, "data"), 8) for n, i in images.items()}, mask)


def noise(channels, amount=0.5):
    return 0.5 + amount * (RNG.random((24, 20, channels)) - 0.5)


def test_a_lone_colour_is_its_encoded_self():
    colour = noise(3)
    np.testing.assert_array_equal(match_image(stack(basecolor=colour)), encode(colour.astype(np.float32)))


def test_a_faint_height_counts_as_much_as_a_strong_one():
    colour, height = noise(3), noise(1, 0.05)
    faint = match_image(stack(basecolor=colour, height=height))
    strong = match_image(stack(basecolor=colour, height=10 * height))
    assert faint.shape[2] == 4
    np.testing.assert_allclose(faint.var(axis=(0, 1)), strong.var(axis=(0, 1)), rtol=1e-3)
    np.testing.assert_allclose(faint[..., 3].var() / faint[..., :3].var(axis=(0, 1)).sum(), 0.5, rtol=1e-3)


def test_structure_in_height_alone_shows():
    flat = np.full((24, 20, 3), 0.5)
    image = match_image(stack(basecolor=flat, height=noise(1)))
    assert image[..., 3].var() > 100 * image[..., :3].var()


def test_flat_maps_have_no_say():
    flat = np.full((24, 20, 1), 0.7) + noise(1, 0.001)
    assert match_image(stack(basecolor=noise(3), roughness=flat)).shape[2] == 3


def test_many_maps_stay_few_channels():
    image = match_image(stack(basecolor=noise(3), normal=noise(3), height=noise(1), ao=noise(1), roughness=noise(1)))
    assert image.shape == (24, 20, 6)


def test_masked_texels_do_not_set_the_scale():
    mask = np.ones((24, 20), bool)
    mask[:5] = False
    colour, height = noise(3), noise(1)
    wild = height.copy()
    wild[:5] = 1000 * RNG.random((5, 20, 1))
    tame = match_image(stack(mask, basecolor=colour, height=height))
    np.testing.assert_allclose(match_image(stack(mask, basecolor=colour, height=wild))[5:], tame[5:], rtol=1e-4)


def test_a_normal_shows_its_two_components():
    normal = noise(3)
    np.testing.assert_array_equal(visible(stack(normal=normal).lead), normal[..., :2].astype(np.float32))
