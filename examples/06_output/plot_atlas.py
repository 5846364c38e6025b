"""Back home: an atlas on the mesh's own faces.

The texture is grown on an internal refinement; what comes back is the user's own mesh with every map of the stack baked
on its UVs, or on a fresh atlas where it has none. Normals are turned into the tangent frame of the UVs, and gutters
are filled. Left base colour and normals on the atlas, right the mesh that shows them.
"""

import numpy as np

import texloom
from examples.pictures import Picture, beside, coat, of_map
from texloom.demo import draw, rabbit
from texloom.output.atlas import bake, lay_atlas
from texloom.output.sites import SurfaceSites
from texloom.output.tangents import corner_tangents
from texloom.output.unwrap import unwrap

SIZE = 1024  # texels a side


def picture(detail: float = 1.0) -> Picture:
    """Two maps of an atlas and its mesh; ``detail`` scales how many texels cover the mesh."""
    mesh, sample = rabbit(), draw("knit", size=160)
    texel = texloom.texel_for_repeats(mesh, 2.2 * detail, sample.shape[1])
    surface = texloom.Surface.build(mesh, texloom.smoothest(mesh, 1), texel=texel)
    sources = texloom.synthesize(sample, surface, seed=0).sources

    uv = unwrap(mesh, size=SIZE)
    tangents = corner_tangents(mesh.vertices, mesh.faces, uv, normals=mesh.vertex_normals[mesh.faces])
    atlas = lay_atlas(SurfaceSites.of(surface), uv, size=SIZE, tangents=tangents)
    maps = bake(sources, atlas, sample.maps)
    halves = [np.ascontiguousarray(of_map(maps[name])[::2, ::2]) for name in ("basecolor", "normal")]
    return beside(*halves, coat(surface, sources, sample))
