"""Expansion moves: a block of the sample takes over wherever all seams together get cheaper, by the cheapest cut.

The moves are those of Boykov, Veksler & Zabih 2001, the cost of seams that of Kwatra et al. 2003, blocks as labels the
idea of shift maps (Pritch et al. 2009). Where much is known around what grows, this finds pieces that continue every
border at once, which no order of laying does.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int, Int32

from texloom.arrays import Image
from texloom.domain.cover import group_by_site, ranges
from texloom.domain.domain import Domain
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.cuts import cheapest_side
from texloom.synthesis.gaps import turned
from texloom.synthesis.usage import Usage

_NEXT = 1.5  # squared texels: seams run between sites this near
_DEPTH = 2  # texels: how far known sites beyond the border are compared
_LEAST = 1e-3  # of all cost: what a proposal must promise to be looked at
_BALANCE = 1.0  # first mean costs of a site, paid for showing what has had its fair share
_BORDER = 2.0  # weight of each of those; a seam between two sites that may change counts both ways, each whole


@dataclass(frozen=True, eq=False)
class Proposal:
    """Sites of a block, the source it has for each, and which cell of the block each lies in: cells are taken whole."""

    site: Int32[np.ndarray, "n"]
    position: Float32[np.ndarray, "n 2"]
    turn: Float32[np.ndarray, "n"]
    cell: Int[np.ndarray, "n"]

    def only(self, sites: Bool[np.ndarray, "site"]) -> "Proposal":
        """The part of it on these sites."""
        kept = sites[self.site]
        return Proposal(self.site[kept], self.position[kept], self.turn[kept], self.cell[kept])


class Expansion:
    """What the sites that may change show, and what every seam between them and at their border costs.

    A seam costs the distance (not squared, so that cuts are exact) between what one side's source, continued, would
    show on the other side, and what is shown there; both ways between sites that may change. Work for one proposal
    grows with its sites. With ``usage`` a site also pays for showing what is shown more than its fair share: seams are
    cheapest where the sample is plain, and only plain parts would be left.
    """

    def __init__(
        self,
        canvas: Canvas,
        image: Image,
        usable: Bool[np.ndarray, "row column"],
        domain: Domain,
        sites: np.ndarray,
        usage: Usage | None = None,
    ) -> None:
        self._canvas, self._image, self._usable = canvas, image, usable
        self._sites = np.flatnonzero(sites).astype(np.int32)
        self._number = np.full(domain.count, -1, np.int32)
        self._number[self._sites] = np.arange(len(self._sites), dtype=np.int32)
        self._node = np.full(len(self._sites) + 1, -1, np.int32)  # in the proposal at hand; the last stands for others
        self._pairs = _Pairs.of(domain, canvas, self._sites, self._number)
        count = len(self._pairs.first)
        self._onto_second = np.empty((count, image.shape[2]), np.float32)  # the first's source, continued
        self._onto_first = np.empty((count, image.shape[2]), np.float32)
        self._cost = np.empty(count, np.float32)
        self._update(np.arange(count))
        self._usage = usage
        if usage is not None:
            usage.add(canvas.position[self._sites], np.ones(len(self._sites), np.float32))
            self._price = _BALANCE * self.cost / len(self._sites)

    @property
    def cost(self) -> float:
        """Of all seams."""
        return float(self._cost.sum(dtype=np.float64))

    @property
    def labels(self) -> Int32[np.ndarray, "n"]:
        """The labels of the sites that may change."""
        return self._canvas.label[self._sites]

    def around(self, label: int, steps: int) -> Bool[np.ndarray, "site"]:
        """Sites that do not show ``label`` and may change, at most that many steps from one that does."""
        near = np.zeros(len(self._number), bool)
        front = shown = np.flatnonzero(self.labels == label)
        for _ in range(steps):
            inside, across = self._pairs.of_sites(front)
            second = self._pairs.second[inside]
            front = np.unique(np.concatenate([second[second >= 0], self._pairs.first[across]]))
            near[self._sites[front]] = True
        near[self._sites[shown]] = False
        return near

    def propose(self, proposal: Proposal, label: int) -> int:
        """Let the block take the sites that make the whole cheapest; they get ``label``. Returns how many they are."""
        fits = (self._number[proposal.site] >= 0) & self._within(proposal.position)
        site, position, turn = proposal.site[fits], proposal.position[fits], proposal.turn[fits]
        if not len(site):
            return 0
        colour = self._read(position)
        cell, node = np.unique(proposal.cell[fits], return_inverse=True)
        takes = self._cut(self._number[site], (position, turn, colour), node.astype(np.int32), len(cell))[node]
        if takes.any():
            moved, canvas = site[takes], self._canvas
            if self._usage is not None:
                weight = np.ones(len(moved), np.float32)
                self._usage.add(canvas.position[moved], -weight)
                self._usage.add(position[takes], weight)
            canvas.position[moved], canvas.turn[moved] = position[takes], turn[takes]
            canvas.colour[moved], canvas.label[moved] = colour[takes], label
            inside, across = self._pairs.of_sites(self._number[moved])
            self._update(np.concatenate([inside, across]))
        return int(np.count_nonzero(takes))

    def _cut(self, number: np.ndarray, new: tuple[np.ndarray, np.ndarray, np.ndarray], node: np.ndarray, count: int):
        """Which nodes take. The energy of a pair, by who takes, is a cut once its halves are moved onto the nodes."""
        position, turn, colour = new
        pairs, canvas = self._pairs, self._canvas
        self._node[number] = np.arange(len(number), dtype=np.int32)
        inside, across = pairs.of_sites(number)
        first, second = self._node[pairs.first[inside]], self._node[pairs.second[inside]]
        alone, both = second < 0, second >= 0
        across = across[self._node[pairs.first[across]] < 0]
        take = np.zeros(count)  # what taking costs a node more than keeping
        if self._usage is not None:
            dearer = self._usage.excess_at(position) - self._usage.excess_at(canvas.position[self._sites[number]])
            take += np.bincount(node, self._price * dearer, count)

        # Both may take: nothing if they do, for the block fits itself.
        e, f, s = inside[both], first[both], second[both]
        change = _distance(canvas.colour[self._sites[number]], colour)
        second_takes = _distance(self._onto_second[e], colour[s]) + change[f]
        first_takes = _distance(self._onto_first[e], colour[f]) + change[s]
        half = np.maximum(second_takes + first_takes - self._cost[e], 0) / 2
        take += np.bincount(node[f], first_takes - self._cost[e] - half, count)
        take += np.bincount(node[s], half - first_takes, count)
        edges = np.stack([node[f], node[s]], 1)

        # Only the first may.
        e, f = inside[alone], first[alone]
        beyond = self._read(position[f] + turned(pairs.offset[e], turn[f]))
        costs = self._weigh(
            e, _distance(beyond, canvas.colour[pairs.site[e]]), _distance(self._onto_first[e], colour[f])
        )
        take += np.bincount(node[f], costs - self._cost[e], count)

        # Only the second may.
        s = self._node[pairs.second[across]]
        beyond = self._read(position[s] - turned(pairs.offset[across], turn[s] - pairs.turn[across]))
        there = canvas.colour[self._sites[pairs.first[across]]]
        costs = _distance(beyond, there) + _distance(self._onto_second[across], colour[s])
        take += np.bincount(node[s], costs - self._cost[across], count)

        self._node[number] = -1
        if -take[take < 0].sum() < _LEAST * self.cost:  # no cut can gain more
            return np.zeros(count, bool)
        return cheapest_side(edges, half, take)

    def _update(self, pairs: Int[np.ndarray, "n"]) -> None:
        """Costs of these pairs, from what the canvas shows."""
        canvas, p = self._canvas, self._pairs
        first, second, offset = self._sites[p.first[pairs]], p.site[pairs], p.offset[pairs]
        self._onto_second[pairs] = self._read(canvas.position[first] + turned(offset, canvas.turn[first]))
        back = turned(offset, canvas.turn[second] - p.turn[pairs])
        self._onto_first[pairs] = self._read(canvas.position[second] - back)
        at_second = _distance(self._onto_second[pairs], canvas.colour[second])
        at_first = _distance(self._onto_first[pairs], canvas.colour[first])
        self._cost[pairs] = self._weigh(pairs, at_second, at_first)

    def _weigh(self, pairs: np.ndarray, at_second: np.ndarray, at_first: np.ndarray) -> np.ndarray:
        """The two sides of seams together. What a known site would show beyond its border is not asked: it may be
        the very hole."""
        return np.where(self._pairs.second[pairs] < 0, _BORDER * at_second, at_second + at_first)

    def _read(self, position: Float32[np.ndarray, "n 2"]) -> Float32[np.ndarray, "n channel"]:
        """Colours of the nearest texels."""
        texel = np.clip(np.rint(position).astype(np.int32), 0, np.array(self._image.shape[:2]) - 1)
        return self._image[texel[:, 0], texel[:, 1]]

    def _within(self, position: Float32[np.ndarray, "n 2"]) -> Bool[np.ndarray, "n"]:
        texel = np.rint(position).astype(np.int32)
        near = np.clip(texel, 0, np.array(self._image.shape[:2]) - 1)
        return np.all(texel == near, axis=1) & self._usable[near[:, 0], near[:, 1]]


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Neighbours of which the first may change; in the order of the first."""

    first: Int32[np.ndarray, "pair"]  # its number among the sites that may change
    site: Int32[np.ndarray, "pair"]  # the second
    second: Int32[np.ndarray, "pair"]  # its number, -1: it stays
    offset: Float32[np.ndarray, "pair 2"]  # texels from the first to the second, in the first's frame
    turn: Float32[np.ndarray, "pair"]  # the first's frame against the second's
    start: Int32[np.ndarray, "sites_plus_one"]  # pairs of each first
    start_of_second: Int32[np.ndarray, "sites_plus_one"]
    by_second: Int32[np.ndarray, "entry"]

    @staticmethod
    def of(
        domain: Domain, canvas: Canvas, sites: Int32[np.ndarray, "n"], number: Int32[np.ndarray, "site"]
    ) -> "_Pairs":
        """Each pair of neighbours that may change once, and each known site near one that may."""
        around = domain.neighbourhoods(sites, _DEPTH if len(sites) < domain.count else 1)
        one = np.broadcast_to(np.arange(len(sites), dtype=np.int32)[:, None], around.sites.shape)
        offset = np.broadcast_to(around.offset, (*around.sites.shape, 2))
        second = np.where(around.sites >= 0, number[around.sites], np.int32(-1))
        next_to = (second > one) & ((offset**2).sum(2) < _NEXT)
        known = (around.sites >= 0) & (second < 0) & (canvas.label[around.sites] >= 0)
        kept = next_to | known
        turn = np.zeros(np.count_nonzero(kept), np.float32) if around.turn is None else around.turn[kept]
        start = np.concatenate([[0], np.cumsum(kept.sum(1))]).astype(np.int32)
        start_of_second, by_second = group_by_site(np.ascontiguousarray(second[kept]), len(sites))
        pairs = one[kept], around.sites[kept], second[kept], offset[kept], turn
        return _Pairs(*pairs, start, start_of_second, by_second)

    def of_sites(self, number: Int32[np.ndarray, "n"]) -> tuple[Int[np.ndarray, "pair"], Int[np.ndarray, "other"]]:
        """Pairs whose first, and pairs whose second is one of these."""
        return ranges(self.start, number), self.by_second[ranges(self.start_of_second, number)]


def _distance(
    one: Float32[np.ndarray, "n channel"], other: Float32[np.ndarray, "n channel"]
) -> Float32[np.ndarray, "n"]:
    difference = one - other
    return np.sqrt(np.einsum("nc,nc->n", difference, difference))
