"""Textures by the cells of a drawing: planar graphs of curved edges, and what is grown in them.

``graph`` is what all of it is about; ``reading`` makes graphs of files, ``mesh`` lays them over a texture, ``filling``
fills their cells; ``design`` is the whole, in stages.
"""

from texloom.sketch.cells import Cells
from texloom.sketch.graph import CellGraph, straight
from texloom.sketch.random import random_cells
from texloom.sketch.reading.mends import Mend
from texloom.sketch.reading.read import read_sketch

__all__ = ["CellGraph", "Cells", "Mend", "random_cells", "read_sketch", "straight"]
