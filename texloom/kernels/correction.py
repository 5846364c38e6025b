"""Choosing texels site by site: the one whose surroundings fit best, of what the neighbours and a search suggest."""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.patches import read_sample, sample_exemplar
from texloom.kernels.surroundings import (
    FAR,
    Around,
    Canvas,
    Desk,
    Exemplar,
    Tree,
    ask_tree,
    is_new,
    is_settled,
    is_usable,
    mismatch,
)

NEAR = wp.constant(2.5)  # squared texels: how near the neighbours are whose sources are tried


@wp.func
def find_source(own: int, i: int, around: Around, canvas: Canvas, exemplar: Exemplar, tree: Tree, desk: Desk) -> float:
    """found[i] = argmin over candidates (q, turn) of mean_s |exemplar(q + R(turn) offset_s) - seen_s|^2; returns that.

    Candidates are the sources of the middle site and of those next to it, continued to the middle (coherence), the
    texels similar to those of the first ``suggesting`` (k-coherence), and what the tree finds. Ties keep the first.
    """
    middle = around.near[own, 0]
    desk.found[i, 0] = canvas.position[middle, 0]
    desk.found[i, 1] = canvas.position[middle, 1]
    desk.found[i, 2] = canvas.turn[middle]
    number = float(0.0)
    for j in range(around.samples.shape[0]):
        known = read_sample(
            own, around.samples[j], around.sites, around.weights, canvas.colour, canvas.label, i, j, desk.seen
        )
        desk.known[i, j] = known
        number += known
    shape = wp.min(own, around.offset.shape[0] - 1)
    beside = wp.min(own, around.near_offset.shape[0] - 1)
    kind = wp.uint8(1)
    if canvas.kind.shape[0] > 0:
        kind = canvas.kind[middle]
    count = int(0)
    best = float(FAR)
    for k in range(around.near.shape[1]):
        site = around.near[own, k]
        dr = around.near_offset[beside, k, 0]
        dc = around.near_offset[beside, k, 1]
        guesses = int(0)
        turned = float(0.0)
        if site >= 0 and dr * dr + dc * dc < NEAR:
            if canvas.label[site] >= 0:
                guesses = 1
                turned = canvas.turn[site]
                if around.turned.shape[1] > 1:
                    turned -= around.turned[own, k]  # the source's axes, against the middle site's frame
                if k < exemplar.suggesting:
                    guesses = 1 + exemplar.similar.shape[2]
        for guess in range(guesses):
            angle = float(turned)
            row = canvas.position[site, 0]
            column = canvas.position[site, 1]
            if guess > 0:
                # Sources may lie up to a texel outside the exemplar, where a patch's outer samples show its border.
                r = wp.clamp(int(wp.round(row)), 0, exemplar.similar.shape[0] - 1)
                c = wp.clamp(int(wp.round(column)), 0, exemplar.similar.shape[1] - 1)
                alike_r = exemplar.similar[r, c, guess - 1, 0]
                alike_c = exemplar.similar[r, c, guess - 1, 1]
                row = row + float(alike_r - r)
                column = column + float(alike_c - c)
                if exemplar.axis.shape[0] > 0:
                    angle += exemplar.axis[alike_r, alike_c] - exemplar.axis[r, c]
            cosine = wp.cos(angle)
            sine = wp.sin(angle)
            row = row - (cosine * dr + sine * dc)
            column = column - (cosine * dc - sine * dr)
            # What is shown now may always stay, or coherence would break where it comes from the exemplar's border.
            fits = k + guess == 0 or is_usable(exemplar.usable, row, column, kind)
            if fits and is_new(desk.tried, i, count, row, column, angle):
                desk.tried[i, count, 0] = row
                desk.tried[i, count, 1] = column
                desk.tried[i, count, 2] = angle
                count += 1
                total = mismatch(exemplar, row, column, angle, around, shape, desk, i, best)
                if total < best:
                    best = total
                    desk.found[i, 0] = row
                    desk.found[i, 1] = column
                    desk.found[i, 2] = angle
    if tree.points.shape[0] > 0:
        ask_tree(tree, desk, i)
        for k in range(desk.nearest.shape[1]):
            window = desk.nearest[i, k]
            row = float(0.0)
            column = float(0.0)
            if window >= 0:
                row = float(tree.centre[window, 0])
                column = float(tree.centre[window, 1])
            if window >= 0 and is_usable(exemplar.usable, row, column, kind):
                total = mismatch(exemplar, row, column, 0.0, around, shape, desk, i, best)
                if total < best:
                    best = total
                    desk.found[i, 0] = row
                    desk.found[i, 1] = column
                    desk.found[i, 2] = 0.0
    return wp.where(best < FAR, best / wp.max(number, 1.0), 0.0)


@wp.func
def show_source(site: int, i: int, now: int, exemplar: Exemplar, desk: Desk, canvas: Canvas):
    """The site shows found[i], from ``now`` on."""
    row = desk.found[i, 0]
    column = desk.found[i, 1]
    if canvas.position[site, 0] != row or canvas.position[site, 1] != column or canvas.turn[site] != desk.found[i, 2]:
        canvas.changed[site] = now
        canvas.position[site, 0] = row
        canvas.position[site, 1] = column
        canvas.turn[site] = desk.found[i, 2]
        for g in range(canvas.colour.shape[1]):
            canvas.colour[site, g] = sample_exemplar(exemplar.image, row, column, g)


@wp.kernel(enable_backward=False)
def find_sources(
    start: int,
    chosen: wp.array(dtype=int),  # which neighbourhoods
    around: Around,
    canvas: Canvas,
    visited: wp.array(dtype=int),  # when each neighbourhood last was
    exemplar: Exemplar,
    tree: Tree,
    desk: Desk,  # written too: row i for chosen[i]
    cost: wp.array(dtype=float),  # of each neighbourhood, at its last visit
):
    """What every chosen site is to show, from what all show now."""
    i = start + wp.tid()
    own = chosen[i]
    if is_settled(own, around, canvas, visited):
        site = around.near[own, 0]
        desk.found[i, 0] = canvas.position[site, 0]
        desk.found[i, 1] = canvas.position[site, 1]
        desk.found[i, 2] = canvas.turn[site]
    else:
        cost[own] = find_source(own, i, around, canvas, exemplar, tree, desk)


@wp.kernel(enable_backward=False)
def show_sources(
    start: int,
    chosen: wp.array(dtype=int),
    now: int,
    around: Around,
    exemplar: Exemplar,
    desk: Desk,
    visited: wp.array(dtype=int),
    canvas: Canvas,
):
    """Every chosen site shows what was found for it."""
    i = start + wp.tid()
    show_source(around.near[chosen[i], 0], i, now, exemplar, desk, canvas)
    visited[chosen[i]] = now


@wp.kernel(enable_backward=False)
def visit_in_order(
    start: int,
    chosen: wp.array(dtype=int),
    now: int,
    around: Around,
    exemplar: Exemplar,
    tree: Tree,
    desk: Desk,  # of one row
    visited: wp.array(dtype=int),
    canvas: Canvas,
    cost: wp.array(dtype=float),
):
    """One site after the other, each seeing what those before it show: a sequence, so one item."""
    for v in range(chosen.shape[0]):
        own = chosen[v]
        if not is_settled(own, around, canvas, visited):
            cost[own] = find_source(own, 0, around, canvas, exemplar, tree, desk)
            show_source(around.near[own, 0], 0, now, exemplar, desk, canvas)
        visited[own] = now
