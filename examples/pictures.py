"""What the examples share: pictures of grids and of coated meshes, laid side by side."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, UInt8

import texloom
from texloom.exemplar.exemplar import Map
from texloom.mesh.mesh import Mesh
from texloom.output.atlas import bake, lay_atlas
from texloom.output.camera import Camera
from texloom.output.gather import gather_sites
from texloom.output.image import encoded_picture
from texloom.output.preview import Skin, preview
from texloom.output.sites import SurfaceSites
from texloom.output.tangents import corner_tangents
from texloom.output.unwrap import unwrap

Picture = UInt8[np.ndarray, "row column 3"]

FRONT = Camera(azimuth=28, elevation=12, margin=0.03)
BACK = Camera(azimuth=205, elevation=16, margin=0.03)
_WHITE = 255


def map_picture(map: Map) -> Picture:
    """One map as it is usually shown: colours as sRGB, data as stored, one channel as grey."""
    shown = encoded_picture(map.image) if map.kind == "colour" else np.rint(np.clip(map.image, 0, 1) * 255)
    return np.ascontiguousarray(np.broadcast_to(shown[..., :3], (*shown.shape[:2], 3)), np.uint8)


def grid_picture(result: texloom.Result, exemplar: texloom.Exemplar, grid: texloom.Grid) -> Picture:
    """The leading map of a result on a grid."""
    return encoded_picture(gather_sites(result.sources, exemplar.lead).reshape(*grid.shape, -1))


def coat_picture(
    surface: texloom.Surface,
    colours: Float[np.ndarray, "site 3"],
    *,
    size: int = 560,
    views: Sequence[Camera] = (FRONT,),
) -> Picture:
    """A mesh with a linear colour at every site, seen from some sides."""
    mesh = surface.refined.mesh
    return preview(mesh.vertices, mesh.faces, Skin(colours=colours), normals=mesh.vertex_normals, size=size, views=views)
