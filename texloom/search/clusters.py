"""Search by clusters: the nearest centre first, then the nearest candidate of its cluster."""

from dataclasses import dataclass
from functools import cached_property
from math import isqrt

import numpy as np
from jaxtyping import Float32, Int32

from texloom.exemplar.blas import single_threaded
from texloom.exemplar.pca import Projection, fit
from texloom.kernels.launch import parallel_map
from texloom.search.exhaustive import ExhaustiveIndex
from texloom.search.kmeans import cluster
from texloom.search.matching import Match, State, Vectors, squared_distance


@dataclass(frozen=True, kw_only=True)
class Clusters:
    """k-means on the whole vectors (Chen, Liu & Dong, section 4.1.2, "Clustering")."""

    clusters: int | None = None  # None: the square root of the number of candidates, where both steps cost the same
    passes: int = 10  # of Lloyd's steps
    seed: int = 0

    def prepare(self, vectors: Vectors) -> "ClusterIndex":
        """Cluster the candidates."""
        count = min(self.clusters or max(isqrt(len(vectors)), 1), len(vectors))
        centres, label = cluster(vectors, count, seed=self.seed, passes=self.passes)
        return ClusterIndex(vectors, centres, label)

    def restore(self, vectors: Vectors, state: State) -> "ClusterIndex":
        """The clusters were found before."""
        return ClusterIndex(vectors, state["centres"], state["label"])


@dataclass(frozen=True, eq=False)
class ClusterIndex:
    """Candidates in clusters."""

    vectors: Vectors
    centres: Float32[np.ndarray, "cluster dim"]
    label: Int32[np.ndarray, "candidate"]

    def nearest(self, queries: Float32[np.ndarray, "query dim"]) -> Match:
        """The nearest candidate in the cluster of the nearest centre: often, not always, the nearest of all."""
        home = self._centre_search.nearest(queries).index
        asked = _groups(home, len(self.centres))
        index = np.empty(len(queries), np.int32)
        cost = np.empty(len(queries), np.float32)

        def search_within(label: int) -> None:
            found, found_cost = self._member_search[label].nearest_in_block(queries[asked[label]])
            index[asked[label]], cost[asked[label]] = self._members[label][found], found_cost

        with single_threaded():
            parallel_map(search_within, len(self.centres))
        return Match(index, cost)

    def state(self) -> State:
        """Centres and labels."""
        return {"centres": self.centres, "label": self.label}

    @cached_property
    def _centre_search(self) -> ExhaustiveIndex:
        return ExhaustiveIndex(self.centres)

    @cached_property
    def _members(self) -> list[Int32[np.ndarray, "member"]]:
        """Candidates of each cluster, lowest first."""
        return _groups(self.label, len(self.centres))

    @cached_property
    def _member_search(self) -> list[ExhaustiveIndex]:
        return [ExhaustiveIndex(self.vectors[members]) for members in self._members]


@dataclass(frozen=True, kw_only=True)
class PcaClusters:
    """k-means along principal axes (Chen, Liu & Dong, section 4.1.2, "PCA+Clustering")."""

    dimensions: int = 30
    clusters: int | None = None  # None: the square root of the number of candidates
    passes: int = 10  # of Lloyd's steps
    seed: int = 0

    def prepare(self, vectors: Vectors) -> "PcaClusterIndex":
        """Find the axes and cluster the projections."""
        projection = fit(vectors, self.dimensions)
        return PcaClusterIndex(vectors, projection, self._within.prepare(projection(vectors)))

    def restore(self, vectors: Vectors, state: State) -> "PcaClusterIndex":
        """Axes and clusters were found before."""
        projection = Projection(state["mean"], state["axes"])
        return PcaClusterIndex(vectors, projection, self._within.restore(projection(vectors), state))

    @property
    def _within(self) -> Clusters:
        return Clusters(clusters=self.clusters, passes=self.passes, seed=self.seed)


@dataclass(frozen=True, eq=False)
class PcaClusterIndex:
    """Candidates, their principal axes, and the clusters of their projections."""

    vectors: Vectors
    projection: Projection
    projected: ClusterIndex

    def nearest(self, queries: Float32[np.ndarray, "query dim"]) -> Match:
        """The candidate found among the projections; its cost is that of the whole vectors."""
        index = self.projected.nearest(self.projection(queries)).index
        return Match(index, squared_distance(queries, self.vectors, index))

    def state(self) -> State:
        """Axes, centres and labels."""
        return {"mean": self.projection.mean, "axes": self.projection.axes, **self.projected.state()}


def _groups(label: Int32[np.ndarray, "item"], count: int) -> list[Int32[np.ndarray, "member"]]:
    """Items of each label, lowest first."""
    order = np.argsort(label, kind="stable").astype(np.int32)
    return np.split(order, np.cumsum(np.bincount(label, minlength=count))[:-1])
