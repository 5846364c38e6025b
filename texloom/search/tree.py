"""Search by PCA and a kd-tree: exact in the reduced space (Shin & Shin 2004, section 3; Liang et al. 2001)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float32, Int32

from texloom.arrays import fours
from texloom.exemplar.pca import Projection, fit
from texloom.kernels.launch import launch
from texloom.kernels.tree import nearest_in_tree
from texloom.search.matching import Match, State, Vectors, squared_distance

_LEAF = 12  # points in a leaf, at most


@dataclass(frozen=True)
class PcaTree:
    """PCA + kd-tree. Its cost grows fast with ``dimensions``: from about 16 on, ``PcaNearest`` is quicker.

    The first dimensions hold the shape of a neighbourhood; what they miss is for the caller to compare.
    """

    dimensions: int = 12

    def prepare(self, vectors: Vectors) -> "PcaTreeIndex":
        """Find the axes and sort the candidates into a tree."""
        return PcaTreeIndex(vectors, fit(vectors, self.dimensions))

    def restore(self, vectors: Vectors, state: State) -> "PcaTreeIndex":
        """The axes were found before."""
        return PcaTreeIndex(vectors, Projection(state["mean"], state["axes"]))


@dataclass(frozen=True, eq=False)
class PcaTreeIndex:
    """Candidates, their principal axes, and the tree of the projections."""

    vectors: Vectors
    projection: Projection

    def nearest(self, queries: Float32[np.ndarray, "query dim"]) -> Match:
        """The candidate nearest among the projections; its cost is that of the whole vectors."""
        index = np.ascontiguousarray(self._tree.nearest(self.projection(queries), 1)[0][:, 0])
        return Match(index, squared_distance(queries, self.vectors, index))

    def state(self) -> State:
        """The axes."""
        return {"mean": self.projection.mean, "axes": self.projection.axes}

    @cached_property
    def _tree(self) -> "KdTree":
        return KdTree.of(self.projection(self.vectors))


@dataclass(frozen=True, eq=False)
class KdTree:
    """A complete tree, level by level: the children of node ``i`` are ``2i + 1`` and ``2i + 2``.

    A node holds ``points[first : last]``; ``low`` and ``high`` are the corners of the box around them. Points lie in
    the order of the leaves; ``index`` tells which candidate each is. Coordinates of 0 make them a multiple of four.
    """

    points: Float32[np.ndarray, "candidate dim"]
    index: Int32[np.ndarray, "candidate"]
    low: Float32[np.ndarray, "node dim"]
    high: Float32[np.ndarray, "node dim"]
    first: Int32[np.ndarray, "node"]
    last: Int32[np.ndarray, "node"]

    @staticmethod
    def of(points: Float32[np.ndarray, "candidate dim"]) -> "KdTree":
        """Split at the median of the widest axis, again and again. O(n log n) time."""
        points = _in_fours(points)
        order = np.arange(len(points), dtype=np.int32)
        levels = [np.array([0, len(points)])]  # where the nodes of each level begin, and the end
        for _ in range(max(0, int(np.ceil(np.log2(len(points) / _LEAF))))):
            start = levels[-1]
            middle = start[:-1] + np.diff(start) // 2
            for first, half, last in zip(start[:-1].tolist(), middle.tolist(), start[1:].tolist(), strict=True):
                own = order[first:last]
                axis = np.ptp(points[own], axis=0).argmax()
                order[first:last] = own[np.argpartition(points[own, axis], half - first)]
            levels.append(np.sort(np.concatenate([start, middle])))
        points = np.ascontiguousarray(points[order])
        return KdTree(
            points,
            order,
            low=np.concatenate([np.minimum.reduceat(points, start[:-1]) for start in levels]),
            high=np.concatenate([np.maximum.reduceat(points, start[:-1]) for start in levels]),
            first=np.concatenate([start[:-1] for start in levels]).astype(np.int32),
            last=np.concatenate([start[1:] for start in levels]).astype(np.int32),
        )

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """The tree as kernels take it."""
        return fours(self.points), self.index, fours(self.low), fours(self.high), self.first, self.last

    def nearest(
        self, queries: Float32[np.ndarray, "query dim"], count: int
    ) -> tuple[Int32[np.ndarray, "query count"], Float32[np.ndarray, "query count"]]:
        """The ``count`` nearest candidates of every query, nearest first, and their squared distances.

        Where there are fewer candidates, the rest is -1 at infinity.
        """
        found = np.full((len(queries), count), -1, np.int32)
        cost = np.full((len(queries), count), np.inf, np.float32)
        inputs = [*self.arrays, fours(_in_fours(queries))]
        launch(nearest_in_tree, len(queries), inputs=inputs, outputs=[found, cost])
        return found, cost


def _in_fours(points: Float32[np.ndarray, "n dim"]) -> Float32[np.ndarray, "n padded"]:
    return np.ascontiguousarray(np.pad(points, ((0, 0), (0, -points.shape[1] % 4))))
