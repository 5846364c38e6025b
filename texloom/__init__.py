"""Texture grown from a sample, on anything.

exemplar = texloom.read_exemplar("bricks.png")
domain = texloom.Grid(1024, 1024, wrap=True)
result = texloom.synthesize(exemplar, domain, texloom.Optimize(), seed=7)
texloom.write_images("wall", texloom.gather_images(result.sources, exemplar, rows=1024, columns=1024))
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from texloom.domain.faces import Faces as Faces
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
    from texloom.output.sample_uv import on_sample as on_sample
    from texloom.output.sample_uv import write_sample_uv as write_sample_uv
    from texloom.output.textons_file import load_textons as load_textons
    from texloom.output.textons_file import save_textons as save_textons
    from texloom.search.textons import Textons as Textons
    from texloom.search.textons import learn_textons as learn_textons
    from texloom.sketch.design import Design as Design
    from texloom.sketch.mesh.texture_mesh import TextureMesh as TextureMesh
    from texloom.sketch.reading.read import read_sketch as read_sketch
    from texloom.sketch.sample import SketchSample as SketchSample
    from texloom.sources import SourceMap as SourceMap
    from texloom.synthesis.boundary import BoundarySampling as BoundarySampling
    from texloom.synthesis.fill import fill as fill
    from texloom.synthesis.least_squares import LeastSquares as LeastSquares
    from texloom.synthesis.optimize import Optimize as Optimize
    from texloom.synthesis.patches import PatchSampling as PatchSampling
    from texloom.synthesis.quilting import Quilting as Quilting
    from texloom.synthesis.refine import Refine as Refine
    from texloom.synthesis.refine_patches import RefinePatches as RefinePatches
    from texloom.synthesis.sweep import Sweep as Sweep
    from texloom.synthesis.synthesize import synthesize as synthesize

__version__ = "0.1.0"

# Imported when first asked for: a command that needs one of them does not wait for the rest.
_HOMES = {
    "BoundarySampling": "synthesis.boundary",
    "Design": "sketch.design",
    "Exemplar": "exemplar.exemplar",
    "Faces": "domain.faces",
    "Grid": "domain.grid",
    "LeastSquares": "synthesis.least_squares",
    "Mesh": "mesh.mesh",
    "Optimize": "synthesis.optimize",
    "PatchSampling": "synthesis.patches",
    "Quilting": "synthesis.quilting",
    "Refine": "synthesis.refine",
    "RefinePatches": "synthesis.refine_patches",
    "SketchSample": "sketch.sample",
    "SourceMap": "sources",
    "Surface": "domain.surface",
    "Sweep": "synthesis.sweep",
    "Textons": "search.textons",
    "TextureMesh": "sketch.mesh.texture_mesh",
    "fill": "synthesis.fill",
    "filled_maps": "output.filled",
    "from_array": "exemplar.exemplar",
    "fuse": "fusion.fuse",
    "gather_images": "output.gather",
    "join": "exemplar.join",
    "learn_textons": "search.textons",
    "load_textons": "output.textons_file",
    "on_sample": "output.sample_uv",
    "read_exemplar": "io.stack",
    "read_mesh": "io.mesh",
    "read_sketch": "sketch.reading.read",
    "save_textons": "output.textons_file",
    "score": "metrics.score",
    "smoothest": "field.smooth",
    "synthesize": "synthesis.synthesize",
    "texel_for_repeats": "domain.surface",
    "through_arrows": "field.smooth",
    "write_images": "output.image",
    "write_sample_uv": "output.sample_uv",
}

__all__ = [
    "BoundarySampling",
    "Design",
    "Exemplar",
    "Faces",
    "Grid",
    "LeastSquares",
    "Mesh",
    "Optimize",
    "PatchSampling",
    "Quilting",
    "Refine",
    "RefinePatches",
    "SketchSample",
    "SourceMap",
    "Surface",
    "Sweep",
    "Textons",
    "TextureMesh",
    "__version__",
    "fill",
    "filled_maps",
    "from_array",
    "fuse",
    "gather_images",
    "join",
    "learn_textons",
    "load_textons",
    "on_sample",
    "read_exemplar",
    "read_mesh",
    "read_sketch",
    "save_textons",
    "score",
    "smoothest",
    "synthesize",
    "texel_for_repeats",
    "through_arrows",
    "write_images",
    "write_sample_uv",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'texloom' has no attribute {name!r}")
    return getattr(import_module(f"texloom.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
