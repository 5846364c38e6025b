"""Best patch for a query: exhaustive, along principal axes, in a tree, by clusters; all interchangeable."""

from texloom.search.clusters import Clusters, PcaClusters
from texloom.search.exhaustive import Exhaustive
from texloom.search.matching import Index, Match, Search
from texloom.search.principal import PcaNearest
from texloom.search.tree import PcaTree

SEARCHES: dict[str, Search] = {
    "exhaustive": Exhaustive(),
    "pca": PcaNearest(),
    "pca-tree": PcaTree(),
    "pca-clusters": PcaClusters(),
    "clusters": Clusters(),
}
"""By the names the command line knows."""

__all__ = ["SEARCHES", "Clusters", "Exhaustive", "Index", "Match", "PcaClusters", "PcaNearest", "PcaTree", "Search"]
