"""Correcting sites against its oracle, one neighbourhood at a time."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy import ndarray

from tests import naive
from texloom.arrays import fours
from texloom.domain.grid import Grid
from texloom.kernels.correction import find_sources
from texloom.kernels.launch import launch
from texloom.synthesis.visits import NO_TREE

ROWS, COLUMNS, REACH, MOST = 12, 11, 1, 12


def scene(rng: np.random.Generator, whole: bool) -> dict[str, ndarray]:
    """A torus whose sites show random places of a random exemplar, in patches of coherence; some are bare."""
    image = rng.random((16, 15, 4), np.float32)
    usable = np.zeros((16, 15), np.uint8)
    usable[REACH : 15 - REACH, REACH : 14 - REACH] = rng.random((15 - 2 * REACH, 14 - 2 * REACH)) < 0.9
    site = np.stack(np.divmod(np.arange(ROWS * COLUMNS), COLUMNS), 1)
    block = (site // 4) @ [5, 1]
    position = (site % 4 + rng.integers(0, 11, (30, 2))[block]).astype(np.float32)
    if not whole:
        position += rng.random((30, 2), np.float32)[block] - np.float32(0.5)
    texel = np.clip(np.rint(position), 0, (15, 14)).astype(int)
    colour = image[texel[:, 0], texel[:, 1]] + rng.normal(0, 0.05, (len(site), 4)).astype(np.float32)
    label = np.where(rng.random(len(site)) < 0.1, -1, block).astype(np.int32)
    similar = np.stack([rng.integers(0, n, (16, 15, 2)) for n in (16, 15)], -1).astype(np.int32)
    return dict(image=image, usable=usable, position=position, colour=colour, label=label, similar=similar)


def correct(scene: dict[str, ndarray], sites: ndarray, offset: ndarray, **other: ndarray) -> tuple[ndarray, ndarray]:
    """Found positions and costs of all neighbourhoods."""
    count = len(sites)
    found, cost = np.empty((count, 3), np.float32), np.zeros(count, np.float32)
    turn = other.get("turn", np.zeros(len(scene["label"]), np.float32))
    changed = other.get("changed", np.zeros(len(scene["label"]), np.int32))
    visited = other.get("visited", np.zeros(count, np.int32))
    samples = sites.shape[1]
    around = {
        "samples": np.arange(samples, dtype=np.int32),
        "sites": sites[:, :, None],
        "weights": np.ones((1, 1, 1), np.float32),
        "offset": offset,
        "near": sites,
        "near_offset": offset,
        "turned": other.get("turned", np.zeros((1, 1), np.float32)),
    }
    canvas = {"position": scene["position"], "turn": turn, "label": scene["label"], "changed": changed}
    canvas["colour"] = fours(scene["colour"])
    exemplar = {"image": fours(scene["image"]), "usable": scene["usable"], "similar": scene["similar"], "suggesting": 1}
    desk = {
        "seen": np.empty((count, samples, 1, 4), np.float32),
        "known": np.empty((count, samples), np.float32),
        "query": np.empty((count, 1, 4), np.float32),
        "nearest": np.empty((count, 1), np.int32),
        "distance": np.empty((count, 1), np.float32),
        "tried": np.empty((count, MOST, 3), np.float32),
        "found": found,
    }
    launch(
        find_sources,
        count,
        inputs=[np.arange(count, dtype=np.int32), around, canvas, visited, exemplar, NO_TREE, desk],
        outputs=[cost],
    )
    return found[:, :2], cost


@settings(max_examples=4, deadline=None)
@given(seed=st.integers(0, 10**6), whole=st.booleans(), wrap=st.booleans())
def test_every_site_takes_the_cheapest_candidate(seed: int, whole: bool, wrap: bool) -> None:
    rng = np.random.default_rng(seed)
    made = scene(rng, whole)
    around = Grid(ROWS, COLUMNS, wrap).neighbourhoods(np.arange(ROWS * COLUMNS, dtype=np.int32), REACH)
    offset = np.repeat(around.offset, len(around.sites), 0)
    if not whole:  # as on a surface, where neighbours lie anywhere
        offset[:, 1:] += rng.random(offset[:, 1:].shape, np.float32) - np.float32(0.5)
    found, cost = correct(made, around.sites, offset)
    unturned = np.zeros(ROWS * COLUMNS, np.float32)
    shown = made["position"], unturned, made["label"]
    for i, sites in enumerate(around.sites):
        known = (sites >= 0) & (made["label"][sites] >= 0)
        place, _, least = naive.correct_site(
            *(made[name] for name in ("image", "usable", "similar")),
            (sites, offset[i], unturned[: len(sites)]),
            shown,
            (offset[i], made["colour"][sites], known),
            MOST,
        )
        np.testing.assert_allclose(cost[i], least, rtol=1e-3, atol=1e-5)
        np.testing.assert_allclose(found[i], place, atol=1e-4)


def test_a_neighbourhood_that_nothing_changed_is_passed_over() -> None:
    made = scene(np.random.default_rng(3), whole=True)
    around = Grid(ROWS, COLUMNS).neighbourhoods(np.arange(ROWS * COLUMNS, dtype=np.int32), REACH)
    changed = np.zeros(ROWS * COLUMNS, np.int32)
    changed[0] = 5
    found, cost = correct(
        made, around.sites, around.offset, changed=changed, visited=np.full(len(changed), 5, np.int32)
    )
    beside = np.isin(np.arange(len(changed)), [0, 1, COLUMNS, COLUMNS + 1])
    assert (cost[~beside] == 0).all() and (cost[beside] > 0).any()
    np.testing.assert_array_equal(found[~beside], made["position"][~beside])


def test_turned_sources_in_a_turned_exemplar_change_nothing() -> None:
    """With every source turned by a quarter, and the exemplar turned back under them, the same is found."""
    made = scene(np.random.default_rng(4), whole=True)
    made["similar"] = made["similar"][:, :, :0]
    around = Grid(ROWS, COLUMNS).neighbourhoods(np.arange(ROWS * COLUMNS, dtype=np.int32), REACH)
    found, cost = correct(made, around.sites, around.offset)

    columns = made["image"].shape[1]
    turned = made | {name: np.ascontiguousarray(np.rot90(made[name])) for name in ("image", "usable", "similar")}
    # Texel (r, c) comes to lie at (columns - 1 - c, r); an offset along the columns then runs up the rows.
    turned["position"] = np.stack([columns - 1 - made["position"][:, 1], made["position"][:, 0]], 1)
    angle = np.full(len(made["label"]), -np.pi / 2, np.float32)
    again, same = correct(turned, around.sites, around.offset, turn=angle)
    np.testing.assert_allclose(same, cost, rtol=1e-3, atol=1e-5)
    np.testing.assert_allclose(again[:, 0], columns - 1 - found[:, 1], atol=1e-4)
    np.testing.assert_allclose(again[:, 1], found[:, 0], atol=1e-4)


def test_sources_outside_the_exemplar_read_its_border() -> None:
    """Patches' outer samples may lie up to a texel outside."""
    made = scene(np.random.default_rng(5), whole=True)
    made["position"][:], made["label"][:] = [-0.9, 14.9], 0
    around = Grid(ROWS, COLUMNS, wrap=True).neighbourhoods(np.arange(ROWS * COLUMNS, dtype=np.int32), REACH)
    made["image"][2:8, 4:10], made["colour"][:] = 0.5, 0.5
    made["similar"][:] = [5, 6]
    made["usable"][:] = 0
    made["usable"][4:7, 5:8] = 1
    found, _ = correct(made, around.sites, around.offset)
    np.testing.assert_allclose(found, np.broadcast_to(np.float32([4.1, 6.9]), found.shape), atol=1e-5)
