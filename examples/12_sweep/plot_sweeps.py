"""Grown texel by texel over points.

A stingray, an elephant and two linked rings, each along its smoothest field: blocks of the sample on the coarsest of
three levels of points, then swept on each level until neighbourhoods fit. The sample is inset.

After Turk 2001, "Texture Synthesis on Surfaces" (the talk's slides).
"""

from collections.abc import Callable

import texloom
from examples.meshes import elephant, linked, ray
from examples.pictures import Picture, beside, coat, inset, of_map
from texloom.demo import draw
from texloom.mesh.mesh import Mesh
from texloom.output.camera import Camera

COATS: tuple[tuple[Callable[[], Mesh], str, float, Camera], ...] = (
    (ray, "scales", 3.2, Camera(azimuth=30, elevation=38, margin=0.03)),
    (elephant, "pebbles", 2.4, Camera(azimuth=42, elevation=12, margin=0.03)),
    (linked, "weave", 2.4, Camera(azimuth=20, elevation=25, margin=0.03)),
)


def picture(detail: float = 1.0) -> Picture:
    """Three meshes in their coats; ``detail`` scales how many texels cover them."""
    pictures = []
    for make, name, repeats, view in COATS:
        mesh, sample = make(), draw(name, size=192)
        texel = texloom.texel_for_repeats(mesh, repeats * detail, sample.shape[1])
        surface = texloom.Surface.build(mesh, texloom.smoothest(mesh, 1), texel=texel)
        result = texloom.synthesize(sample, surface, texloom.Sweep(), seed=0)
        shown = coat(surface, result.sources, sample, [view], size=500, margin=10)
        pictures.append(inset(shown, of_map(sample.lead), side=80))
    return beside(*pictures, gap=0)
