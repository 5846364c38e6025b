"""Texture grown from a sample, on anything.

exemplar = texloom.read_exemplar("bricks.png")
domain = texloom.Grid(1024, 1024, wrap=True)
result = texloom.synthesize(exemplar, domain, texloom.Optimize(), seed=7)
texloom.write_images("wall", texloom.gather_images(result.sources, exemplar, rows=1024, columns=1024))
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from texloom.domain.grid import Grid as Grid
    from texloom.domain.surface import Surface as Surface
    from texloom.domain.surface import texel_for_repeats as texel_for_repeats
    from texloom.exemplar.exemplar import Exemplar as Exemplar
    from texloom.exemplar.exemplar import from_array as from_array
    from texloom.exemplar.join import join as join
    from texloom.field.smooth import smoothest as smoothest
    from texloom.field.smooth import through_arrows as through_arrows
    from texloom.fusion.fuse import fuse as fuse
    from texloom.io.mesh import read_mesh as read_mesh
    from texloom.io.stack import read_exemplar as read_exemplar
    from texloom.mesh.mesh import Mesh as Mesh
    from texloom.metrics.score import score as score
    from texloom.output.filled import filled_maps as filled_maps
    from texloom.output.gather import gather_images as gather_images
    from texloom.output.image import write_images as write_images
    from texloom.sources import SourceMap as SourceMap
    from texloom.synthesis.boundary import BoundarySampling as BoundarySampling
    from texloom.synthesis.fill import fill as fill
    from texloom.synthesis.least_squares import LeastSquares as LeastSquares
    from texloom.synthesis.optimize import Optimize as Optimize
    from texloom.synthesis.patches import PatchSampling as PatchSampling
    from texloom.synthesis.refine import Refine as Refine
    from texloom.synthesis.refine_patches import RefinePatches as RefinePatches
    from texloom.synthesis.synthesize import synthesize as synthesize

__version__ = "0.1.0"

# Imported when first asked for: a command that needs one of them does not wait for the rest.
_HOMES = {
    "BoundarySampling": "synthesis.boundary",
    "Exemplar": "exemplar.exemplar",
    "Grid": "domain.grid",
    "LeastSquares": "synthesis.least_squares",
    "Mesh": "mesh.mesh",
    "Optimize": "synthesis.optimize",
    "PatchSampling": "synthesis.patches",
    "Refine": "synthesis.refine",
    "RefinePatches": "synthesis.refine_patches",
    "SourceMap": "sources",
    "Surface": "domain.surface",
    "fill": "synthesis.fill",
    "filled_maps": "output.filled",
    "from_array": "exemplar.exemplar",
    "fuse": "fusion.fuse",
    "gather_images": "output.gather",
    "join": "exemplar.join",
    "read_exemplar": "io.stack",
    "read_mesh": "io.mesh",
    "score": "metrics.score",
    "smoothest": "field.smooth",
    "synthesize": "synthesis.synthesize",
    "texel_for_repeats": "domain.surface",
    "through_arrows": "field.smooth",
    "write_images": "output.image",
}

__all__ = [
    "BoundarySampling",
    "Exemplar",
    "Grid",
    "LeastSquares",
    "Mesh",
    "Optimize",
    "PatchSampling",
    "Refine",
    "RefinePatches",
    "SourceMap",
    "Surface",
    "__version__",
    "fill",
    "filled_maps",
    "from_array",
    "fuse",
    "gather_images",
    "join",
    "read_exemplar",
    "read_mesh",
    "score",
    "smoothest",
    "synthesize",
    "texel_for_repeats",
    "through_arrows",
    "write_images",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'texloom' has no attribute {name!r}")
    return getattr(import_module(f"texloom.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
