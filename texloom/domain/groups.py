"""Groups of faces as one patch: where triangles are smaller than a texture's features, many are laid flat together."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import warp as wp
from jaxtyping import Bool, Complex128, Float64, Int32

from texloom import draws
from texloom.domain.cover import group_by_site
from texloom.errors import ParameterError
from texloom.kernels.group_layout import relax_groups
from texloom.kernels.groups import BINS, grow_groups, recentre
from texloom.kernels.launch import launch
from texloom.kernels.scatter import scatter_sites
from texloom.mesh.mesh import Mesh

_CHANCE = 0x6772  # purpose of the draw that orders the seeds
_APART = 0.79  # of the width: with what is shared out, groups then have about a squared width
_SMALL = 0.15  # of a squared width: groups below are shared out among their neighbours
_MOST = 1.5  # stretch or squeeze of any face
_STEPS, _TOLERANCE = 60, 1e-2  # conjugate gradients of a group: at most, and when to end (texels)
_NEEDLE = 2.0  # widths a face of a small area may be long
_ROUNDS = 4  # of laying out a group
_TIMES = 3  # new seeds are tried among what is left


@dataclass(frozen=True)
class _Limits:
    """What a face may depart from its group to join it."""

    angle: float  # degrees between its field and the group's
    gap: float  # of the edge's length, where the group closes on itself
    reach: float  # widths between its middle and the group's centre

    def bent(self, order: int) -> float:
        """The angle as 1 - cos(n angle), such that a field's directions are still told apart."""
        return 1 - np.cos(min(order * np.radians(self.angle), 0.75 * np.pi))


_USUAL = _Limits(25.0, 0.3, 1.0)
_RELAXED = _Limits(35.0, 0.4, 1.5)
_STRICTER = (_Limits(15.0, 0.15, 0.8), _Limits(8.0, 0.05, 0.6))


@dataclass(frozen=True, eq=False)
class Groups:
    """Faces grouped into patches, each a disc laid flat as one piece: a vertex has one place in a patch.

    Distances and angles are those of the faces laid flat by themselves as nearly as one piece can be; no face is
    flipped, or stretched by more than half. A patch of one face lies exactly as that face by itself.
    """

    patch: Int32[np.ndarray, "face"]  # numbered in the order of their lowest face
    layout: Complex128[np.ndarray, "face 3"]  # corners in the patch's plane, texels (column + 1j * row)


def group(mesh: Mesh, flat: Complex128[np.ndarray, "face 3"], *, order: int, width: float, seed: int = 0) -> Groups:
    """Groups of faces about ``width`` texels across, following a direction field of symmetry ``order``.

    ``flat`` is every face laid flat by itself, in texels, along the field, all with the same orientation. The mesh is
    mended: manifold. A face with a side longer than ``width`` stays alone, unless it is thin and less than two long.

    Seeds spread evenly grow all at once, the nearest face first, by gluing faces to the edges of their group; a face
    joins where its field runs as the group's does and its vertices are new or lie where they should. Once the groups
    start anew from their middles, small ones are shared out among their neighbours, and each is relaxed towards its
    faces' own edges (least squares), which follow the field. Where that stretches a face too much, lengths count more
    than the field; a group that cannot be laid out even so is broken up. O(face) time.

    Raises: ParameterError, unless the width is positive.
    """
    if not (np.isfinite(width) and width > 0):
        raise ParameterError(f"groups {width:g} texels wide: give a width above 0")
    return _Growth(mesh, flat, order, float(width), seed).run()


