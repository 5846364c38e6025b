"""Whole samples laid on a lattice of sites, one after the other, each where it fits what is there."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from texloom import draws
from texloom.arrays import Image
from texloom.domain.domain import Lattice
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import Exemplar, Part
from texloom.progress import Report
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.cuts import cheapest_cut, seam_costs
from texloom.synthesis.placement import Covering, Placement

_OVERLAP = 0.25  # of the sample: the least that must lie over what is known, where it can
_FRESH = 0.2  # of the most bare sites that could be covered: what covers fewer is not tried
_ADDING = 0.5  # least costs that a piece pays the less, the more it covers of those
_LEAST = 0.02  # of the core: gaps of fewer sites are left bare
_CELL = 4  # translations a side, of which the best is tried
_TRIED = 256  # translations at most whose repeats are counted
_EXACT = 1e-8  # cost taken for the least where a piece fits exactly
_REPEAT = 1.0  # least costs that a piece pays where all that it adds is shown side by side with a copy
_COUNTED = 1000  # texels of each that are looked at for that
_NEAR = 1.0  # sides of the sample: a copy that far away counts 0.6 of one side by side
_TEMPERATURE = 0.02  # least costs: how much worse a piece may be and still be taken now and then
_BORDER = 1 / 4  # of the overlap's depth: texels along the sample's own border are matched, never laid
_START, _CROP, _CHANCE = 0x9F01, 0x9F02, 0x9F03  # purposes of the draws


class Piece(NamedTuple):
    """A sample that was laid: its number, the row and column of its first texel, and its label on the canvas."""

    sample: int
    corner: Int[np.ndarray, "2"]
    label: int


@dataclass(frozen=True, eq=False)
class _Sample:
    """A rectangle of the exemplar that is laid as one."""

    part: Part
    placement: Placement


class Laying:
    """One run: pieces are laid until no larger gap is left; ``band`` tells where they meet.

    The next piece covers the bare site nearest to where growth began. Among the translations that do, and
    overlap enough, it is one of the cheapest by ``Placement`` that adds much, and little that is shown nearby already.
    Pieces meet along the cheapest cut within ``depth`` texels of the overlap; ``band`` are the sites within ``reach``
    of it.
    """

    def __init__(
        self,
        canvas: Canvas,
        exemplar: Exemplar,
        image: Image,
        lattice: Lattice,
        sites: Bool[np.ndarray, "site"] | None,
        *,
        depth: int,
        reach: int,
        seed: int,
    ) -> None:
        self._canvas, self._image, self._lattice, self._seed = canvas, image, lattice, seed
        self._depth, self._reach = depth, reach
        self._free = np.ones(len(canvas.label), bool) if sites is None else sites
        self._channels = image.any((0, 1)) | (np.arange(image.shape[2]) == 0)  # not those that only fill up to four
        self._samples = [self._sample(part, exemplar.usable) for part in _windows(exemplar, lattice, seed)]
        self.pieces: list[Piece] = []
        self.band = np.zeros(len(canvas.label), bool)

    def run(self, report: Report) -> None:
        """Lay pieces over the bare sites that may change."""
        canvas, columns = self._canvas, self._lattice.columns
        bare = canvas.bare(self._free)
        order = self._begin()
        for site in order[bare[order]].tolist():
            if canvas.label[site] < 0:
                self._next(site // columns, site % columns)
                report("placement", 1 - np.count_nonzero(canvas.bare(self._free)) / np.count_nonzero(bare))

    def _begin(self) -> Int[np.ndarray, "site"]:
        """Sites from the nearest to what is known; where nothing is, a piece is laid anywhere first."""
        from scipy.ndimage import distance_transform_edt

        lattice, known = self._lattice, self._canvas.label >= 0
        size = np.array([lattice.rows, lattice.columns])
        if known.any():
            sites = np.arange(len(known)).reshape(size)
            self._learn(np.zeros(2, np.int64), sites, known[sites])
            away = np.asarray(distance_transform_edt(~known[sites]))
        else:
            drawn = draws.uniform(self._seed, _START, index=np.arange(3))
            number = int(drawn[2] * len(self._samples))
            start = (drawn[:2] * size).astype(np.int64)
            core = np.argwhere(self._samples[number].placement.core)
            middle = core[((core - core.mean(0)) ** 2).sum(1).argmin()]
            self._lay(number, start - middle)
            steps = [np.abs(np.arange(n) - at) for n, at in zip(size, start, strict=True)]
            if lattice.wrap:
                steps = [np.minimum(step, n - step) for n, step in zip(size, steps, strict=True)]
            away = steps[0][:, None] ** 2 + steps[1] ** 2
        return np.argsort(away, axis=None, kind="stable")

    def _next(self, row: int, column: int) -> None:
        """Lay a piece over that site; none where all would cover next to nothing."""
        tried = [_promising(s.placement.covering(row, column), s.placement.core) for s in self._samples]
        number = np.repeat(np.arange(len(tried)), [len(cost) for _, cost, _ in tried])
        texel, cost, fresh = (np.concatenate(parts) for parts in zip(*tried, strict=True))
        if not len(cost):
            return
        best = np.argsort(cost, kind="stable")[:_TRIED]
        number, texel, cost, fresh = number[best], texel[best], cost[best], fresh[best]
        corner = np.array([row, column]) - texel
        wish = (
            cost / max(float(cost[0]), _EXACT) + _REPEAT * self._repeats(number, corner) - _ADDING * fresh / fresh.max()
        )
        chance = draws.uniform(self._seed, _CHANCE, len(self.pieces), index=np.arange(len(cost)))
        # With this noise (Gumbel's) the least is one with probability exp(-wish / temperature), as in Kwatra et al.
        wish += _TEMPERATURE * np.log(-np.log(np.clip(chance, 1e-6, 1 - 1e-6)))
        chosen = int(wish.argmin())
        self._lay(int(number[chosen]), corner[chosen])

    def _repeats(self, number: Int[np.ndarray, "n"], corner: Int[np.ndarray, "n 2"]) -> Float[np.ndarray, "n"]:
        """How often what each piece would add is shown already; copies count less the farther away they are."""
        canvas, lattice = self._canvas, self._lattice
        size = np.array([lattice.rows, lattice.columns])
        repeats = np.zeros(len(number))
        for own in np.unique(number).tolist():
            those = np.flatnonzero(number == own)
            texel = np.argwhere(self._samples[own].placement.core)
            texel = texel[:: 1 + len(texel) // _COUNTED]
            site = lattice.site_at(*np.moveaxis(corner[those, None] + texel, 2, 0))
            adds = (site >= 0) & (canvas.label[site] < 0)
            count = np.maximum(np.count_nonzero(adds, axis=1), 1)
            side = np.sqrt(np.prod(self._samples[own].placement.shape))
            for piece in (piece for piece in self.pieces if piece.sample == own):
                apart = corner[those] - piece.corner
                if lattice.wrap:
                    apart = (apart + size // 2) % size - size // 2
                weight = np.exp(-0.5 * (apart**2).sum(1) / (_NEAR * side) ** 2)
                there = lattice.site_at(*(piece.corner + texel).T)
                shown = (there >= 0) & (canvas.label[there] == piece.label)
                repeats[those] += weight * np.count_nonzero(adds & shown, axis=1) / count
        return repeats

    def _lay(self, number: int, corner: Int[np.ndarray, "2"]) -> None:
        """Paint the bare sites under the core, and the known ones up to the cut."""
        canvas, part, placement = self._canvas, self._samples[number].part, self._samples[number].placement
        sites = self._sites(corner, placement.shape)
        known = canvas.label[sites] >= 0
        inside = placement.usable & (sites >= 0) & self._free[sites]
        fresh = inside & placement.core & ~known
        over = self._cut(sites, self._image[part.slices], fresh, inside & known)
        painted = fresh | over
        self._meet(corner, painted)
        self._learn(corner, sites, over, forget=True)
        own, texel = sites[painted], np.argwhere(painted) + (part.row, part.column)
        label = canvas.next_label
        canvas.position[own], canvas.label[own] = texel, label
        canvas.colour[own] = self._image[texel[:, 0], texel[:, 1]]
        self._learn(corner, sites, painted)
        self.pieces.append(Piece(number, corner, label))

    def _cut(
        self,
        sites: Int[np.ndarray, "row column"],
        new: Image,
        fresh: Bool[np.ndarray, "row column"],
        overlap: Bool[np.ndarray, "row column"],
    ) -> Bool[np.ndarray, "row column"]:
        """Known sites that the new piece takes over: those on its side of the cheapest cut through the overlap."""
        from scipy.ndimage import distance_transform_edt

        away = np.asarray(distance_transform_edt(~fresh))
        zone = overlap & (away <= self._depth)
        if not zone.any() or not fresh.any():
            return np.zeros_like(fresh)
        # What is old stays at the far end, and where it goes on outside the piece.
        rim = np.asarray(distance_transform_edt(np.pad(overlap | fresh, 1)))[1:-1, 1:-1] <= 1
        old = zone & (rim | (away > self._depth - 1))
        node = (zone | fresh).ravel()
        edges = Grid(*fresh.shape).edges
        edges = edges[node[edges].all(1)]
        shown = np.where(fresh[..., None], new, self._canvas.colour[sites])
        cost = seam_costs(shown.reshape(node.size, -1), new.reshape(node.size, -1), edges)
        numbered = (np.cumsum(node) - 1)[edges]
        taken = np.zeros(node.size, bool)
        taken[node] = cheapest_cut(numbered, cost, one=fresh.ravel()[node], other=old.ravel()[node])
        return taken.reshape(fresh.shape) & zone

    def _meet(self, corner: Int[np.ndarray, "2"], painted: Bool[np.ndarray, "row column"]) -> None:
        """Where a piece about to be painted and what it leaves are near each other, the band goes on."""
        from scipy.ndimage import distance_transform_edt

        reach = self._reach
        new = np.pad(painted, reach)
        sites = self._sites(corner - reach, new.shape)
        old = (sites >= 0) & (self._canvas.label[sites] >= 0) & ~new
        if not old.any():
            return
        near = [np.asarray(distance_transform_edt(~side)) <= reach for side in (new, old)]
        met = sites[(old & near[0]) | (new & near[1])]
        self.band[met[self._free[met]]] = True

    def _learn(
        self,
        corner: Int[np.ndarray, "2"],
        sites: Int[np.ndarray, "row column"],
        known: Bool[np.ndarray, "row column"],
        *,
        forget: bool = False,
    ) -> None:
        """All samples' placements match what the canvas shows there from now on, or no more."""
        if not known.any():
            return
        colour = self._canvas.colour[sites][..., self._channels]
        at = int(corner[0]), int(corner[1])
        for sample in self._samples:
            change = sample.placement.take_away if forget else sample.placement.add
            change(at, colour, known)

    def _sites(self, corner: Int[np.ndarray, "2"], shape: tuple[int, ...]) -> Int[np.ndarray, "row column"]:
        """The sites of a rectangle."""
        row, column = (at + np.arange(side) for at, side in zip(corner, shape, strict=True))
        return self._lattice.site_at(row[:, None], column)

    def _sample(self, part: Part, usable: Bool[np.ndarray, "row column"]) -> _Sample:
        """The rectangle, ready to be placed."""
        texels, usable = self._image[part.slices][..., self._channels], usable[part.slices]
        core = _core(usable, round(_BORDER * self._depth))
        return _Sample(part, Placement(texels, usable, core, self._lattice))


