"""A canvas continued from level to level: what is coherent stays coherent, and costs nothing to look at."""

import numpy as np
import pytest

from tests import naive
from tests.rolled import TEXEL, inner, rolled, turned, unrolled
from tests.synthesis.samples import blobs
from texloom.arrays import in_fours
from texloom.domain.levels import Beside, lay_levels
from texloom.domain.surface import Surface
from texloom.exemplar.pyramid import gaussian_pyramid
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.visits import Guide, Visits

MIDDLE = np.array([25.0, 40.0])  # texel of the sample where the plane's origin lies
SAMPLE = in_fours(blobs(80).astype(np.float32) / np.float32(255))
ORDERS = pytest.mark.parametrize("order", [1, 2, 4, 6])


def laid_out(domain: Surface) -> Canvas:
    """The sample on a rolled plane, one texel of the finest level a texel: one picture, whatever the frames."""
    texels = round(domain.texel / TEXEL)
    canvas = Canvas.empty(domain.count, 4)
    canvas.position[:] = (MIDDLE + unrolled(domain)) / texels
    canvas.turn[:], canvas.label[:] = turned(domain), 0
    image = gaussian_pyramid(SAMPLE, 3)[int(np.log2(texels))].image
    canvas.colour[:] = [naive.bilinear(image, *place) for place in canvas.position]
    return canvas


@ORDERS
def test_a_picture_continued_to_finer_levels_is_the_same_picture(order: int) -> None:
    """Also where the frames of a symmetric field change from one of its directions to the next."""
    surface = rolled(order)
    levels = lay_levels(surface, 3)
    finer = (*levels.domains[1:], surface)
    for coarse, fine, beside in zip(levels.domains, finer, levels.onto, strict=True):
        scale = coarse.texel / fine.texel
        image = SAMPLE if fine.texel == pytest.approx(TEXEL) else gaussian_pyramid(SAMPLE, 2)[1].image
        ours, expected = laid_out(coarse).continued(beside, image, scale), laid_out(fine)
        sites = inner(fine, 3)
        np.testing.assert_allclose(ours.position[sites], expected.position[sites], atol=0.01)
        np.testing.assert_allclose(np.cos(ours.turn - expected.turn)[sites], 1, atol=1e-5)
        np.testing.assert_allclose(ours.colour[sites], expected.colour[sites], atol=0.01)
        assert (ours.label == 0).all()


@ORDERS
@pytest.mark.parametrize("in_order", [True, False])
def test_one_picture_costs_nothing_and_stays(order: int, in_order: bool) -> None:
    """Neighbourhoods, stencils and sources agree about frames: what all sites show is what each sees around it."""
    domain = lay_levels(rolled(order), 1).domains[0]
    canvas = laid_out(domain)
    usable = np.ones(SAMPLE.shape[:2], np.uint8)
    guide = Guide(SAMPLE, usable, np.zeros((*SAMPLE.shape[:2], 0, 2), np.int32))
    everything = np.arange(domain.count, dtype=np.int32)
    visits = Visits(guide, canvas, domain.neighbourhoods(everything, 1), domain.stencils(7))
    before = canvas.position.copy()
    (visits.in_order if in_order else visits.at_once)(everything)
    sites = inner(domain, 6)
    assert visits.cost[sites].max() < 0.02 * SAMPLE.var(axis=(0, 1)).sum()
    np.testing.assert_allclose(canvas.position[sites], before[sites], atol=0.31)


def test_between_sites_a_source_goes_on_in_its_own_axes() -> None:
    """A quarter turn: what lies a row down in the site's frame lies a column on in the sample."""
    canvas = Canvas.empty(2, 4)
    canvas.position[:], canvas.turn[:], canvas.label[:] = [[10, 12], [4, 5]], [np.pi / 2, 0], [3, -1]
    beside = Beside(
        np.array([0, 0, 1], np.int32),
        np.array([[0.5, 0.0], [0.0, 0.5], [0.25, -0.5]], np.float32),
        np.array([0.0, -np.pi / 2, np.pi], np.float32),
    )
    ours = canvas.continued(beside, SAMPLE, 2.0)
    np.testing.assert_allclose(ours.position, [[20, 23], [21, 24], [8.5, 9]], atol=1e-5)
    np.testing.assert_allclose(ours.turn, [np.pi / 2, 0, np.pi], atol=1e-6)
    np.testing.assert_array_equal(ours.label, [3, 3, -1])
    np.testing.assert_allclose(ours.colour, [naive.bilinear(SAMPLE, *place) for place in ours.position], atol=1e-5)


def test_beyond_the_border_the_border_is_shown() -> None:
    canvas = Canvas.empty(1, 4)
    canvas.position[:] = [[-0.5, 79.4]]
    beside = Beside(np.zeros(1, np.int32), np.array([[-0.25, 0.4]], np.float32), np.zeros(1, np.float32))
    np.testing.assert_allclose(canvas.continued(beside, SAMPLE, 1.0).colour, SAMPLE[None, 0, 79], atol=1e-6)
