"""The texture mesh: cells like a sketch's, over a texture of any size (Wang et al. 2014, §3.1)."""

from dataclasses import dataclass

import numpy as np

from texloom.errors import ParameterError
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.disks import refined
from texloom.sketch.mesh.patch import Patch, Sketches, seamless_patch
from texloom.sketch.mesh.scale import cell_size
from texloom.sketch.mesh.tiling import Tiling, on_plane, tile

_STRAY = 0.25  # of a cell: bricks stay bricks, repetition goes
_FINEST, _COARSEST = 1.0, 16.0  # texels across a cell, and textures: beyond, there is nothing to see of cells


@dataclass(frozen=True, kw_only=True)
class TextureMesh:
    """How a sketch, or several, become a texture mesh, in three stages: patch, tiling, refinement.

    Each can be run alone when what it depends on has changed: the patch on the sketch, the tiling on size, scale and
    tileable, the refinement on radius, iterations and strength.
    """

    size: tuple[int, int]  # rows, columns
    scale: float = 1.0  # texels of the texture in one of the sketch
    tileable: bool = False
    radius: float = 15.0  # texels; small for a regular mesh, large for a natural one (fig. 15)
    iterations: int = 4
    strength: float = 0.5  # w of eq. 7

    def __post_init__(self) -> None:
        if min(self.size) < 1:
            raise ParameterError(f"a texture of {self.size[1]}×{self.size[0]} texels: both must be 1 or more")
        if not 0 < self.scale < np.inf:
            raise ParameterError(f"scale {self.scale:g}: it must be above 0, and finite")
        if not 0 <= self.radius < np.inf or self.iterations < 0:
            raise ParameterError(f"radius {self.radius:g}, iterations {self.iterations}: finite, and neither below 0")
        if not 0 <= self.strength <= 1:
            raise ParameterError(f"strength {self.strength:g}: it must be between 0 and 1")

    @staticmethod
    def of(
        sketch: CellGraph,
        size: tuple[int, int],
        *,
        cell: float | None = None,
        scale: float | None = None,
        radius: float | None = None,
        tileable: bool = False,
    ) -> "TextureMesh":
        """A mesh of a sketch's cells that stray by a quarter of one, unless ``radius`` is given.

        Cells are ``cell`` texels across, such as those of a sample (``SketchSample.cell_size``), or as large as drawn;
        or ``scale`` is given. Several sketches are first brought to one size (``alike``).

        Raises: ParameterError, for a sketch without cells, or a value out of its range.
        """
        own = cell_size(sketch)
        if scale is None:
            scale = 1.0 if cell is None else cell / own
        if not _FINEST < scale * own < _COARSEST * max(size):
            many = f"cells of {scale * own:.3g} texels at scale {scale:g}, for a texture of {size[1]}×{size[0]}"
            raise ParameterError(
                f"{many}: choose a scale between {_FINEST / own:.2g} and {_COARSEST * max(size) / own:.2g}"
            )
        stray = _STRAY * scale * own if radius is None else radius
        return TextureMesh(size=size, scale=scale, tileable=tileable, radius=stray)

    def run(self, sketch: Sketches, seed: int) -> CellGraph:
        """All stages at once."""
        return self.refined(self.tiled(self.patch(sketch, seed)), seed)

    def patch(self, sketch: Sketches, seed: int) -> Patch:
        """The seamless patch of a sketch; of several, cells as large in all, the best there is."""
        return seamless_patch(sketch, seed)

    def tiled(self, patch: Patch) -> Tiling:
        """The patch laid side by side, on a torus with room for the texture."""
        return tile(patch, self.size, scale=self.scale, tileable=self.tileable)

    def refined(self, tiling: Tiling, seed: int) -> CellGraph:
        """The texture mesh: on a torus if it is to tile, else on a plane, with all of the cells that reach into it."""
        graph = refined(tiling, seed, radius=self.radius, iterations=self.iterations, strength=self.strength)
        if self.tileable:
            return graph
        moved = np.abs(graph.vertices - tiling.graph.vertices).max(initial=0)
        widest = (tiling.patch.widest * tiling.scale).max() + 2 * moved
        return on_plane(graph, self.size, float(widest))
