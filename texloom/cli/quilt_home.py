"""Quilted faces back on the user's mesh: coordinates into the sample, a blended atlas, vertex colours; a report."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from jaxtyping import Bool, UInt8

from texloom.cli.bring_home import AtlasWish, Homecoming, baked_skin, choose_uv, coloured_skin, fitting_size, write_mesh
from texloom.cli.painted import score_sites, scored_patches
from texloom.cli.reapply import atlas_domain, surface_domain
from texloom.cli.reports import LARGE, sample_figures
from texloom.cli.surface_wish import SurfaceWish
from texloom.domain.surface import Surface
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.mesh.model import Model
from texloom.output.atlas import Atlas, lay_atlas
from texloom.output.blended_atlas import bake_blend, face_sites
from texloom.output.blending import Blend, EdgeErrors, blend
from texloom.output.edge_picture import edge_picture
from texloom.output.gather import gather_sites
from texloom.output.material import MaterialMaps
from texloom.output.preview import Skin, preview
from texloom.output.report import Account, Figure, fitted
from texloom.output.sample_uv import blending_attributes, on_sample, write_sample_uv
from texloom.output.sites import SurfaceSites
from texloom.output.sources_file import SavedSources, save_sources
from texloom.output.tangents import corner_tangents
from texloom.output.vertex_colours import write_vertex_colours
from texloom.sources import SourceMap
from texloom.synthesis.quilting import Quilted

_COMPARED = 65_536  # patches whose scores are taken: more take long and hardly change them


@dataclass(frozen=True, eq=False)
class Quilt:
    """A mesh quilted from a sample: where its faces lie there, how its edges fit, and which are blended."""

    model: Model
    quilted: Quilted
    exemplar: Exemplar
    maps: MaterialMaps  # of the sample, also beyond its mask
    errors: EdgeErrors
    blended: Bool[np.ndarray, "edge"]

    @cached_property
    def blend(self) -> Blend:
        """The faces in their own maps and, over blended edges, in their neighbours'."""
        faces = self.quilted.faces
        return blend(faces.mesh, self.quilted.coordinates, self.errors.at_faces(self.blended))

    @cached_property
    def surface(self) -> Surface:
        """Sites on the quilted faces, as far apart as texels."""
        faces = self.quilted.faces
        return Surface.build(faces.mesh, faces.field, texel=faces.texel, scale=faces.scale)

    @cached_property
    def at_sites(self) -> SourceMap:
        """What the sites show."""
        refined = self.surface.refined
        return self.blend.sources(refined.vertex_parent_face, refined.vertex_barycentric)


def bring_quilt(quilt: Quilt, output: Path, wish: SurfaceWish, settings: Mapping[str, str]) -> Homecoming:
    """Write the textured mesh, and its sources where they are wanted."""
    if wish.home == "sample-uv":
        return _on_sample(quilt, output, settings)
    if wish.home == "vertex":
        sites, whole = SurfaceSites.of(quilt.surface), replace(quilt.exemplar, maps=dict(quilt.maps))
        files = [write_vertex_colours(output, sites, quilt.at_sites, whole, settings=settings)]
        if wish.sources is not None:
            kept = surface_domain(quilt.surface, None, quilt.exemplar)
            files.append(save_sources(wish.sources, SavedSources(quilt.at_sites, kept, settings)))
        return Homecoming(files, coloured_skin(quilt.at_sites, whole))
    return _on_atlas(quilt, output, wish, settings)


def _on_sample(quilt: Quilt, output: Path, settings: Mapping[str, str]) -> Homecoming:
    """Coordinates into the sample, and what a shader needs to blend."""
    mesh, shape, maps = quilt.model.mesh, quilt.exemplar.shape, quilt.maps
    further = blending_attributes(quilt.blend.neighbours, quilt.errors, shape)
    shown = on_sample(mesh, quilt.quilted.coordinates, shape, further=further)
    files = write_sample_uv(output, quilt.model, shown, maps, settings=settings)
    assert shown.tangents is not None
    return Homecoming(files, baked_skin(maps, shown.uv, shown.tangents), f"sample, {shape[1]}×{shape[0]}")


