"""A heart of another kind.

Two samples, and a heart painted in the colours of their kinds: over the texture mesh it says which sample's cells go
where, so each cell is a pebble or a scale as a whole. Kinds can also be painted on the cells of one sample.

Wang et al. 2014, "Interactive texture design and synthesis from mesh sketches", figures 1 and 12.
"""

import numpy as np
from jaxtyping import Float32

from examples.pictures import Picture, below, beside, of_map, shown
from examples.sketches import honeycomb
from texloom.demo import draw
from texloom.sketch.design import Design
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.sample import SketchSample

SAMPLES = ("pebbles", "scales")


def heart(side: int, palette: Float32[np.ndarray, "kind 3"]) -> Float32[np.ndarray, "row column 3"]:
    """A heart of the second kind on the first."""
    y, x = np.meshgrid(*[np.linspace(-1.5, 1.5, side)] * 2, indexing="ij")
    return palette[((x**2 + y**2 - 1) ** 3 < -(x**2) * y**3 * 1.2).astype(int)]


def picture(detail: float = 1.0) -> Picture:
    """Samples, the pattern, the texture; ``detail`` scales the last."""
    side, drawn, sketch = round(360 * detail), [draw(name, size=176) for name in SAMPLES], honeycomb()
    sample = SketchSample.of(drawn)
    pattern = heart(side, sample.kinds.palette)
    mesh = TextureMesh.of(sketch, (side, side), scale=0.85)
    design = Design(sketch=sketch, sample=sample, mesh=mesh, pattern=pattern)
    samples = below(*(of_map(one.lead) for one in drawn))
    painted = (255 * pattern[::2, ::2]).astype(np.uint8)
    return beside(samples, painted, shown(design.sources, sample.exemplar, mesh.size))
