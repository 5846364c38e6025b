"""From regular to natural.

A honeycomb, and the texture meshes it becomes when vertices are drawn to those of the sketch within 5, 15 and 25
texels; below, pebbles in their cells. Nothing crosses, whatever the radius.

Wang et al. 2014, "Interactive texture design and synthesis from mesh sketches", figure 15.
"""

from dataclasses import replace

from examples.pictures import Picture, below, beside, of_map, shown
from examples.sketches import drawn, honeycomb
from texloom.demo import draw
from texloom.sketch.design import Design
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.sample import SketchSample

RADII = (5, 15, 25)  # texels


def picture(detail: float = 1.0) -> Picture:
    """Sketch and sample, then each mesh above its texture; ``detail`` scales their sides."""
    side, sketch = round(184 * detail), honeycomb(side=20)
    sample = SketchSample.of([draw("pebbles", size=184)])
    design = Design(sketch=sketch, sample=sample, mesh=TextureMesh(size=(side, side)))
    columns = [below(drawn(sketch), of_map(sample.exemplar.lead))]
    for radius in RADII:
        design = design.changed(mesh=replace(design.mesh, radius=radius))
        columns.append(below(drawn(design.graph), shown(design.sources, sample.exemplar, design.mesh.size)))
    return beside(*columns)
