"""Faces on the sample, blended over their edges, as the sites an atlas is laid and baked from."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, Int

from texloom.exemplar.exemplar import Map
from texloom.mesh.mesh import Mesh
from texloom.output.atlas import Atlas, bake_texels
from texloom.output.blending import Blend
from texloom.output.sites import SurfaceSites
from texloom.output.tangents import face_tangents
from texloom.sources import SourceMap


def face_sites(
    mesh: Mesh,
    coordinates: Float[np.ndarray, "face 3 2"],
    *,
    parent: Int[np.ndarray, "face"] | None = None,
    corners: Float[np.ndarray, "face 3 3"] | None = None,
) -> SurfaceSites:
    """Every corner of every face as a site of its own, with the face's flat frame: +column of the sample's.

    ``parent`` and ``corners`` lead from a mesh that was split to the user's (``texloom.mesh.refine``).
    """
    direction = face_tangents(mesh.vertices, mesh.faces, coordinates[..., ::-1])[0]
    return SurfaceSites(
        vertices=mesh.vertices[mesh.faces].reshape(-1, 3),
        faces=np.arange(mesh.faces.size).reshape(-1, 3),
        direction=np.repeat(direction, 3, axis=0),
        normal=np.repeat(mesh.face_normals, 3, axis=0),
        texel=1.0,  # of no account: texels have sources of their own
        parent=parent,
        corners=corners,
    )


def bake_blend(blend: Blend, atlas: Atlas, maps: Mapping[str, Map]) -> dict[str, Map]:
    """Every map on an atlas that was laid on ``face_sites``; normals are turned as the neighbours' maps are."""

    def sources(run: slice) -> SourceMap:
        return blend.sources(atlas.sites[run, 0] // 3, atlas.barycentric[run])

    return bake_texels(sources, atlas, maps)
