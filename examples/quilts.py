"""What the examples of triangle quilting share: quilted meshes, and pictures of them on their sample."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

import texloom
from examples.pictures import FRONT, Picture, beside
from texloom.domain.faces import Faces
from texloom.exemplar.exemplar import Exemplar
from texloom.mesh.mesh import Mesh
from texloom.output.atlas import lay_atlas
from texloom.output.blended_atlas import bake_blend, face_sites
from texloom.output.blending import blend, edge_errors
from texloom.output.camera import Camera
from texloom.output.preview import Skin, preview
from texloom.output.sample_uv import on_sample
from texloom.output.tangents import corner_tangents
from texloom.output.unwrap import unwrap
from texloom.search.textons import Textons
from texloom.synthesis.quilting import Quilted, Quilting

_SIDE = 600  # pixels of a view
_ATLAS = 2048  # texels a side


def quilt(
    mesh: Mesh,
    textons: Textons,
    method: Quilting | None = None,
    *,
    repeats: float = 3.0,
    order: int = 1,
    width: float | None = 48.0,
) -> Quilted:
    """Quilt a mesh along the smoothest field; ``width`` texels across a patch of faces, None for faces alone."""
    texel = texloom.texel_for_repeats(mesh, repeats, textons.exemplar.shape[1])
    faces = Faces.build(mesh, texloom.smoothest(mesh, order), texel=texel, width=width)
    return (method or Quilting()).run(textons, faces)


def skin_of(mesh: Mesh, coordinates: Float[np.ndarray, "face 3 2"], sample: Exemplar) -> Skin:
    """The sample itself at these places: nothing is blended, no texture is made."""
    shown = on_sample(mesh, coordinates, sample.shape)
    maps, tangents = sample.maps, shown.tangents
    return Skin(texture=maps["basecolor"].image, uv=shown.uv, bumps=maps["normal"].image, tangents=tangents)


def worn(quilted: Quilted, sample: Exemplar, views: Sequence[Camera] = (FRONT,), side: int = _SIDE) -> Picture:
    """The mesh on the sample itself, as any viewer shows it."""
    mesh = quilted.faces.mesh
    return _views(mesh, skin_of(mesh, quilted.coordinates, sample), views, side)


def blended(quilted: Quilted, textons: Textons, views: Sequence[Camera] = (FRONT,), side: int = _SIDE) -> Picture:
    """The mesh with every edge blended that shows, baked on an atlas."""
    mesh, sample = quilted.faces.mesh, textons.exemplar
    errors = edge_errors(mesh, quilted.coordinates, textons.image)
    whole = blend(mesh, quilted.coordinates, errors.at_faces(errors.blended()))
    uv = unwrap(mesh, size=_ATLAS)
    tangents = corner_tangents(mesh.vertices, mesh.faces, uv, normals=mesh.vertex_normals[mesh.faces])
    atlas = lay_atlas(face_sites(mesh, quilted.coordinates), uv, size=_ATLAS, tangents=tangents)
    maps = bake_blend(whole, atlas, {name: sample.maps[name] for name in ("basecolor", "normal")})
    skin = Skin(texture=maps["basecolor"].image, uv=uv, bumps=maps["normal"].image, tangents=tangents)
    return _views(mesh, skin, views, side)


def _views(mesh: Mesh, skin: Skin, views: Sequence[Camera], side: int) -> Picture:
    return beside(
        *(preview(mesh.vertices, mesh.faces, skin, normals=mesh.vertex_normals, size=side, views=[v]) for v in views),
        gap=0,
    )
