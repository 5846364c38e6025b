"""A field through a few arrows.

Arrows at points of the surface turn the texture; the field between them is as smooth as can be, or, as in the paper,
interpolated by radial basis functions over geodesic distance. Left no arrows, middle the smoothest field through
four of them that wind around the body, right the radial basis functions through the same four.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", section 3.1.
"""

import texloom
from examples.pictures import Picture, beside, coat
from texloom.demo import draw, rabbit
from texloom.field import rbf
from texloom.field.arrows import Arrow, place

ARROWS = [
    Arrow(point=(0.0, 0.6, 0.5), direction=(1.0, 0.8, 0.0)),
    Arrow(point=(0.6, 0.6, -0.1), direction=(0.0, 0.8, -1.0)),
    Arrow(point=(0.0, 0.7, -0.7), direction=(-1.0, 0.8, 0.0)),
    Arrow(point=(-0.6, 0.6, -0.1), direction=(0.0, 0.8, 1.0)),
]


def picture(detail: float = 1.0) -> Picture:
    """Bricks along three fields; ``detail`` scales how many texels cover the mesh."""
    mesh, sample = rabbit(), draw("bricks", size=160)
    texel = texloom.texel_for_repeats(mesh, 2.2 * detail, sample.shape[1])
    placed = place(mesh, ARROWS)
    through = {"vertices": placed.direction_vertex, "directions": placed.direction}
    fields = (
        texloom.smoothest(mesh, 1),
        texloom.through_arrows(mesh, 1, **through),
        rbf.directions(mesh, 1, **through),
    )
    surfaces = [texloom.Surface.build(mesh, field, texel=texel) for field in fields]
    results = [texloom.synthesize(sample, surface, seed=0) for surface in surfaces]
    coats = [coat(surface, result.sources, sample) for surface, result in zip(surfaces, results, strict=True)]
    return beside(*coats, gap=0)
