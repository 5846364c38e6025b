"""Textures by the cells of a drawing: planar graphs of curved edges, and what is grown in them."""

from texloom.sketch.cells import Cells
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.mends import Mend
from texloom.sketch.random import random_cells
from texloom.sketch.read import read_sketch

__all__ = ["CellGraph", "Cells", "Mend", "random_cells", "read_sketch", "straight"]
