"""An atlas: which place on the surface every texel shows, and maps baked through it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Float32, Float64, Int32

from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Map
from texloom.kernels import raster as kernels
from texloom.kernels.launch import launch
from texloom.output.gather import gather_points, gather_sites
from texloom.output.gutter import fill, nearest_texels
from texloom.output.rows import face_rows, texel_corners
from texloom.output.sites import SurfaceSites
from texloom.output.uv import wrapped
from texloom.sources import SourceMap

_TOUCH = 0.7072  # texels from a centre to a corner: a face that touches a texel owns it if no other covers its centre
_LARGEST = 16384  # texels a side
_BLOCK = 1 << 20  # texels whose sources are held at once
_NO_TANGENTS = np.zeros((1, 3, 4), np.float32)


@dataclass(frozen=True, eq=False)
class Atlas:
    """The covered texels, in row order, as points between three sites; and where the others take their values from."""

    sites: Int32[np.ndarray, "texel 3"]
    barycentric: Float32[np.ndarray, "texel 3"]
    offsets: Float32[np.ndarray, "texel 3 2"]  # [row, column] exemplar texels, in each site's frame
    nearest: Int32[np.ndarray, "row column"]  # flat index of the texel to show; -1: none
    frame_turn: Float32[np.ndarray, "texel 3"] | None = None  # radians, each site's frame against the texel's tangent
    handed: Float32[np.ndarray, "texel"] | None = None  # handedness of the tangent frame, 1 or -1

    @property
    def covered(self) -> float:
        """Share of the texels that show the surface itself."""
        return len(self.sites) / self.nearest.size


def lay_atlas(
    surface: SurfaceSites,
    uv: Float[np.ndarray, "user_face 3 2"],
    *,
    size: int,
    gutter: int = 8,
    tangents: Float[np.ndarray, "user_face 3 4"] | None = None,
) -> Atlas:
    """Rasterise the UVs (v up) of the user's faces and find the place on the surface behind every texel.

    A texel belongs to the lowest face that covers its centre; texels that are only touched belong to the nearest face,
    so slivers are not lost. UVs outside the unit square wrap. ``gutter`` is in texels. ``tangents`` (glTF, at the
    corners of the user's faces) are needed to bake normal maps.
    """
    if not 1 <= size <= _LARGEST:
        raise ParameterError(f"an atlas of {size} texels a side: choose 1 to {_LARGEST}")
    copies, face = wrapped(surface.at_corners(np.asarray(uv, np.float32)))
    corners = texel_corners(copies, size, size)
    copy = _owners(corners, size).reshape(-1)
    texel = np.flatnonzero(copy >= 0).astype(np.int32)
    count = len(texel)
    sites, barycentric = np.empty((count, 3), np.int32), np.empty((count, 3), np.float32)
    offsets, turn = np.empty((count, 3, 2), np.float32), np.empty((count, 3), np.float32)
    handed = np.empty(count, np.float32)
    frames = _NO_TANGENTS if tangents is None else surface.at_corners(tangents)
    where = [copy[texel], texel, size, corners, face, np.ascontiguousarray(surface.faces, np.int32)]
    site = [np.ascontiguousarray(surface.vertices, np.float64), np.ascontiguousarray(surface.direction, np.float32)]
    inputs = [*where, *site, surface.upward, surface.texel_length, frames, int(tangents is not None)]
    launch(kernels.place_texels, count, inputs=inputs, outputs=[sites, barycentric, offsets, turn, handed])
    nearest = nearest_texels((copy >= 0).reshape(size, size), gutter)
    return Atlas(sites, barycentric, offsets, nearest, *((None, None) if tangents is None else (turn, handed)))


def bake(sources: SourceMap, atlas: Atlas, maps: Mapping[str, Map]) -> dict[str, Map]:
    """Every map of a stack on the atlas, stored as the exemplar's maps are; row 0 is the top (v = 1).

    Vectors of normal maps are turned from the sites' frames into the tangent frame of the atlas.
    """
    points = {"barycentric": atlas.barycentric, "offsets": atlas.offsets, "frame_turn": atlas.frame_turn}
    return _baked(atlas, maps, lambda map: gather_points(sources, map, atlas.sites, **points))


def bake_texels(sources_of: Callable[[slice], SourceMap], atlas: Atlas, maps: Mapping[str, Map]) -> dict[str, Map]:
    """Like ``bake``, with sources for the covered texels themselves, each in the frame of its first corner's site.

    ``sources_of`` is asked for a run of texels at a time.
    """

    def values(map: Map) -> Float32[np.ndarray, "texel channel"]:
        found = np.empty((len(atlas.sites), map.image.shape[2]), np.float32)
        for first in range(0, len(found), _BLOCK):
            run = slice(first, first + _BLOCK)
            found[run] = gather_sites(_into_tangents(sources_of(run), atlas, run), map)
        return found

    return _baked(atlas, maps, values)


def _into_tangents(sources: SourceMap, atlas: Atlas, run: slice) -> SourceMap:
    """The sources turned further, from the sites' frames into the atlas's."""
    if atlas.frame_turn is None:
        return sources
    frame = atlas.frame_turn[run, :1]
    turn = np.broadcast_to(frame, sources.weight.shape) if sources.turn is None else sources.turn + frame
    return replace(sources, turn=turn)


def _baked(
    atlas: Atlas, maps: Mapping[str, Map], values_of: Callable[[Map], Float32[np.ndarray, "texel channel"]]
) -> dict[str, Map]:
    """Values of the covered texels as images, vectors of mirrored charts mirrored, gutters filled."""
    baked = {}
    for name, map in maps.items():
        if map.kind == "normal" and atlas.frame_turn is None:
            raise ParameterError("normal maps need the atlas's tangents: lay the atlas with tangents=")
        values = values_of(map)
        if map.kind == "normal" and atlas.handed is not None:
            values[:, 1] = 0.5 + (values[:, 1] - 0.5) * atlas.handed
        baked[name] = Map(fill(values, atlas.nearest), map.kind, map.bits)
    return baked


def _owners(corners: Float64[np.ndarray, "face 3 2"], size: int) -> Int32[np.ndarray, "row column"]:
    """The face that owns each texel, -1 where none does."""
    rows = face_rows(corners, size, reach=_TOUCH)
    owner, gap = np.empty((size, size), np.int32), np.empty((size, size), np.float32)
    launch(kernels.own_texels, size, inputs=[*rows.arrays, _TOUCH], outputs=[owner, gap])
    return owner
