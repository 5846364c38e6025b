"""From patches to sources: positions, shares, and sites without a patch."""

import numpy as np
import pytest

from tests.synthesis.samples import ball
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.synthesis.layers import MOST, feathered, heaviest

DOMAINS = pytest.mark.parametrize(
    "domain", [Grid(20, 17), Grid(20, 17, wrap=True), ball()], ids=["plane", "torus", "ball"]
)

WIDE = (1 << 20, 1 << 20)  # an exemplar whose border is out of reach


@DOMAINS
@pytest.mark.parametrize("how", ["heaviest", "feathered"])
def test_every_site_has_up_to_four_sources_heaviest_first(domain: Domain, how: str) -> None:
    rng = np.random.default_rng(0)
    patches = domain.patches(domain.centres(3, 0), 8)
    anchors = rng.integers(0, 25, (patches.count, 2)).astype(np.int32)
    if how == "heaviest":
        sources = heaviest(domain, patches, anchors, rng.random(patches.count).astype(np.float32), WIDE)
    else:
        sources = feathered(domain, patches, anchors, rng.permutation(patches.count).astype(np.int32), 3, WIDE)
    assert sources.position.shape == (domain.count, MOST, 2)
    np.testing.assert_allclose(sources.weight.sum(1), 1, atol=1e-6)
    assert (sources.weight >= 0).all() and (np.diff(sources.weight, axis=1) <= 0).all()
    # Every source is one of the site's patches at the site's own place in it.
    site = int(np.diff(patches.cover_start).argmax())
    entries = slice(*patches.cover_start[site : site + 2])
    offered = anchors[patches.cover_patch[entries]] + patches.cover_position[entries]
    for place in sources.position[site, sources.weight[site] > 0]:
        assert np.abs(offered - place).sum(1).min() < 1e-4


def test_one_patch_over_all_is_a_copy() -> None:
    grid = Grid(9, 9)
    patches = grid.patches(np.array([40], np.int32), 9)
    anchors, once = np.array([[3, 5]], np.int32), np.ones(1, np.float32)
    for sources in (
        heaviest(grid, patches, anchors, once, WIDE),
        feathered(grid, patches, anchors, np.zeros(1, np.int32), 4, WIDE),
    ):
        np.testing.assert_array_equal(sources.position[:, 0], np.stack(np.divmod(np.arange(81), 9), 1) + [3, 5])
        np.testing.assert_array_equal(sources.weight[:, 0], 1)


def test_sites_without_a_patch_continue_their_neighbours() -> None:
    grid = Grid(12, 12)
    patches = grid.patches(np.array([6 * 12 + 6], np.int32), 6)
    sources = heaviest(grid, patches, np.array([[10, 20]], np.int32), np.ones(1, np.float32), WIDE)
    expected = np.stack(np.divmod(np.arange(144), 12), 1) + np.array([10, 20]) - 3
    np.testing.assert_array_equal(sources.position[:, 0], expected)
    np.testing.assert_array_equal(sources.weight[:, 0], 1)
