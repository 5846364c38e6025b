"""Even points on a mesh, in nested levels, and the operations of an image pyramid on them."""

from texloom.points.hierarchy import Hierarchy, Level, hierarchy
from texloom.points.pyramid import Pyramid

__all__ = ["Hierarchy", "Level", "Pyramid", "hierarchy"]
