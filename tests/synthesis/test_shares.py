"""Several samples: each is shown its share, in regions that hold together; a single one in use changes nothing."""

from dataclasses import replace

import numpy as np
import pytest

from tests.data import DATA, needs_data
from tests.synthesis.samples import exemplar
from texloom.arrays import in_fours
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.exemplar.features import match_image
from texloom.exemplar.join import Joined, join
from texloom.io.stack import read_exemplar
from texloom.search.blocks import BlockSearch
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.result import Result
from texloom.synthesis.shares import Shares
from texloom.synthesis.synthesize import synthesize
from texloom.synthesis.usage import Usage

DOMAIN = Grid(160, 160)


def grain(size: int, tone: int) -> Exemplar:
    """Noise around a tone: two of them have nothing in common."""
    return from_array((tone + np.random.default_rng(tone).integers(0, 60, (size, size, 3))).astype(np.uint8))


def part_of(joined: Joined, result: Result) -> np.ndarray:
    """The sample that each site shows."""
    row, column = np.rint(result.sources.position[:, 0]).T
    found = np.full(len(row), -1)
    for number, part in enumerate(joined.parts):
        down, across = row - part.row, column - part.column
        found[(down >= 0) & (down < part.rows) & (across >= 0) & (across < part.columns)] = number
    assert (found >= 0).all()
    return found


@pytest.mark.parametrize("seed", [0, 1])
def test_unlike_samples_get_their_shares_in_regions(seed: int) -> None:
    joined = join([grain(48, 20), grain(72, 170), grain(56, 90)])
    shown = part_of(joined, synthesize(joined.exemplar, DOMAIN, PatchSampling(), seed=seed)).reshape(DOMAIN.shape)
    area = np.array([part.rows * part.columns for part in joined.parts])
    share = np.bincount(shown.ravel(), minlength=3) / shown.size
    np.testing.assert_allclose(share, area / area.sum(), atol=0.16)
    borders = (np.diff(shown, axis=0) != 0).mean() + (np.diff(shown, axis=1) != 0).mean()
    assert borders < 0.07  # turns at every block of 12 would give twice as many


def test_without_balance_nobody_takes_turns() -> None:
    joined = join([grain(48, 20), grain(48, 170)])
    shown = part_of(joined, synthesize(joined.exemplar, DOMAIN, PatchSampling(balance=0)))
    assert np.bincount(shown, minlength=2).min() == 0


def test_the_seed_decides_where() -> None:
    joined = join([grain(48, 20), grain(48, 170)])
    one, other = (part_of(joined, synthesize(joined.exemplar, DOMAIN, PatchSampling(), seed=seed)) for seed in (0, 1))
    assert (one != other).mean() > 0.1


def test_one_sample_in_use_grows_as_if_there_were_no_others() -> None:
    alone = join([exemplar(48), exemplar(64, seed=3)]).within(1)
    one, other = (synthesize(sample, DOMAIN, PatchSampling()) for sample in (alone, replace(alone, parts=())))
    np.testing.assert_array_equal(one.sources.position, other.sources.position)


def test_what_is_shown_too_little_is_let_off_in_proportion() -> None:
    joined = join([exemplar(48), exemplar(32, seed=3), exemplar(40, seed=5)])
    stack = joined.within(0, 1)
    search = BlockSearch(in_fours(match_image(stack)), 16, stack.mask)
    usage, shares = Usage(search), Shares.of(search, stack.parts)
    assert shares is not None and shares.parts == joined.parts[:2]  # the third is not in use
    assert shares.texels.tolist() == [48 * 48, 32 * 32]
    np.testing.assert_array_equal(np.sort(np.concatenate(shares.blocks)), np.arange(len(search.anchors)))
    np.testing.assert_array_equal(shares.behind(usage), 0)

    texels = np.argwhere(np.ones((48, 48), bool)).astype(np.float32) + (joined.parts[0].row, joined.parts[0].column)
    usage.add(texels.astype(np.float32), np.ones(len(texels), np.float32))
    assert usage.shown(joined.parts[0]) == 48 * 48 and usage.shown(joined.parts[1]) == 0
    mean = 48**2 / (48**2 + 32**2)
    np.testing.assert_allclose(shares.behind(usage), [0, 1 / mean])

    cost = np.ones((2, len(search.anchors)), np.float32)
    cost[:, shares.blocks[1]] = 4
    cost[1, shares.blocks[1][0]] = 3
    off = shares.let_off(cost, np.array([0.5, 0.25], np.float32), usage)
    assert not off[:, shares.blocks[0]].any()
    np.testing.assert_allclose(off[:, shares.blocks[1]].max(1), np.array([3 * 0.5, 2 * 0.25]) * 2 / mean, rtol=1e-6)


@needs_data
def test_grass_and_gravel_share() -> None:
    samples = [read_exemplar(DATA / "exemplars" / f"{name}.png") for name in ("grass-green-290x272", "gravel-grey-512")]
    joined = join([sample.crop(slice(0, 192), slice(0, 192)) for sample in samples])
    shown = part_of(joined, synthesize(joined.exemplar, Grid(320, 320), PatchSampling(), seed=1))
    assert np.bincount(shown, minlength=2).min() > 0.3 * shown.size
