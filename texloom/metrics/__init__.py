"""Is a result good: scores against the sample it was made from."""

from texloom.metrics.copying import copy_side, copy_side_of_sources
from texloom.metrics.score import Scores, score
from texloom.metrics.seam import seam_ratio

__all__ = ["Scores", "copy_side", "copy_side_of_sources", "score", "seam_ratio"]