class _Growth:
    """Groups on their way: arrays as the kernels take them. A patch of -1 is free, -2 stays alone."""

    def __init__(self, mesh: Mesh, flat: np.ndarray, order: int, width: float, seed: int) -> None:
        self.mesh, self.flat, self.order, self.width, self.seed = mesh, flat, order, width, seed
        count = len(flat)
        self.pairs = _pairs(flat)
        ahead, back = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
        self.area = 0.5 * np.abs(np.imag(np.conj(ahead) * back))
        longest = np.maximum(np.maximum(np.abs(ahead), np.abs(back)), np.abs(back - ahead))
        needle = self.area < _SMALL * width**2
        self.patch = np.where(longest > np.where(needle, _NEEDLE, 1.0) * width, -2, -1).astype(np.int32)
        self.large = self.patch == -2
        self.branch = np.zeros(count, np.int32)
        self.node = np.arange(3 * count, dtype=np.int32)
        self.place = np.empty((3 * count, 2))
        self.centre = np.empty((4 * count, 2))  # a face may be a seed at first, shared out, and torn twice
        self.number = 0  # of groups so far
        self.oldest = 0  # of them that may still grow
        self.scattered = 0  # times

    def run(self) -> Groups:
        """All faces in groups."""
        if not self.large.all():
            self.gather()
        self.alone(self.large)
        return self.result()

    def gather(self) -> None:
        """Grow, even out, mend, lay out."""
        self.grow(self.scatter(), _USUAL)
        self.grow_from_middles()
        self.fill(_USUAL)
        self.share_out_small()
        self.fill(_USUAL)
        self.alone(self.patch == -1)
        self.lay_out()
        for limits in _STRICTER:
            if (self.patch == -1).any():
                self.oldest = self.number
                self.fill(limits)
                self.lay_out()
        self.alone(self.patch == -1)

    def scatter(self) -> Int32[np.ndarray, "seed"]:
        """Free faces spread evenly."""
        count, free = len(self.flat), np.flatnonzero(self.patch == -1)
        self.scattered += 1
        chance = draws.bits(self.seed, _CHANCE, self.scattered, index=free)
        turn = free[np.argsort(chance, kind="stable")].astype(np.int32)
        state, stamp, queue = np.zeros(count, np.int32), np.full(count, -1, np.int32), np.empty(count, np.int32)
        launch(scatter_sites, 1, inputs=[turn, *self.spread], outputs=[stamp, queue, state])
        return np.flatnonzero(state == 2).astype(np.int32)

    @cached_property
    def spread(self) -> list:
        """Faces as points to scatter: neighbours in compressed rows, places, no period, and how far apart."""
        mesh, across = self.mesh, self.mesh.twins.reshape(-1, 3)
        closed = across >= 0
        start = np.zeros(len(across) + 1, np.int32)
        np.cumsum(closed[:, 0].astype(np.int32) + closed[:, 1] + closed[:, 2], out=start[1:])
        p, q, r = (mesh.vertices[mesh.faces[:, c]] for c in range(3))
        place = ((p + q + r) / 3 - mesh.vertices.mean(axis=0)).astype(np.float32)
        texel = np.sqrt(mesh.face_areas / np.maximum(self.area, 1e-300))
        radius = (_APART * self.width * texel).astype(np.float32)
        return [start, across[closed] // 3, place, wp.vec3(0.0, 0.0, 0.0), radius]

    def grow(self, seeds: np.ndarray, limits: _Limits, middles: np.ndarray | None = None) -> None:
        """New groups from seeds, and the old ones, over the free faces; centres are the seeds' middles, or these."""
        if middles is None:
            middles = _pairs(self.flat[seeds].mean(axis=1))
        inputs = [seeds, middles, self.number, self.oldest, self.mesh.twins, self.pairs, self.order]
        measures = [limits.reach * self.width, limits.bent(self.order), limits.gap]
        scratch = [np.full(BINS, -1, np.int32), np.empty(len(self.node), np.int32)]
        outputs = [*scratch, self.patch, self.branch, self.node, self.place, self.centre]
        launch(grow_groups, 1, inputs=[*inputs, *measures], outputs=outputs)
        self.number += len(seeds)

    def grow_from_middles(self) -> None:
        """All groups again, from where their middles came to lie (a step of Lloyd's)."""
        number = self.number
        area, centre, least = np.zeros(number), np.zeros((number, 2)), np.full(number, np.inf)
        seeds, middles = np.empty(number, np.int32), np.empty((number, 2))
        inputs = [self.pairs, self.patch, self.node, self.place]
        launch(recentre, 1, inputs=inputs, outputs=[area, centre, least, seeds, middles])
        self.patch[self.patch >= 0] = -1
        self.number = 0
        self.grow(seeds, _USUAL, middles)

    def fill(self, limits: _Limits) -> None:
        """Groups from new seeds where faces are free, a few times."""
        for _ in range(_TIMES):
            if (self.patch == -1).any():
                self.grow(self.scatter(), limits)

    def share_out_small(self) -> None:
        """Faces of small groups join their neighbours, where they may."""
        grouped = np.maximum(self.patch, 0)
        area = np.bincount(grouped, weights=np.where(self.patch >= 0, self.area, 0.0), minlength=self.number)
        small = (area < _SMALL * self.width**2)[grouped] & (self.patch >= 0)
        if small.any():
            self.patch[small] = -1
            self.grow(np.empty(0, np.int32), _RELAXED)

    def alone(self, faces: Bool[np.ndarray, "face"]) -> None:
        """Each of these faces a group of its own."""
        index = np.flatnonzero(faces)
        self.patch[index] = self.number + np.arange(len(index), dtype=np.int32)
        self.number += len(index)
        self.branch[index] = 0
        corner = (3 * index[:, None] + np.arange(3)).reshape(-1)
        self.node[corner] = corner
        self.place[corner] = self.pairs[corner]

    def lay_out(self) -> None:
        """Relax the groups from the oldest on; those that cannot be laid well are free faces again."""
        groups = np.arange(self.oldest, self.number, dtype=np.int32)
        begin, face = group_by_site(np.maximum(self.patch, -1), self.number)
        size = len(self.node)
        scratch = [np.empty(size), np.empty(size), *(np.empty((size, 2)) for _ in range(3))]
        worst = np.ones(self.number)
        inputs = [groups, begin, face, self.pairs, self.order, self.branch, self.node]
        limits = [_ROUNDS, _MOST, _STEPS, _TOLERANCE]
        launch(relax_groups, len(groups), inputs=[*inputs, *limits], outputs=[*scratch, self.place, worst])
        torn = np.append(worst > _MOST, False)[self.patch] & (self.patch >= 0)
        self.patch[torn] = -1

    def result(self) -> Groups:
        """Groups by their lowest face, which keeps its first corner."""
        lowest = np.full(self.number, -1)
        lowest[self.patch[::-1]] = np.arange(len(self.patch))[::-1]
        kept = np.flatnonzero(lowest >= 0)
        kept = kept[np.argsort(lowest[kept], kind="stable")]
        rank = np.empty(self.number, np.int32)
        rank[kept] = np.arange(len(kept), dtype=np.int32)
        patch = rank[self.patch]
        layout = self.place.view(np.complex128)[self.node, 0].reshape(-1, 3)
        anchor = lowest[kept]
        moved = np.zeros(len(kept), np.complex128)
        np.subtract(self.flat[anchor, 0], layout[anchor, 0], out=moved)
        return Groups(patch, layout + moved[patch][:, None])


def _pairs(values: Complex128[np.ndarray, "..."]) -> Float64[np.ndarray, "n 2"]:
    """Complex numbers as a kernel takes them."""
    return np.ascontiguousarray(values, np.complex128).view(np.float64).reshape(-1, 2)