def _on_atlas(quilt: Quilt, output: Path, wish: SurfaceWish, settings: Mapping[str, str]) -> Homecoming:
    """A new texture in which edges are blended."""
    model, faces, asked = quilt.model, quilt.quilted.faces, AtlasWish(*wish.atlas)
    mesh, refined = model.mesh, faces.refined
    size = asked.size or fitting_size(faces.area)
    uv, whose = choose_uv(model, asked, size)
    tangents = corner_tangents(mesh.vertices, mesh.faces, uv, normals=mesh.vertex_normals[mesh.faces])
    way_home = {} if refined is None else {"parent": refined.parent, "corners": refined.corner_barycentric}
    sites = face_sites(faces.mesh, quilt.quilted.coordinates, **way_home)
    laid = lay_atlas(sites, uv, size=size, gutter=asked.gutter, tangents=tangents)
    maps = bake_blend(quilt.blend, laid, quilt.maps)
    files = write_mesh(output, model, maps, uv, tangents, fresh=whose != "own", settings=settings)
    if wish.sources is not None:
        files.append(save_sources(wish.sources, _sources(quilt, laid, settings)))
    return Homecoming(files, baked_skin(maps, uv, tangents), f"{whose}, {size}×{size}", laid)


def _sources(quilt: Quilt, atlas: Atlas, settings: Mapping[str, str]) -> SavedSources:
    """The sources of every texel of the atlas."""
    sources = quilt.blend.sources(atlas.sites[:, 0] // 3, atlas.barycentric)
    return SavedSources(sources, atlas_domain(atlas, quilt.exemplar), settings)


def picture(quilt: Quilt, skin: Skin) -> UInt8[np.ndarray, "row column 3"]:
    """The mesh from four sides, as it is stored; skins of vertex colours are for the sites."""
    if skin.uv is not None:
        mesh = quilt.model.mesh
        return preview(mesh.vertices, mesh.faces, skin, normals=mesh.vertex_normals)
    sites = SurfaceSites.of(quilt.surface)
    return preview(sites.vertices, sites.faces, skin, normals=sites.shown_normal)


def account(
    quilt: Quilt, skin: Skin, settings: Mapping[str, str], seconds: Mapping[str, float], command: str
) -> Account:
    """What a report tells of the run."""
    faces, map = quilt.quilted.faces, quilt.exemplar.lead
    edges = edge_picture(
        faces.mesh, quilt.quilted.coordinates, quilt.errors, sample=quilt.exemplar.lead, blended=quilt.blended
    )
    told = f"{len(faces.mesh.faces)} faces in {faces.count} patches, a texel is {faces.texel:.4g} long"
    figures = {
        "Sample": sample_figures(quilt.exemplar),
        "Result": [Figure(fitted(picture(quilt, skin), LARGE), f"{quilt.model.path.name} from four sides, {told}")],
        "Edges": [Figure(fitted(edges, LARGE), "How much the two sides of each edge differ; most are blended")],
    }
    try:
        patches = scored_patches(quilt.surface)
        values = gather_sites(quilt.at_sites, map)
        scores = vars(score_sites(map, patches, values, usable=quilt.exemplar.mask, most=_COMPARED))
        remark = f"Of {next(iter(quilt.exemplar.maps))}, on pictures laid along the field, edges blended; 0 is best."
    except ParameterError as error:
        scores, remark = {}, f"No scores: {error}."
    return Account(
        title=f"Surface from {settings['sample']}",
        subtitle=f"{settings['software']}, seed {settings['seed']}",
        command=command,
        settings=settings,
        figures=figures,
        scores=scores,
        remark=remark,
        energy=quilt.quilted.energy,
        plots={},
        seconds=seconds,
    )
