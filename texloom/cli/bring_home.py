"""Sources on a surface back on the user's mesh: vertex colours or a baked atlas, and a preview."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, log2, sqrt
from pathlib import Path

import numpy as np
from jaxtyping import Float, UInt8

from texloom.domain.surface import Surface
from texloom.exemplar.exemplar import Exemplar, Map, to_map
from texloom.mesh.model import Model
from texloom.output.atlas import Atlas, bake, lay_atlas
from texloom.output.atomic import atomic
from texloom.output.gather import gather_sites
from texloom.output.image import write_image
from texloom.output.material import base_colour
from texloom.output.preview import Skin, preview
from texloom.output.retexture import retextured_glb
from texloom.output.sites import SurfaceSites
from texloom.output.tangents import corner_tangents
from texloom.output.textured import TexturedMesh, write_textured
from texloom.output.unwrap import unwrap
from texloom.output.uv import diagnose_uv
from texloom.output.vertex_colours import linear_rgba, write_vertex_colours
from texloom.sources import SourceMap

_FILLED = 0.6  # share of an atlas that charts usually cover
_SMALLEST, _LARGEST = 256, 8192  # texels a side, where the user leaves the size open


@dataclass(frozen=True, eq=False)
class Grown:
    """A mesh with texture grown over it."""

    model: Model
    surface: Surface
    sources: SourceMap
    exemplar: Exemplar

    @property
    def sites(self) -> SurfaceSites:
        """The surface as outputs need it."""
        return SurfaceSites.of(self.surface)


@dataclass(frozen=True)
class AtlasWish:
    """Texels a side (None: as many as the texture has), texels around charts, and whether to make new UVs anyway."""

    size: int | None = None
    gutter: int = 8
    fresh: bool = False


@dataclass(frozen=True, eq=False)
class Homecoming:
    """Files written, what the mesh now shows, whose UVs it took and the atlas on them ("", None: vertex colours)."""

    files: list[Path]
    skin: Skin
    uv: str = ""
    atlas: Atlas | None = None


def bring_home(grown: Grown, output: Path, *, home: str, atlas: AtlasWish, settings: Mapping[str, str]) -> Homecoming:
    """Write the textured mesh."""
    if home == "vertex":
        written = write_vertex_colours(output, grown.sites, grown.sources, grown.exemplar, settings=settings)
        return Homecoming([written], coloured_skin(grown.sources, grown.exemplar))
    mesh = grown.model.mesh
    size = atlas.size or fitting_size(float(grown.surface.area.sum(dtype=np.float64)))
    uv, whose = choose_uv(grown.model, atlas, size)
    tangents = corner_tangents(mesh.vertices, mesh.faces, uv, normals=mesh.vertex_normals[mesh.faces])
    laid = lay_atlas(grown.sites, uv, size=size, gutter=atlas.gutter, tangents=tangents)
    maps = bake(grown.sources, laid, grown.exemplar.maps)
    files = write_mesh(output, grown.model, maps, uv, tangents, fresh=whose != "own", settings=settings)
    return Homecoming(files, baked_skin(maps, uv, tangents), f"{whose}, {size}×{size}", laid)


def picture(grown: Grown, skin: Skin) -> UInt8[np.ndarray, "row column 3"]:
    """The mesh from four sides, as it is stored; skins of vertex colours are for the sites."""
    if skin.uv is not None:
        mesh = grown.model.mesh
        return preview(mesh.vertices, mesh.faces, skin, normals=mesh.vertex_normals)
    sites = grown.sites
    return preview(sites.vertices, sites.faces, skin, normals=sites.shown_normal)


def write_preview(path: Path, grown: Grown, skin: Skin) -> Path:
    """A picture from four sides."""
    return write_image(path, to_map(picture(grown, skin), "colour"))


def choose_uv(model: Model, wish: AtlasWish, size: int) -> tuple[Float[np.ndarray, "face 3 2"], str]:
    """The mesh's own UVs where they can take a texture, else new ones for ``size`` texels a side; and which."""
    own = model.uv
    if own is not None and not wish.fresh:
        diagnosis = diagnose_uv(own)
        if diagnosis.usable:
            return own, "own"
        reason = f"fresh atlas because {'; '.join(diagnosis.problems)}"
    else:
        reason = "fresh atlas"
    return unwrap(model.mesh, size=size, gutter=wish.gutter), reason


def fitting_size(area: float) -> int:
    """The power of two at which an atlas texel is about a texel of the sample; ``area`` of the surface, in those."""
    side = sqrt(area / _FILLED)
    return min(max(2 ** ceil(log2(max(side, 1.0))), _SMALLEST), _LARGEST)


def write_mesh(
    output: Path,
    model: Model,
    maps: Mapping[str, Map],
    uv: Float[np.ndarray, "face 3 2"],
    tangents: Float[np.ndarray, "face 3 4"],
    *,
    fresh: bool,
    settings: Mapping[str, str],
) -> list[Path]:
    """A GLB that came in goes back whole; any other mesh is written anew."""
    if model.document is not None and output.suffix.lower() == ".glb":
        content = retextured_glb(model, maps, uv=uv if fresh else None, tangents=tangents, settings=settings)
        with atomic(output) as beside:
            beside.write_bytes(content)
        return [output]
    mesh = model.mesh
    textured = TexturedMesh(
        vertices=mesh.vertices, faces=mesh.faces, normals=mesh.vertex_normals, uv=uv, tangents=tangents
    )
    return write_textured(output, textured, maps, settings=settings)


def coloured_skin(sources: SourceMap, exemplar: Exemplar) -> Skin:
    """What vertex colours look like."""
    base = base_colour(exemplar.maps) or next(iter(exemplar.maps))
    return Skin(colours=linear_rgba(gather_sites(sources, exemplar.maps[base]))[:, :3])


def baked_skin(
    maps: Mapping[str, Map], uv: Float[np.ndarray, "face 3 2"], tangents: Float[np.ndarray, "face 3 4"]
) -> Skin:
    """What the atlas looks like."""
    image = maps[base_colour(maps) or next(iter(maps))].image
    colours = linear_rgba(image.reshape(-1, image.shape[2]))[:, :3].reshape(*image.shape[:2], 3)
    normal = maps.get("normal")
    return Skin(texture=colours, uv=uv, bumps=None if normal is None else normal.image, tangents=tangents)
