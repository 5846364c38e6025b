"""Expansion moves: all seams together never cost more, and cuts are the cheapest there are."""

import itertools

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.samples import ball, blobs
from texloom.arrays import in_fours
from texloom.domain.domain import Domain
from texloom.domain.grid import Grid
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.expansion import Expansion, Proposal

IMAGE = in_fours(blobs(32).astype(np.float32) / 255)


def scattered(domain: Domain, seed: int = 0) -> tuple[Canvas, ndarray]:
    """A canvas of random texels, a part of which may change."""
    rng = np.random.default_rng(seed)
    position = rng.integers(0, 32, (domain.count, 2)).astype(np.float32)
    colour = IMAGE[tuple(position.astype(int).T)]
    canvas = Canvas(position, colour, np.zeros(domain.count, np.int32), np.zeros(domain.count, np.float32))
    return canvas, rng.random(domain.count) < 0.6


def proposal(domain: Domain, seed: int, cells: int | None = None) -> Proposal:
    rng = np.random.default_rng(seed)
    site = np.sort(rng.permutation(domain.count)[: domain.count // 2]).astype(np.int32)
    position = rng.uniform(-2, 33, (len(site), 2)).astype(np.float32)
    cell = np.arange(len(site)) if cells is None else rng.integers(0, cells, len(site))
    return Proposal(site, position, rng.uniform(0, 6, len(site)).astype(np.float32), cell)


@pytest.mark.parametrize("make", [lambda: Grid(9, 11), lambda: Grid(8, 8, wrap=True), ball])
def test_costs_are_kept_and_only_usable_texels_and_free_sites_change(make) -> None:
    domain = make()
    canvas, free = scattered(domain)
    usable = np.ones((32, 32), bool)
    usable[10:14] = False
    before = canvas.position.copy()
    expansion = Expansion(canvas, IMAGE, usable, domain, free)
    for move in range(6):
        shown = canvas.label.copy()
        took = expansion.propose(proposal(domain, move, 40 if move % 2 else None), 1 + move)
        assert np.count_nonzero(canvas.label != shown) == took
        again = Expansion(canvas, IMAGE, usable, domain, free).cost
        assert expansion.cost == pytest.approx(again, rel=1e-5)
    changed = canvas.label > 0
    assert changed.any() and not changed[~free].any()
    np.testing.assert_array_equal(canvas.position[~changed], before[~changed])
    texel = np.rint(canvas.position[changed]).astype(int)
    assert (texel >= 0).all() and (texel < 32).all() and usable[texel[:, 0], texel[:, 1]].all()


def coherent(sites: ndarray, shift: tuple[int, int], columns: int) -> Proposal:
    """A block of the sample over these sites of a plane."""
    position = np.stack(np.divmod(sites, columns), 1) + shift
    return Proposal(
        sites.astype(np.int32), position.astype(np.float32), np.zeros(len(sites), np.float32), np.arange(len(sites))
    )


@pytest.mark.parametrize("seed", range(4))
def test_a_block_takes_the_very_sites_that_make_the_whole_cheapest(seed: int) -> None:
    domain, usable = Grid(5, 5), np.ones((32, 32), bool)
    canvas, _ = scattered(domain, seed)
    first = coherent(np.arange(25), (3 + seed, 5), 5)
    canvas.position[:], canvas.colour[:] = first.position, IMAGE[tuple(first.position.astype(int).T)]
    free = np.zeros(25, bool)
    free[[6, 7, 8, 11, 12, 13, 16, 17]] = True
    canvas.position[~free] = canvas.position[~free] + 9
    canvas.colour[~free] = IMAGE[tuple(canvas.position[~free].astype(int).T)]
    block = coherent(np.flatnonzero(free), (11 + seed, 13), 5)

    def cost_of(takes: ndarray) -> float:
        other = Canvas(canvas.position.copy(), canvas.colour.copy(), canvas.label.copy(), canvas.turn.copy())
        taken = block.site[takes]
        other.position[taken] = block.position[takes]
        other.colour[taken] = IMAGE[tuple(block.position[takes].astype(int).T)]
        return Expansion(other, IMAGE, usable, domain, free).cost

    best = min(cost_of(np.array(takes)) for takes in itertools.product([False, True], repeat=len(block.site)))
    expansion = Expansion(canvas, IMAGE, usable, domain, free)
    expansion.propose(block, 1)
    assert expansion.cost == pytest.approx(best, rel=1e-5)


def test_cost_never_rises() -> None:
    domain = Grid(16, 16)
    canvas, free = scattered(domain)
    expansion = Expansion(canvas, IMAGE, np.ones((32, 32), bool), domain, free)
    costs = [expansion.cost]
    for move in range(8):
        expansion.propose(coherent(np.arange(256), (2 * move, 15 - move), 16), 1 + move)
        costs.append(expansion.cost)
    assert (np.diff(costs) <= 1e-3).all() and costs[-1] < 0.9 * costs[0]


def test_the_block_that_continues_everything_takes_all() -> None:
    domain, usable = Grid(12, 12), np.ones((32, 32), bool)
    canvas, _ = scattered(domain)
    whole = coherent(np.arange(144), (4, 6), 12)
    free = np.zeros((12, 12), bool)
    free[3:9, 2:8] = True
    known = ~free.ravel()
    canvas.position[known] = whole.position[known]
    canvas.colour[known] = IMAGE[tuple(whole.position[known].astype(int).T)]
    expansion = Expansion(canvas, IMAGE, usable, domain, free.ravel())
    assert expansion.propose(whole, 1) == 36
    assert expansion.cost == pytest.approx(0, abs=1e-6)
    assert (expansion.labels == 1).all()


def test_around_a_block_are_the_free_sites_a_few_steps_away() -> None:
    domain = Grid(9, 9)
    canvas, _ = scattered(domain)
    canvas.label[40] = 5
    free = np.ones((9, 9), bool)
    free[:, 6:] = False
    around = Expansion(canvas, IMAGE, np.ones((32, 32), bool), domain, free.ravel()).around(5, 2).reshape(9, 9)
    row, column = np.mgrid[:9, :9]
    steps = abs(row - 4) + abs(column - 4)
    np.testing.assert_array_equal(around, (steps > 0) & (steps <= 2) & (column < 6))
