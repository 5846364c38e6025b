"""Best patch for a query: exhaustive, along principal axes, by clusters, or both; all interchangeable."""

from texloom.search.clusters import Clusters, PcaClusters
from texloom.search.exhaustive import Exhaustive
from texloom.search.matching import Index, Match, Search
from texloom.search.principal import PcaNearest

SEARCHES: dict[str, Search] = {
    "exhaustive": Exhaustive(),
    "pca": PcaNearest(),
    "pca-clusters": PcaClusters(),
    "clusters": Clusters(),
}
"""By the names the command line knows."""

__all__ = ["SEARCHES", "Clusters", "Exhaustive", "Index", "Match", "PcaClusters", "PcaNearest", "Search"]
