"""The fair share: what is counted is what is shown."""

import numpy as np
import pytest

from tests.synthesis.samples import ball, blobs, exemplar, holes
from texloom.arrays import in_fours
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import from_array
from texloom.exemplar.features import match_image
from texloom.search.blocks import BlockSearch
from texloom.synthesis import expansion
from texloom.synthesis.blocks import BlockGrowth
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.schedule import batches, overlaps
from texloom.synthesis.seams import ring
from texloom.synthesis.synthesize import synthesize
from texloom.synthesis.usage import Usage


@pytest.mark.parametrize("domain", [Grid(40, 37), Grid(40, 37, wrap=True), ball()], ids=["plane", "torus", "sphere"])
def test_usage_equals_a_recount_from_the_canvas(domain: Domain, monkeypatch: pytest.MonkeyPatch) -> None:
    counted: list[Usage] = []
    monkeypatch.setattr("texloom.synthesis.blocks.Usage", lambda search: counted.append(Usage(search)) or counted[-1])
    image = in_fours(match_image(exemplar(33)))
    patches = domain.patches(domain.centres(8, 0), 12)
    shared = overlaps(patches)
    canvas, search = Canvas.empty(domain.count, image.shape[2]), BlockSearch(image, 12)
    growth = BlockGrowth(patches, search, ring(12, 4), domain.area, 0.4, 0)
    growth.run(canvas, batches(np.arange(patches.count, dtype=np.int32), shared), lambda stage, done: None)

    recount = Usage(search)
    shown = canvas.label >= 0
    recount.add(canvas.position[shown], domain.area[shown])
    assert recount.excess().max() > 0
    np.testing.assert_allclose(counted[0].excess(), recount.excess(), atol=1e-4)


@pytest.mark.parametrize("mask", [None, holes(32)], ids=["whole", "masked"])
def test_a_sample_shown_once_everywhere_is_used_its_fair_share(mask: np.ndarray | None) -> None:
    search = BlockSearch(in_fours(blobs(32).astype(np.float32)), 8, mask)
    usage = Usage(search)
    assert (usage.excess() == 0).all()
    usable = np.argwhere(np.ones((32, 32), bool) if mask is None else mask).astype(np.float32)
    usage.add(usable, np.ones(len(usable), np.float32))
    np.testing.assert_allclose(usage.excess(), 1, atol=1e-6)
    usage.add(usable, -np.ones(len(usable), np.float32))
    np.testing.assert_allclose(usage.excess(), 0, atol=1e-6)


def test_a_block_shown_often_is_in_excess() -> None:
    usage = Usage(search := BlockSearch(in_fours(blobs(32).astype(np.float32)), 8))
    at = np.stack(np.mgrid[8:16, 8:16], -1).reshape(-1, 2).astype(np.float32)
    usage.add(at, np.full(64, 50, np.float32))
    assert (search.anchors[usage.excess().argmax()] == 8).all()
    assert usage.excess().max() == pytest.approx(16)  # all of the use in a sixteenth of the sample


def test_use_around_a_position_is_in_fair_shares():
    """Four cells; all that is shown lies in one, which is four times its share, counted as three."""
    usage = Usage(BlockSearch(np.zeros((16, 16, 4), np.float32), 8, step=8))
    usage.add(np.full((200, 2), 3, np.float32), np.ones(200, np.float32))
    places = np.array([[0, 0], [7, 7], [8, 0], [0, 15]], np.float32)
    np.testing.assert_allclose(usage.excess_at(places), [3, 3, 0, 0])
    usage.add(np.full((200, 2), 12, np.float32), np.ones(200, np.float32))
    np.testing.assert_allclose(usage.excess_at(places), [2, 2, 0, 0])


def test_blocks_that_settle_do_not_drop_what_is_not_plain(monkeypatch):
    """Half of the sample is plain, where seams cost nothing: by seams alone little else is left."""
    image = np.full((48, 48, 3), 0.5, np.float32)
    image[:, 24:] = 0.35 + 0.3 * np.random.default_rng(0).random((48, 24, 3))
    sample, domain, method = from_array(image), Grid(96, 96), PatchSampling(patch=16, settle=True)

    def plain() -> float:
        return float((synthesize(sample, domain, method, seed=2).sources.position[:, 0, 1] < 24).mean())

    even = plain()
    monkeypatch.setattr(expansion, "_BALANCE", 0.0)
    assert even < 0.86 < plain()
