"""A triangulation of points that move over a mesh, come and go; it stays the surface it was.

Points never change their neighbours by being near, only by flips, so sheets that lie close to each other do not mix,
and parts, handles and boundaries stay as many as they are.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int, Int32

from texloom import draws
from texloom.kernels.launch import launch
from texloom.kernels.middles import halve
from texloom.kernels.points import repel
from texloom.kernels.retiling import collapse_edges, flip_edges, mark_flips, split_edges
from texloom.mesh.mesh import Mesh
from texloom.points.ground import Ground
from texloom.points.places import Places

_ORDER = 0x706F  # purpose of the draw that orders edges
_REACH = 1.35  # spacings within which neighbours repel
_GAIN = 0.22  # spacings a neighbour at hand would push in a step
_SWING = 0.7  # of a step, gone again in the next one
_MIDDLE = 0.3  # of an edge's length, that its middle on the ground is at least away from its faces' corners
_ASIDE = 4.0  # times as near it may be to the corners opposite
_PARTED = 0.5  # cosine between normals, below which an edge may cut a ridge
_LEAST_TURN = 0.2  # cosine of the most a face may turn when a point beside it goes


@dataclass(eq=False)
class Tiling:
    """The triangulation in the making; its methods change it in place."""

    ground: Ground
    places: Places
    faces: Int32[np.ndarray, "face 3"]
    twins: Int32[np.ndarray, "halfedge"]
    first: Int32[np.ndarray, "point"]  # a halfedge from each point
    rim: Int32[np.ndarray, "point"]  # 1 on a boundary
    bend: float  # what opposite normals add to a distance, half of it, over the scale
    frozen: int = 0  # the first points stay as they are

    @property
    def count(self) -> int:
        """Points."""
        return len(self.rim)

    @property
    def _net(self) -> dict[str, np.ndarray]:
        """For the kernels."""
        return {"tail": self.faces.reshape(-1), "twin": self.twins, "first": self.first, "rim": self.rim}

    def edges(self) -> tuple[Int32[np.ndarray, "edge"], Float64[np.ndarray, "edge"]]:
        """One halfedge of every edge (on a boundary the only one), and the edge's length over the scale there."""
        halfedges = np.flatnonzero(np.arange(len(self.twins)) > self.twins).astype(np.int32)
        tails, heads = self.ends(halfedges)
        apart = self.places.at.take(tails, axis=0) - self.places.at.take(heads, axis=0)
        return halfedges, norms(apart) / (0.5 * (self.places.scale[tails] + self.places.scale[heads]))

    def ends(self, halfedges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The points they run from and to."""
        corners = self.faces.reshape(-1)
        return corners[halfedges], corners[_next(halfedges)]

    @property
    def edge_count(self) -> int:
        """Edges."""
        return self.faces.size - int((self.twins >= 0).sum()) // 2

    def copy(self, *, bend: float, frozen: int) -> "Tiling":
        """Another of the same points, which may change alone."""
        places = self.places[np.arange(self.count)]
        faces, twins, first, rim = (array.copy() for array in (self.faces, self.twins, self.first, self.rim))
        return Tiling(self.ground, places, faces, twins, first, rim, bend, frozen)

    def spread(self, spacing: float, steps: int, who: Int32[np.ndarray, "mover"] | None = None) -> None:
        """Let points repel their neighbours, and flip edges as they pass: all that are not frozen, or only some."""
        movers = np.arange(self.frozen, self.count, dtype=np.int32) if who is None else who[who >= self.frozen]
        into = slice(self.frozen, None) if who is None else movers
        moved, last = Places.empty(len(movers)), self.places.at[movers]
        halfedges = None if who is None else self._halfedges(movers)
        for _ in range(steps):
            forces = [spacing, _REACH, _GAIN, _SWING, last]
            inputs = [self.ground.arrays, self._net, self.places.arrays, movers, *forces]
            launch(repel, len(movers), inputs=inputs, outputs=[moved.arrays])
            last[:] = self.places.at[into]
            self.places.overwrite(into, moved)
            self.flip(halfedges)

    def flip(self, halfedges: Int32[np.ndarray, "halfedge"] | None = None) -> int:
        """Make edges Delaunay, all or some, and those around them; returns how many were flipped."""
        if halfedges is None:
            halfedges = np.arange(self.faces.size, dtype=np.int32)
        marked = np.empty(len(halfedges), np.uint8)
        judged = [self.places.arrays, self.bend]
        launch(mark_flips, len(marked), inputs=[halfedges, self._net, *judged], outputs=[marked])
        wanted = halfedges[marked == 1]
        stack = np.empty(4 * len(wanted) + 4096, np.int32)
        stack[: len(wanted)] = wanted[::-1]
        flips = np.zeros(1, np.int32)
        launch(flip_edges, 1, inputs=[len(wanted), *judged], outputs=[stack, self._net, flips])
        return int(flips[0])

    def around(self, points: Int[np.ndarray, "n"], rings: int) -> Int32[np.ndarray, "more"]:
        """These points and those at most so many edges away."""
        tails, heads = self.ends(self.edges()[0])
        near = np.zeros(self.count, bool)
        near[points] = True
        for _ in range(rings):
            reached = near[tails] | near[heads]
            near[tails[reached]] = near[heads[reached]] = True
        return np.flatnonzero(near).astype(np.int32)

    def take_out(self, points: Int32[np.ndarray, "n"]) -> None:
        """Take out points, where the surface stays what it was without them."""
        self._collapse(self.first[points], most=len(points), longest=np.inf, turn=-2.0)

    def _halfedges(self, points: Int32[np.ndarray, "n"]) -> Int32[np.ndarray, "halfedge"]:
        """All halfedges of the faces within an edge of these points, where flips may become due."""
        chosen = np.zeros(self.count, bool)
        chosen[self.around(points, 1)] = True
        return np.flatnonzero(np.repeat(chosen[self.faces].any(axis=1), 3)).astype(np.int32)

    def thin_out(self, longest: float, *, most: int, seed: int, shortest_first: bool, careful: bool = True) -> int:
        """Take out points at the ends of edges shorter than ``longest``, ``most`` of them; returns how many.

        A careful one leaves points without which a face would turn far.
        """
        halfedges, lengths = self.edges()
        short = np.flatnonzero(lengths < longest)
        bits = draws.bits(seed, _ORDER, self.count, index=halfedges[short])
        order = np.lexsort((bits, lengths[short])) if shortest_first else np.argsort(bits, kind="stable")
        halfedges = halfedges[short[order]]
        heads = (bits[order] & 1 == 1) & (self.twins[halfedges] >= 0)  # or a boundary would lose its tails only
        halfedges = np.where(heads, self.twins[halfedges], halfedges)
        return self._collapse(halfedges, most=most, longest=longest, turn=_LEAST_TURN if careful else -2.0)

    def _collapse(self, halfedges: Int32[np.ndarray, "edge"], *, most: int, longest: float, turn: float) -> int:
        """Take out points by these edges, in their order; returns how many."""
        gone = np.zeros(1, np.int32)
        inputs = [halfedges, most, longest, turn, self.frozen, self.places.arrays, self.bend]
        launch(collapse_edges, 1, inputs=inputs, outputs=[np.empty(4096, np.int32), self._net, gone])
        if gone[0]:
            self._pack()
        return int(gone[0])

    def middles(self, halfedges: Int32[np.ndarray, "edge"]) -> Places:
        """The middles of edges, on the ground."""
        middles = Places.empty(len(halfedges))
        inputs = [self.ground.arrays, self._net, self.places.arrays, halfedges]
        launch(halve, len(halfedges), inputs=inputs, outputs=[middles.arrays])
        return middles

    def fill_in(self, most: int, *, careful: bool = False) -> int:
        """Put points on the longest edges, ``most`` of them, none into a face that got one; returns how many.

        A careful one leaves edges alone that cut a ridge, whose middle on the ground is far from theirs.
        """
        halfedges, lengths = self.edges()
        if careful:
            lengths[self._agreement(halfedges) < _PARTED] = 0.0
        chosen = halfedges[np.argsort(-lengths, kind="stable")[: 3 * most + 256]]
        middles = self.middles(chosen)
        good = np.flatnonzero(self._clearance(chosen, middles) >= _MIDDLE)
        if len(good) == 0:
            return 0
        chosen = chosen[good]
        points, extra = self.count, len(chosen)
        self.places = self.places.joined(middles[good])
        self.rim = np.concatenate([self.rim, (self.twins[chosen] < 0).astype(np.int32)])
        self.faces = np.concatenate([self.faces, np.full((2 * most, 3), -1, np.int32)])
        self.twins = np.concatenate([self.twins, np.full(6 * most, -1, np.int32)])
        self.first = np.concatenate([self.first, np.full(extra, -1, np.int32)])
        count = np.zeros(2, np.int32)
        for anyhow in (False, True):
            if count[0] == 0:
                inputs = [chosen, most, points, len(self.faces) - 2 * most, anyhow, self.places.arrays, self.bend]
                launch(split_edges, 1, inputs=inputs, outputs=[np.empty(4096, np.int32), self._net, count])
        self._pack()
        return int(count[0])

    def _agreement(self, halfedges: Int32[np.ndarray, "edge"]) -> Float64[np.ndarray, "edge"]:
        """Cosine between the normals at both ends."""
        tails, heads = self.ends(halfedges)
        return np.einsum("ij,ij->i", self.places.normal[tails], self.places.normal[heads])

    def _clearance(self, halfedges: Int32[np.ndarray, "edge"], middles: Places) -> Float64[np.ndarray, "edge"]:
        """How far the middles of edges are from the corners of their faces, over the edges' lengths."""
        tails, heads = self.ends(halfedges)
        across = np.where(self.twins[halfedges] >= 0, self.twins[halfedges], halfedges)
        far = [self.ends(_next(_next(each)))[0] for each in (halfedges, across)]
        ends, aside = (
            np.minimum(*(norms(self.places.at[corner] - middles.at) for corner in pair))
            for pair in ((tails, heads), far)
        )
        return np.minimum(ends, _ASIDE * aside) / norms(self.places.at[tails] - self.places.at[heads])

    def quarter(self) -> None:
        """Put a point in the middle of every edge, and cut each face in four."""
        halfedges, _ = self.edges()
        number = np.empty(self.faces.size, np.int32)
        number[halfedges] = np.arange(self.count, self.count + len(halfedges), dtype=np.int32)
        inner = self.twins[halfedges] >= 0
        number[self.twins[halfedges[inner]]] = number[halfedges[inner]]
        middle = number.reshape(-1, 3)
        a, b, c = self.faces.T
        ab, bc, ca = middle.T
        self.places = self.places.joined(self.middles(halfedges))
        self.rim = np.concatenate([self.rim, (~inner).astype(np.int32)])
        self.faces = np.stack([a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca], axis=1).reshape(-1, 3)

        # Child k at corner k: halves of the sides from and to it, and the side it shares with the last child
        face, side = np.divmod(np.arange(self.twins.size, dtype=np.int32), 3)
        onto = self.twins
        from_corner = 12 * face + 3 * side
        to_corner = 12 * (onto // 3) + 3 * ((onto % 3 + 1) % 3) + 2
        twins = np.empty(4 * self.twins.size, np.int32)
        twins[from_corner] = np.where(onto < 0, -1, to_corner)
        last = 12 * face + 9 + (side + 2) % 3
        twins[from_corner + 1], twins[last] = last, from_corner + 1
        onto_from = 12 * (onto // 3) + 3 * (onto % 3)
        twins[12 * face + 3 * ((side + 1) % 3) + 2] = np.where(onto < 0, -1, onto_from)
        self.twins = twins
        self.first = any_halfedge(self.faces, self.count)

    def mesh(self) -> Mesh:
        """As it is now, in world units."""
        return Mesh(self.places.at + self.ground.origin, self.faces.copy())

    def _pack(self) -> None:
        """Leave out faces and points that are gone."""
        kept_faces = self.faces[:, 0] >= 0
        kept = self.first >= 0
        point = np.cumsum(kept, dtype=np.int32) - 1
        face = np.cumsum(kept_faces, dtype=np.int32) - 1
        twins = self.twins.reshape(-1, 3)[kept_faces].reshape(-1)
        self.twins = np.where(twins < 0, -1, 3 * face[twins // 3] + twins % 3).astype(np.int32)
        self.faces = point[self.faces[kept_faces]]
        self.rim, self.places = self.rim[kept], self.places[kept]
        self.first = any_halfedge(self.faces, self.count)


def any_halfedge(faces: Int32[np.ndarray, "face 3"], count: int) -> Int32[np.ndarray, "point"]:
    """A halfedge from every point."""
    first = np.full(count, -1, np.int32)
    first[faces.reshape(-1)] = np.arange(faces.size, dtype=np.int32)
    return first


def _next(halfedges: np.ndarray) -> np.ndarray:
    """The halfedge after each in its face."""
    return halfedges + np.where(halfedges % 3 == 2, -2, 1)


def norms(vectors: Float64[np.ndarray, "n 3"]) -> Float64[np.ndarray, "n"]:
    return np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
