"""Fusion maps from the options of ``texloom fuse`` and ``texloom surface --fuse``: which sample each site shows."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float64, Int32

from texloom.cli.guides import on_mesh
from texloom.cli.options import MESH_SUFFIXES
from texloom.domain.surface import Surface
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.scale import dominant_scale
from texloom.fusion import labels as maps
from texloom.io.image import read_stored
from texloom.io.mesh import read_mesh
from texloom.io.vertex_colours import read_vertex_colours
from texloom.mesh.model import Model
from texloom.mesh.query import closest_points

DISCS, VERTEX = "discs", "vertex"
_ASTRAY = 0.02  # of the mesh's diagonal: a map farther off is of another mesh

Palette = Float64[np.ndarray, "sample 3"] | None


@dataclass(frozen=True, eq=False)
class FusionMap:
    """The sample each site asks for, and the colour in the map that stands for each sample (None: there is none)."""

    labels: Int32[np.ndarray, "site"]
    palette: Palette

    def told(self, samples: Sequence[Path], shown: Int32[np.ndarray, "site"]) -> list[Mapping[str, object]]:
        """Which colour became which sample, and the share of the sites that show it."""
        share = np.bincount(shown, minlength=len(samples)) / max(len(shown), 1)
        told: list[Mapping[str, object]] = []
        for number, path in enumerate(samples):
            colour = {} if self.palette is None else {"colour": _hex(self.palette[number])}
            told.append({"sample": path.name, **colour, "share": share[number]})
        return told


def parse_palette(text: str | None) -> Palette:
    """Colours by name or as #rrggbb, with commas between."""
    if text is None:
        return None
    from PIL import ImageColor

    try:
        return np.array([ImageColor.getrgb(word.strip())[:3] for word in text.split(",")]) / 255.0
    except ValueError as error:
        raise ParameterError(f"--palette {text}: {error}: give names or #rrggbb, as in red,blue,#00ff00") from None


def of_image(
    wish: str, size: tuple[int, int] | None, samples: Sequence[Exemplar], *, palette: Palette, strewn: bool, wrap: bool
) -> tuple[FusionMap, tuple[int, int]]:
    """The labels of a picture, and its rows and columns: those asked for, else the map's own.

    Raises: FileError, if the map cannot be read; ParameterError, if it does not fit the samples.
    """
    if strewn or wish == DISCS:
        return _strewn(wish, size, samples, wrap=wrap)
    found = maps.from_picture(_picture(Path(wish)), len(samples), palette)
    rows, columns = size or found.labels.shape
    return FusionMap(maps.resized(found.labels, rows, columns).ravel(), found.palette), (rows, columns)


def of_surface(wish: str, model: Model, surface: Surface, count: int, *, palette: Palette) -> FusionMap:
    """The labels of a surface's sites: from ``vertex`` colours, a mesh that has some, or a picture on the mesh's UVs.

    Raises: FileError, if the map cannot be read; ParameterError, if it does not fit the mesh or the samples.
    """
    face, weight = surface.refined.vertex_parent_face, surface.refined.vertex_barycentric
    if wish != VERTEX and Path(wish).suffix.lower() not in MESH_SUFFIXES:
        found = maps.from_picture(_picture(Path(wish)), count, palette)
        return FusionMap(_through_uv(found.labels, model, face, weight), found.palette)
    painted = model
    if wish != VERTEX:
        painted = read_mesh(wish)
        face, weight = _on_map(painted, surface.refined.mesh.vertices)
    colours = on_mesh(read_vertex_colours(painted), painted)
    found = maps.from_colours(colours, count, palette)
    corners = found.labels[painted.mesh.faces[face]]
    share = np.stack([np.where(corners == label, weight, 0.0).sum(1) for label in range(count)])
    return FusionMap(share.argmax(0).astype(np.int32), found.palette)


def _strewn(
    wish: str, size: tuple[int, int] | None, samples: Sequence[Exemplar], *, wrap: bool
) -> tuple[FusionMap, tuple[int, int]]:
    """Discs as large as the samples' dominant scales; the second's chance from the map's brightness or the height."""
    if len(samples) != 2:
        raise ParameterError(f"discs mix 2 samples, not {len(samples)}: give two, or a map with colours")
    if wish == DISCS:
        chance = maps.fading(*(size or (512, 512)))
    else:
        chance = _picture(Path(wish)).mean(2)
        if size is not None:
            row, column = (np.arange(new) * old // new for new, old in zip(size, chance.shape, strict=True))
            chance = chance[np.ix_(row, column)]
    one, two = (dominant_scale(sample).scale for sample in samples)
    rows, columns = chance.shape
    return FusionMap(maps.discs(chance, (one, two), wrap=wrap).ravel(), None), (rows, columns)


def _picture(path: Path) -> Float64[np.ndarray, "row column 3"]:
    """A picture as seen, grey as three equal channels, its opacity left out."""
    stored = read_stored(path)
    values = stored / np.iinfo(stored.dtype).max if stored.dtype.kind == "u" else np.clip(stored, 0, 1)
    colour = values[..., :3] if values.shape[2] >= 3 else np.repeat(values[..., :1], 3, 2)
    return np.ascontiguousarray(colour, np.float64)


def _through_uv(
    labels: Int32[np.ndarray, "row column"], model: Model, face: np.ndarray, weight: np.ndarray
) -> Int32[np.ndarray, "site"]:
    """The label of the texel that each site lies in."""
    if model.uv is None:
        raise ParameterError(f"{model.path.name} has no UVs to read a painted map by: give a mesh with vertex colours")
    u, v = np.einsum("sc,scd->ds", weight, model.uv[face])
    rows, columns = labels.shape
    row = np.floor((1 - v) * rows).astype(np.int64)
    column = np.floor(u * columns).astype(np.int64)
    inside = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)  # at 1 the last texel, beyond the picture repeats
    row = np.where(inside, np.clip(row, 0, rows - 1), row % rows)
    column = np.where(inside, np.clip(column, 0, columns - 1), column % columns)
    return labels[row, column]


def _on_map(painted: Model, sites: Float64[np.ndarray, "site 3"]) -> tuple[np.ndarray, np.ndarray]:
    """The face of the map's mesh nearest to each site, and where in it.

    Raises: ParameterError, if it is another surface.
    """
    mesh = painted.mesh
    face, weight = closest_points(mesh, sites)
    away = np.linalg.norm(np.einsum("sc,scd->sd", weight, mesh.vertices[mesh.faces[face]]) - sites, axis=1)
    if float(np.median(away)) > _ASTRAY * mesh.diagonal:
        share = 100 * float(np.median(away)) / mesh.diagonal
        raise ParameterError(
            f"--fuse {painted.path.name} lies {share:.0f} % of its size away from the mesh: give a map of the same mesh"
        )
    return face, weight


def _hex(colour: Float64[np.ndarray, "3"]) -> str:
    return "#" + "".join(f"{round(255 * float(part)):02x}" for part in np.clip(colour, 0, 1))
