"""Is a result good: scores against the sample it was made from."""

from texloom.metrics.copying import copy_side, copy_side_of_sources
from texloom.metrics.score import Scores, score
from texloom.metrics.seam import seam_ratio
from texloom.metrics.surface import SurfaceScores, chart_seam_ratio, score_surface
from texloom.metrics.surface_copying import apparent_sources, surface_copy_side

__all__ = [
    "Scores",
    "SurfaceScores",
    "apparent_sources",
    "chart_seam_ratio",
    "copy_side",
    "copy_side_of_sources",
    "score",
    "score_surface",
    "seam_ratio",
    "surface_copy_side",
]
