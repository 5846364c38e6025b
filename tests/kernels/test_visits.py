"""Visits of sites against their oracle: samples between sites, windows from a tree, turned frames, in order."""

from dataclasses import replace

import numpy as np
import pytest
from numpy import ndarray

from tests import naive
from texloom.domain.neighbourhoods import Neighbourhoods, Stencils
from texloom.kernels.launch import thread_count, use
from texloom.search.window_tree import WindowTree
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.visits import Guide, Visits

ROWS, COLUMNS, SIZE = 9, 8, (17, 15)
STEPS = np.stack(np.divmod(np.arange(9), 3), 1).astype(np.int32) - 1  # the samples of a stencil
LIKE_A_SCAN = np.array([0, 1, 2, 3], np.int32)
EVERY = np.arange(9, dtype=np.int32)


class Scene:
    """A torus of sites in turned frames that show patches of a random image; each sample lies between three sites."""

    def __init__(self, seed: int, *, asks_tree: bool, samples: ndarray) -> None:
        rng = np.random.default_rng(seed)
        count = ROWS * COLUMNS
        site = np.stack(np.divmod(np.arange(count), COLUMNS), 1)
        self.image = rng.random((*SIZE, 4), np.float32)
        self.usable = np.zeros(SIZE, np.uint8)
        self.usable[1:-2, 1:-2] = rng.random((SIZE[0] - 3, SIZE[1] - 3)) < 0.9
        similar = np.stack([rng.integers(0, n, (*SIZE, 2)) for n in SIZE], -1).astype(np.int32)
        there = site[:, None] + STEPS[[4, 0, 1, 2, 3, 5, 6, 7, 8]]  # the middle one first
        near = (there % [ROWS, COLUMNS] @ [COLUMNS, 1]).astype(np.int32)
        near[rng.random(near.shape) < 0.1] = -1
        near[:, 0] = np.arange(count)
        offset = (there - site[:, None] + rng.random(there.shape) * 0.6 - 0.3).astype(np.float32)
        offset[:, 0] = 0
        quarter = np.float32(np.pi / 2)
        turn = rng.integers(-1, 3, near.shape).astype(np.float32) * quarter
        turn[:, 0] = 0
        self.around = Neighbourhoods(near, offset, turn)
        corners = rng.integers(-1, count, (count, 9, 3)).astype(np.int32)
        weights = rng.dirichlet([1, 1, 1], (count, 9)).astype(np.float32)
        self.stencils = Stencils(corners, weights, STEPS.astype(np.float32)[None])
        self.samples = samples
        tree = None
        if asks_tree:
            tree = WindowTree.of(self.image, self.usable, STEPS[samples], 6)
        self.guide = Guide(self.image, self.usable, similar, tree=tree)
        self.canvas = Canvas.empty(count, 4)
        self.canvas.position[:] = rng.random((count, 2)) * [SIZE[0] - 1, SIZE[1] - 1]
        self.canvas.turn[:] = rng.integers(0, 4, count) * quarter
        self.canvas.label[:] = np.where(rng.random(count) < 0.15, -1, 0)
        self.canvas.colour[:] = rng.random((count, 4))
        self.cost = np.zeros(count)

    def visits(self) -> Visits:
        return Visits(self.guide, self.canvas, self.around, self.stencils, self.samples)

    def seen(self) -> tuple[ndarray, ndarray]:
        """What all samples show now, and which are known."""
        weights = self.stencils.weights
        assert weights is not None
        return naive.read_patches(self.stencils.sites, weights, self.canvas.colour, self.canvas.label)

    def visit_slowly(self, own: int) -> tuple[ndarray, float, float]:
        """What the oracle finds for a site on the canvas as it is."""
        seen, known = (part[own, self.samples] for part in self.seen())
        window = None
        if self.guide.tree is not None:
            tree, steps = self.guide.tree, STEPS[self.samples]
            windows = self.image[tuple(np.moveaxis(tree.centre[:, None] + steps, 2, 0))]
            wanted = np.where(known[:, None] > 0, seen, tree.mean)  # what is unknown counts as the mean
            window = tree.centre[naive.nearest_window(windows, tree.mean, tree.axes, wanted)].astype(float)
        guide, canvas, around = self.guide, self.canvas, self.around
        assert around.turn is not None
        return naive.correct_site(
            *(guide.image, guide.usable, guide.similar),
            (around.sites[own], around.offset[own], around.turn[own]),
            (canvas.position, canvas.turn, canvas.label),
            (STEPS[self.samples].astype(float), seen, known),
            guide.candidates,
            window,
        )

    def show(self, own: int, position: ndarray, turn: float) -> None:
        """The site shows a place, its own again or another."""
        canvas = self.canvas
        if not np.array_equal(canvas.position[own], position) or canvas.turn[own] != turn:
            canvas.position[own], canvas.turn[own] = position, turn
            canvas.colour[own] = naive.bilinear(self.image, *position)


KINDS = pytest.mark.parametrize(
    ("asks_tree", "samples"), [(False, EVERY), (True, EVERY), (True, LIKE_A_SCAN)], ids=["plain", "tree", "scan"]
)


