"""Meshes dressed in their sample.

Every face is given a place in the small square beside the mesh; that picture is all the texture there is. Meshes of
genus 0, 1 and 3, and one with boundaries, along the smoothest field, edges not blended.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", figure 8.
"""

from collections.abc import Callable

from examples.meshes import bowl, duck, knot, rings
from examples.pictures import Picture, below, beside, inset, of_map
from examples.quilts import quilt, worn
from texloom.demo import draw, rabbit
from texloom.mesh.mesh import Mesh
from texloom.output.camera import Camera
from texloom.search.textons import learn_textons

ROWS = (
    ((knot, "scales"), (bowl, "bricks"), (duck, "weave"), (rings, "pebbles")),
    ((rabbit, "bricks"), (knot, "knit"), (bowl, "wood"), (duck, "scales")),
)
VIEWS = {
    knot: Camera(azimuth=10, elevation=10),
    bowl: Camera(azimuth=28, elevation=30),
    duck: Camera(azimuth=50, elevation=12),
    rings: Camera(azimuth=20, elevation=15, margin=0.12),
    rabbit: Camera(azimuth=28, elevation=12),
}


def picture(detail: float = 1.0) -> Picture:
    """Two rows of meshes; ``detail`` scales the pictures' sides."""
    names = {name for row in ROWS for _, name in row}
    textons = {name: learn_textons(draw(name, size=192)) for name in sorted(names)}

    def coat(mesh: Callable[[], Mesh], name: str) -> Picture:
        sample = textons[name].exemplar
        shown = worn(quilt(mesh(), textons[name]), sample, [VIEWS[mesh]], side=round(400 * detail))
        return inset(shown, of_map(sample.lead), side=64)

    return below(*(beside(*(coat(*what) for what in row), gap=0) for row in ROWS), gap=0)
