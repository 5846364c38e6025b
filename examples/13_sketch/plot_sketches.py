"""Draw the cells, get the texture.

A drawing of arcs, and one of lines that cross; the texture meshes they become, laid out seamlessly and refined; the
textures, their cells filled from those of a sample of bricks, and one of pebbles, found on their own.

Wang et al. 2014, "Interactive texture design and synthesis from mesh sketches", figures 2 and 16.
"""

from examples.pictures import Picture, below, beside, inset, of_map, shown
from examples.sketches import arcs, drawn, stars
from texloom.demo import draw
from texloom.sketch.design import Design
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.sample import SketchSample

DESIGNS = ((arcs(), "bricks", 160, 1.0), (stars(), "pebbles", 230, 0.8))  # sketch, sample, its side, scale


def picture(detail: float = 1.0) -> Picture:
    """Sketches, meshes and textures from left to right; ``detail`` scales the textures' sides."""
    size, rows = round(224 * detail), []
    for sketch, name, side, scale in DESIGNS:
        sample = SketchSample.of([draw(name, size=side)])
        mesh = TextureMesh.of(sketch, (size, size), scale=scale)
        design = Design(sketch=sketch, sample=sample, mesh=mesh)
        texture = shown(design.sources, sample.exemplar, mesh.size)
        rows.append(beside(drawn(sketch), drawn(design.graph), inset(texture, of_map(sample.exemplar.lead), side=64)))
    return below(*rows)