def _promising(
    covering: Covering, core: Bool[np.ndarray, "row column"]
) -> tuple[Int[np.ndarray, "n 2"], Float[np.ndarray, "n"], Int[np.ndarray, "n"]]:
    """The texels to lay on a site so that enough overlaps, the cheapest of each cell; their costs and fresh sites."""
    overlap, fresh = covering.overlap, covering.fresh
    fits = core & (overlap > 0)
    fits &= overlap >= min(_OVERLAP * core.size, overlap[fits].max(initial=0))
    fits &= fresh >= max(_FRESH * fresh[fits].max(initial=0), _LEAST * np.count_nonzero(core))
    cost = np.where(fits, covering.cost, np.inf)
    cost = np.pad(cost, [(0, -side % _CELL) for side in cost.shape], constant_values=np.inf)
    rows, columns = (side // _CELL for side in cost.shape)
    cells = cost.reshape(rows, _CELL, columns, _CELL).swapaxes(1, 2).reshape(rows, columns, -1)
    row, column = np.nonzero(np.isfinite(cells.min(2)))
    cheapest = cells[row, column].argmin(1)
    texel = np.stack([row, column], 1) * _CELL + np.stack(np.divmod(cheapest, _CELL), 1)
    return texel, cells[row, column, cheapest], fresh[texel[:, 0], texel[:, 1]]


def _core(usable: Bool[np.ndarray, "row column"], margin: int) -> Bool[np.ndarray, "row column"]:
    """Texels farther than ``margin`` from what may not be used; nearer where that leaves under a quarter."""
    from scipy.ndimage import distance_transform_edt

    inside = np.asarray(distance_transform_edt(np.pad(usable, 1)))[1:-1, 1:-1]
    while 4 * np.count_nonzero(inside > margin) < np.count_nonzero(usable):
        margin //= 2
    return inside > margin


def _windows(exemplar: Exemplar, lattice: Lattice, seed: int) -> list[Part]:
    """What is laid as one: each sample whole, on a torus no larger than the torus, cut out where most may be used."""
    parts = exemplar.parts or (Part(0, 0, *exemplar.shape),)
    parts = [part for part in parts if exemplar.usable[part.slices].any()]
    if not lattice.wrap:
        return parts
    cut = []
    for number, part in enumerate(parts):
        rows, columns = min(part.rows, lattice.rows), min(part.columns, lattice.columns)
        sums = np.pad(np.cumsum(np.cumsum(exemplar.usable[part.slices], 0), 1), ((1, 0), (1, 0)))
        held = sums[rows:, columns:] - sums[:-rows, columns:] - sums[rows:, :-columns] + sums[:-rows, :-columns]
        most = np.argwhere(held == held.max())
        drawn = draws.uniform(seed, _CROP, index=np.array([number]))[0]
        row, column = most[int(drawn * len(most))].tolist()
        cut.append(Part(part.row + row, part.column + column, rows, columns))
    return cut
