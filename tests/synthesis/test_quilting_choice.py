"""Every choice of triangle quilting against the paper's search and ours done slowly, neighbours being as they were."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import pytest
from numpy import ndarray

from tests.synthesis.quilted_slowly import Slow, bound
from tests.synthesis.quilts import ball, panes, plane, sample
from texloom.domain.faces import Faces
from texloom.progress import Report
from texloom.search.textons import Textons
from texloom.synthesis.quilting import Quilting, _Chooser, _growth


class Batch(NamedTuple):
    """Patches placed side by side, and all places and branches before and after."""

    members: ndarray
    place: ndarray
    branch: ndarray
    place_after: ndarray
    branch_after: ndarray


class Watched:
    """Quilting batch by batch."""

    def __init__(self, method: Quilting, textons: Textons, faces: Faces, seed: int = 0) -> None:
        self.chooser, self.share = _Chooser(method, textons, faces, seed), method.share
        self.order, self.starts = _growth(faces, method.order, seed)
        # Small batches otherwise go together.
        self.chooser._runs = lambda starts: ((a, b, 1) for a, b in zip(starts[:-1], starts[1:], strict=True))

    def growth(self) -> Iterator[Batch]:
        """What grows, step by step."""
        return self._watch(lambda report: self.chooser.place_all(self.order, self.starts, report=report))

    def round(self) -> Iterator[Batch]:
        """What is placed anew."""
        return self._watch(lambda report: self.chooser.place_worst(self.share, report=report))

    def _watch(self, place: Callable[[Report], None]) -> Iterator[Batch]:
        states, ends = [self._state()], [0.0]

        def report(_stage: str, done: float) -> None:
            states.append(self._state())
            ends.append(done)

        place(report)
        share = 1.0 if (states[0][1] == -1).all() else self.share
        end = np.rint(np.array(ends) * round(share * self.chooser.faces.count)).astype(int)
        for number, (before, after) in enumerate(zip(states, states[1:], strict=False)):
            yield Batch(self.chooser._todo[end[number] : end[number + 1]], *before, *after)

    def _state(self) -> tuple[ndarray, ndarray]:
        """Places and branches as they are now."""
        return self.chooser.place.view(np.complex64)[:, 0].astype(complex), self.chooser.branch.copy()


def is_as_published(slow: Slow, batch: Batch, p: int, candidates: int) -> tuple[bool, float]:
    """Whether a patch was placed among the most voted, and no worse than the best of them; and its mean error."""
    place, chosen = batch.place_after[p], batch.branch_after[p]
    at, best, own = (round(place.imag), round(place.real)), np.inf, np.nan
    voted = place == complex(at[1], at[0])
    for b in range(slow.faces.order):
        string, room = slow.string(p, b, batch.place, batch.branch), slow.room(p, b)
        votes, errors = slow.votes(string), slow.errors(string, room)
        least, last = bound(votes, errors, candidates)
        best = min(best, least / max(len(string), 1))
        if b == chosen:
            own = float(errors[at] / max(len(string), 1))
            voted &= bool(room[at] and votes[at] >= last)
    return voted and own <= best * (1 + 1e-4) + 1e-9, own


@pytest.mark.parametrize(
    "order, candidates, masked",
    [(1, 1, False), (1, 6, True), (4, 6, False), (4, 40, True), (6, 1, True), (6, 40, False)],
)
def test_textons_alone_find_what_the_paper_finds(order, candidates, masked):
    check_growth(sample(masked=masked), ball(order, subdivisions=1), candidates)


def test_between_masked_lines_growth_is_as_published():
    check_growth(panes(), ball(2, 6.0), 8)


@pytest.mark.parametrize("match", ["colours", "textons"])
def test_masked_texels_tell_nothing(match):
    textons, faces, method = panes(), plane(1, 6.0), Quilting(match=match, candidates=500)
    slow, lengths = Slow(textons, faces), []
    for column in np.arange(8.0, 16.0):  # the edge between both lies over a masked line, here and there
        chooser = _Chooser(method, textons, faces, 1)
        chooser.place[0], chooser.branch[0] = (column, 15.0), 0
        chooser.place_all(np.array([1], np.int32), [0, 1])
        place = chooser.place.view(np.complex64)[:, 0].astype(complex)
        string = slow.string(1, 0, place, np.array([0, -1]))
        lengths.append(len(string))
        if match == "colours":
            expected = slow.error_between(place[1], string, 0.5)
        else:
            errors = slow.errors(string, slow.room(1, 0))
            expected = errors[slow.votes(string) > 0].min()
        np.testing.assert_allclose(chooser.error[1], expected / len(string), rtol=1e-3)
        assert chooser.error[1] < 10
    assert len(set(lengths)) > 1


def check_growth(textons: Textons, faces: Faces, candidates: int) -> None:
    """Every patch grows where the paper has it."""
    method = Quilting(match="textons", candidates=candidates, rounds=0)
    slow, watched = Slow(textons, faces), Watched(method, textons, faces, 5)
    good, errors = [], np.full(faces.count, np.nan)
    for batch in watched.growth():
        for p in batch.members:
            fits, errors[p] = is_as_published(slow, batch, p, candidates)
            good.append(fits)
    assert len(good) == faces.count
    assert np.mean(good) > 0.97  # a point half way between texels may fall either way
    assert np.isclose(watched.chooser.error, errors, rtol=1e-3, atol=1e-6).mean() > 0.97
    quilted = method.run(textons, faces, seed=5)
    np.testing.assert_allclose(quilted.energy, [watched.chooser.error.mean()], rtol=1e-5)


@pytest.mark.parametrize(
    "kind, order, across", [("masked", 1, 9.0), ("whole", 4, 9.0), ("panes", 2, 6.0), ("masked", 6, 9.0)]
)
def test_colours_find_no_worse_than_what_the_neighbours_go_on_with(kind, order, across):
    textons = panes() if kind == "panes" else sample(masked=kind == "masked")
    faces = ball(order, across, subdivisions=1 if order > 2 else 2)
    slow, watched = Slow(textons, faces), Watched(Quilting(), textons, faces, 1)
    good, between = [], 0
    for batch in watched.growth():
        for p in batch.members:
            chosen = batch.branch_after[p]
            string = slow.string(p, chosen, batch.place, batch.branch)
            own = slow.error_between(batch.place_after[p], string, 0.5) / max(len(string), 1)
            good.append(bool(np.isclose(watched.chooser.error[p], own, rtol=2e-3, atol=1e-4)))
            between += batch.place_after[p] != np.round(batch.place_after[p])
            for b in range(order):
                string = slow.string(p, b, batch.place, batch.branch)
                corners = slow.corners(p, b)
                for there in slow.continuations(p, b, batch.place, batch.branch):
                    if inside(textons, there + corners):
                        error = slow.error_between(there, string, 0.5) / max(len(string), 1)
                        good[-1] &= bool(own <= error + 1e-3)
    assert len(good) == faces.count and np.mean(good) > 0.97
    assert between > 0.5 * faces.count


def inside(textons: Textons, corners: ndarray) -> bool:
    """Whether corners lie well inside the sample, with no masked texel in the box around them."""
    low, high = corners.real.min() + 1j * corners.imag.min(), corners.real.max() + 1j * corners.imag.max()
    rows, columns = textons.exemplar.shape
    if min(low.real, low.imag) < 1e-3 or high.real > columns - 1 - 1e-3 or high.imag > rows - 1 - 1e-3:
        return False
    r, c = slice(int(low.imag), int(np.ceil(high.imag)) + 1), slice(int(low.real), int(np.ceil(high.real)) + 1)
    return bool(textons.exemplar.usable[r, c].all())


@pytest.mark.parametrize("match, candidates, share", [("colours", 32, 0.5), ("textons", 2, 0.5), ("colours", 1, 1.0)])
def test_a_round_leaves_no_patch_worse_than_it_was(match, candidates, share):
    textons, faces, method = sample(masked=True), ball(4), Quilting(match=match, candidates=candidates, share=share)
    slow, watched = Slow(textons, faces), Watched(method, textons, faces, 2)
    for batch in watched.growth():
        assert (batch.branch[batch.members] == -1).all()
    twins, patch = faces.mesh.twins, faces.patch
    for number in range(2):
        tried, worse, placed = 0, 0, []
        for batch in watched.round():
            members = set(batch.members.tolist())
            assert not any(patch[twins[h] // 3] in members for p in members for h in range(3 * p, 3 * p + 3))
            placed += sorted(members)
            for p in sorted(members):
                errors = []
                for place, branch in [(batch.place[p], batch.branch[p]), (batch.place_after[p], batch.branch_after[p])]:
                    string = slow.string(p, branch, batch.place, batch.branch)
                    if match == "colours":
                        errors.append(slow.error_between(place, string, 0.5) / len(string))
                    else:
                        at = round(place.imag), round(place.real)
                        errors.append(slow.errors(string, slow.room(p, branch))[at] / len(string))
                tried += 1
                worse += errors[1] > errors[0] * (1 + 1e-3) + 1e-4
        assert len(set(placed)) == tried == round(share * faces.count), number
        assert worse <= 0.02 * tried
