"""What the examples share: pictures of grids, of maps and of coated meshes, laid side by side."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, UInt8

from texloom.domain.surface import Surface
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.output.atlas import bake, lay_atlas
from texloom.output.camera import Camera
from texloom.output.gather import gather_sites
from texloom.output.image import encoded_picture
from texloom.output.preview import Skin, preview
from texloom.output.sites import SurfaceSites
from texloom.output.tangents import corner_tangents
from texloom.output.unwrap import unwrap
from texloom.sources import SourceMap

Picture = UInt8[np.ndarray, "row column 3"]

FRONT, BACK = Camera(azimuth=28, elevation=12, margin=0.03), Camera(azimuth=205, elevation=16, margin=0.03)
_SIDE = 600  # pixels of a view; the rabbit fills its height
_MARGIN = 105  # columns cut off at the left and right of a view, where no rabbit is
_ATLAS = 2048  # texels a side
_GAP = 8  # pixels between pictures


def shown(sources: SourceMap, exemplar: Exemplar, shape: tuple[int, int]) -> Picture:
    """The leading map on a grid of ``shape`` (rows, columns)."""
    return encoded_picture(gather_sites(sources, exemplar.lead).reshape(*shape, -1))


def of_map(map: Map) -> Picture:
    """A map as it is usually shown: colours as sRGB, data as stored, one channel as grey."""
    picture = encoded_picture(map.image) if map.kind == "colour" else np.rint(np.clip(map.image, 0, 1) * 255)
    return np.broadcast_to(picture, (*picture.shape[:2], 3)).astype(np.uint8)


def coat(
    surface: Surface,
    sources: SourceMap,
    exemplar: Exemplar,
    views: Sequence[Camera] = (FRONT,),
    *,
    size: int = _SIDE,
    margin: int = _MARGIN,
) -> Picture:
    """A mesh in its texture, colours and normals baked on an atlas; ``margin`` columns are cut off at both sides."""
    mesh = surface.mesh
    uv = unwrap(mesh, size=_ATLAS)
    tangents = corner_tangents(mesh.vertices, mesh.faces, uv, normals=mesh.vertex_normals[mesh.faces])
    atlas = lay_atlas(SurfaceSites.of(surface), uv, size=_ATLAS, tangents=tangents)
    maps = bake(sources, atlas, {name: exemplar.maps[name] for name in ("basecolor", "normal")})
    skin = Skin(texture=maps["basecolor"].image, uv=uv, bumps=maps["normal"].image, tangents=tangents)
    pictures = [
        preview(mesh.vertices, mesh.faces, skin, normals=mesh.vertex_normals, size=size, views=[v]) for v in views
    ]
    return beside(*(picture[:, margin : size - margin] for picture in pictures), gap=0)


def coloured(surface: Surface, colours: Float[np.ndarray, "site 3"], view: Camera = FRONT) -> Picture:
    """A mesh with a colour (linear light) at every site."""
    mesh = surface.refined.mesh
    skin = Skin(colours=colours)
    picture = preview(mesh.vertices, mesh.faces, skin, normals=mesh.vertex_normals, size=_SIDE, views=[view])
    return picture[:, _MARGIN:-_MARGIN]


def beside(*pictures: Picture, gap: int = _GAP) -> Picture:
    """Pictures in a row, smaller ones half-way up, on white."""
    return _joined(pictures, gap, axis=1)


def below(*pictures: Picture, gap: int = _GAP) -> Picture:
    """Pictures in a column, smaller ones half-way across, on white."""
    return _joined(pictures, gap, axis=0)


def inset(picture: Picture, sample: Picture, side: int = 132) -> Picture:
    """A picture with the sample it was grown from, reduced, in its lower right corner."""
    step = -(-sample.shape[0] // side)
    rows, columns = (size // step for size in sample.shape[:2])
    small = sample[: rows * step, : columns * step].reshape(rows, step, columns, step, 3).mean(axis=(1, 3))
    framed = np.pad(small.astype(np.uint8), ((3, 3), (3, 3), (0, 0)), constant_values=255)
    picture = picture.copy()
    picture[-framed.shape[0] - 8 : -8, -framed.shape[1] - 8 : -8] = framed
    return picture


def _joined(pictures: Sequence[Picture], gap: int, *, axis: int) -> Picture:
    """Along an axis with gaps, centred across it."""
    across = 1 - axis
    largest = max(picture.shape[across] for picture in pictures)
    parts = []
    for number, picture in enumerate(pictures):
        missing = largest - picture.shape[across]
        pad = [(0, 0), (0, 0), (0, 0)]
        pad[across] = (missing // 2, missing - missing // 2)
        pad[axis] = (gap if number else 0, 0)
        parts.append(np.pad(picture, pad, constant_values=255))
    return np.concatenate(parts, axis=axis)