@KINDS
@pytest.mark.parametrize("seed", [0, 1])
def test_all_at_once_from_what_is_shown_now(asks_tree: bool, samples: ndarray, seed: int) -> None:
    scene = Scene(seed, asks_tree=asks_tree, samples=samples)
    slowly = [scene.visit_slowly(own) for own in range(len(scene.cost))]
    visits = scene.visits()
    visits.at_once(np.arange(len(scene.cost), dtype=np.int32))
    for own, (position, turn, cost) in enumerate(slowly):
        np.testing.assert_allclose(visits.cost[own], cost, rtol=1e-3, atol=1e-5)
        np.testing.assert_allclose(scene.canvas.position[own], position, atol=1e-4)
        np.testing.assert_allclose(scene.canvas.turn[own], turn, atol=1e-6)


@KINDS
@pytest.mark.parametrize("seed", [0, 1])
def test_in_order_each_sees_those_before_it(asks_tree: bool, samples: ndarray, seed: int) -> None:
    fast, slow = (Scene(seed, asks_tree=asks_tree, samples=samples) for _ in range(2))
    order = np.random.default_rng(seed).permutation(len(fast.cost)).astype(np.int32)[:50]
    visits = fast.visits()
    visits.in_order(order)
    for own in order:
        position, turn, cost = slow.visit_slowly(own)
        slow.show(own, position, turn)
        np.testing.assert_allclose(visits.cost[own], cost, rtol=1e-3, atol=1e-5)
    np.testing.assert_allclose(fast.canvas.position, slow.canvas.position, atol=1e-3)
    np.testing.assert_allclose(fast.canvas.turn, slow.canvas.turn, atol=1e-6)
    np.testing.assert_allclose(fast.canvas.colour, slow.canvas.colour, atol=1e-3)
    assert (visits.cost[np.setdiff1d(np.arange(len(fast.cost)), order)] == 0).all()


def test_in_order_is_one_at_once_after_the_other() -> None:
    """Exact: the same to the bit as visits of one site each."""
    together, apart = (Scene(2, asks_tree=True, samples=EVERY) for _ in range(2))
    order = np.random.default_rng(2).permutation(ROWS * COLUMNS).astype(np.int32)
    one, other = together.visits(), apart.visits()
    one.in_order(order)
    for own in order:
        other.at_once(np.array([own], np.int32))
    np.testing.assert_array_equal(together.canvas.position, apart.canvas.position)
    np.testing.assert_array_equal(together.canvas.colour, apart.canvas.colour)
    np.testing.assert_array_equal(one.cost, other.cost)


def test_sites_are_visited_again_until_nothing_changes_around_them() -> None:
    """Visits stop by themselves, and where all is settled one more leaves the costs and the canvas as they are."""
    scene = Scene(3, asks_tree=False, samples=EVERY)
    scene.canvas.label[:] = 0
    visits, order, energy = scene.visits(), np.arange(ROWS * COLUMNS, dtype=np.int32), list[float]()
    before = np.empty_like(scene.canvas.position)
    while not np.array_equal(before, scene.canvas.position):
        before = scene.canvas.position.copy()
        visits.in_order(order)
        energy.append(visits.mean_cost)
        assert len(energy) < 40
    visits.cost[:] = -1
    visits.in_order(order)
    np.testing.assert_array_equal(scene.canvas.position, before)
    assert (visits.cost == -1).all()  # all are passed over
    assert energy[-1] < 0.8 * energy[0]


def test_threads_make_no_difference() -> None:
    before, shown = thread_count(), []
    try:
        for threads in (1, 2):
            use(threads=threads)
            scene = Scene(4, asks_tree=True, samples=EVERY)
            scene.visits().at_once(np.arange(ROWS * COLUMNS, dtype=np.int32))
            shown.append(scene.canvas.position)
    finally:
        use(threads=before)
    np.testing.assert_array_equal(*shown)


def test_no_candidate_and_no_site_is_no_harm() -> None:
    """Of a canvas that shows nothing, nothing is known: every site stays as it is, at no cost."""
    scene = Scene(5, asks_tree=False, samples=EVERY)
    scene.canvas.label[:] = -1
    before = scene.canvas.position.copy()
    visits = scene.visits()
    visits.at_once(np.zeros(0, np.int32))
    visits.in_order(np.arange(ROWS * COLUMNS, dtype=np.int32))
    np.testing.assert_array_equal(scene.canvas.position, before)
    assert visits.mean_cost == 0.0


def test_few_samples_leave_the_others_unread() -> None:
    """What lies under samples that do not count makes no difference."""
    one, other = (Scene(6, asks_tree=True, samples=LIKE_A_SCAN) for _ in range(2))
    hidden = np.setdiff1d(EVERY, LIKE_A_SCAN)
    corners = one.stencils.sites.copy()
    corners[:, hidden] = corners[::-1, hidden]
    one.stencils = replace(one.stencils, sites=corners)
    for scene in (one, other):
        scene.visits().in_order(np.arange(ROWS * COLUMNS, dtype=np.int32))
    np.testing.assert_array_equal(one.canvas.position, other.canvas.position)
