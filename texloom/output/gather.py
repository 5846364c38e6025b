"""Values gathered through sources: the one way from a ``SourceMap`` to pictures, vertex colours and atlases."""

from typing import Any

import numpy as np
from jaxtyping import Float, Float32, Int

from texloom.arrays import fours, in_fours
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.kernels import gather as kernels
from texloom.kernels.launch import launch
from texloom.sources import SourceMap

_NONE = np.zeros((0, 1), np.float32)  # stands for turns or scales that are all 0 or all 1


def gather_sites(sources: SourceMap, map: Map) -> Float32[np.ndarray, "site channel"]:
    """What every site shows of one map: read at each source's position, blended by weight in linear light.

    A source at whole texels with weight 1 returns the stored value exactly. Between texels values are cubic, and
    sharp: half-way, waves of four texels keep 94 %, of which a bilinear read leaves 71 %. They pass the four texels
    around by no more than these differ, and 0 and 1 only where these do. Vectors of a normal map are turned into the
    site's frame by the source's ``turn`` and the blend is given back the mean length of the stored vectors.
    """
    image = _image(map)
    values = np.empty((sources.count, map.image.shape[2]), np.float32)
    paths = (np.ascontiguousarray(sources.position), np.ascontiguousarray(sources.weight))
    if _is_normal(map):
        arguments = [image, *paths, _optional(sources.turn)]
        launch(kernels.normals_at_sites, sources.count, inputs=arguments, outputs=[values])
    else:
        launch(kernels.values_at_sites, sources.count, inputs=[image, *paths], outputs=[values])
    return values


def gather_points(
    sources: SourceMap,
    map: Map,
    sites: Int[np.ndarray, "point 3"],
    *,
    barycentric: Float[np.ndarray, "point 3"],
    offsets: Float[np.ndarray, "point 3 2"],
    frame_turn: Float[np.ndarray, "point 3"] | None = None,
) -> Float32[np.ndarray, "point channel"]:
    """What points between sites show: every corner's sources evaluated at the point, values blended barycentrically.

    ``offsets`` are [row, column] texels from each corner's site to the point, in that site's own frame; so corners with
    different frames or sources agree wherever they show the same part of the exemplar. ``frame_turn`` (radians) is the
    angle of each corner's frame against the frame a normal map is wanted in, and only matters there.
    """
    image = _image(map)
    values = np.empty((len(sites), map.image.shape[2]), np.float32)
    paths = [np.ascontiguousarray(sources.position), np.ascontiguousarray(sources.weight)]
    points = [np.ascontiguousarray(sites, np.int32), _floats(barycentric), _floats(offsets)]
    arguments = [image, *paths, _optional(sources.turn), _optional(sources.scale), *points]
    if _is_normal(map):
        frame = _floats(np.zeros(sites.shape) if frame_turn is None else frame_turn)
        launch(kernels.normals_at_points, len(sites), inputs=[*arguments, frame], outputs=[values])
    else:
        launch(kernels.values_at_points, len(sites), inputs=arguments, outputs=[values])
    return values


def gather_images(sources: SourceMap, exemplar: Exemplar, *, rows: int, columns: int) -> dict[str, Map]:
    """Every map of the stack over a grid of sites in row order, stored as the exemplar's maps are."""
    if rows * columns != sources.count:
        raise ParameterError(
            f"{rows}×{columns} texels were asked of sources for {sources.count} sites: give their own size"
        )
    return {
        name: Map(gather_sites(sources, map).reshape(rows, columns, -1), map.kind, map.bits)
        for name, map in exemplar.maps.items()
    }


def identity_sources(rows: int, columns: int) -> SourceMap:
    """The sources of a copy: site (row, column) shows texel (row, column)."""
    position = (
        np.stack(np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"), axis=-1)
        .reshape(-1, 1, 2)
        .astype(np.float32)
    )
    return SourceMap(position, np.ones((rows * columns, 1), np.float32))


def _is_normal(map: Map) -> bool:
    return map.kind == "normal"


def _image(map: Map) -> Float32[np.ndarray, "row column group 4"]:
    """The map for the kernels."""
    image = map.image
    if _is_normal(map):
        if image.shape[2] != 3:
            raise ParameterError(
                f"a normal map has 3 channels, this one has {image.shape[2]}: give it as data, or fix the file"
            )
        image = np.concatenate([image, np.linalg.norm(2 * image - 1, axis=2, keepdims=True)], axis=2)
    return fours(in_fours(_floats(image)))


def _floats(values: Any) -> Float32[np.ndarray, "..."]:
    return np.ascontiguousarray(values, np.float32)


def _optional(values: Float32[np.ndarray, "site k"] | None) -> Float32[np.ndarray, "a b"]:
    """An array a kernel can take: empty for none."""
    return _NONE if values is None else _floats(values)
