"""Faces quilted from a sample's textons: what ``texloom surface`` does with ``--method texton``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from texloom.cli import options
from texloom.cli.fields import read_guided, texel_length
from texloom.cli.library import SUFFIX
from texloom.cli.meshes import Texture
from texloom.cli.quilt_home import Quilt, account, bring_quilt, picture
from texloom.cli.samples import read_samples, tell_dropped
from texloom.cli.session import Session
from texloom.cli.surface_wish import QuiltWish, SurfaceWish
from texloom.domain.faces import Faces, usual_width
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import to_map
from texloom.output.blending import THRESHOLD, Viewer, edge_errors
from texloom.output.edge_picture import edge_picture
from texloom.output.image import write_image
from texloom.output.sample_uv import usable_maps
from texloom.output.textons_file import load_textons
from texloom.search.textons import Textons, learn_textons
from texloom.synthesis.quilting import Quilting
from texloom.systems import texton

_MOST_PATCHES = 3  # across the sample, nominally: some grow to three times their width, and must have room
_LARGEST_FACE = 0.5  # of the sample's shorter side: longer faces are split, where the mesh may change


def quilt(wish: SurfaceWish, session: Session) -> Texture:
    """Learn the sample's textons, or read them; then what textures one mesh after the other."""
    assert wish.quilting is not None
    if wish.home == "sample-uv" and wish.sources is not None:
        raise ParameterError(
            f"--sources {wish.sources.name}: with --as sample-uv exchange the images of {wish.meshes.output.name} "
            "instead, or give --as atlas"
        )
    method, guides, viewer = _method(wish.quilting), wish.guides, Viewer(distance=wish.quilting.distance)
    threshold = THRESHOLD if wish.quilting.blend is None else wish.quilting.blend
    textons, dropped = _textons(wish, session)
    exemplar = textons.exemplar
    maps = usable_maps(exemplar)  # their PNGs are made once, for all meshes
    columns = exemplar.parts[0].columns if exemplar.parts else exemplar.shape[1]
    width = _width(wish.quilting, exemplar.least_side)
    most = None if wish.home == "sample-uv" else _LARGEST_FACE * exemplar.least_side

    def texture(mesh: Path, output: Path) -> Mapping[str, Any]:
        model, field, sizes = read_guided(mesh, wish, session)
        with session.stage("patches"):
            few = wish.home != "sample-uv"
            length = texel_length(model.mesh, columns, texel=wish.texel, repeats=wish.repeats, few=few)
            faces = Faces.build(model.mesh, field, texel=length, scale=sizes, width=width, most=most, seed=wish.seed)
        quilted = method.run(textons, faces, seed=wish.seed, report=session.report)
        session.add(quilted.seconds)
        with session.stage("edges"):
            errors = edge_errors(faces.mesh, quilted.coordinates, textons.image)
            shown = Quilt(model, quilted, exemplar, maps, errors, errors.blended(viewer, threshold=threshold))
        settings = options.settings(
            "surface",
            *wish.samples,
            method=method,
            seed=wish.seed,
            mesh=mesh.name,
            texel=length,
            patch=width,
            direction=guides.direction,
            scale=guides.scale,
            symmetry=guides.symmetry,
            mask=wish.mask,
            blend=threshold,
        )
        with session.stage("write"):
            homecoming = bring_quilt(shown, output, wish, settings)
            session.wrote(homecoming.files)
            if wish.preview is not None:
                session.wrote(write_image(wish.preview, to_map(picture(shown, homecoming.skin), "colour")))
            if wish.edges is not None:
                drawn = edge_picture(
                    faces.mesh, quilted.coordinates, errors, sample=exemplar.lead, blended=shown.blended
                )
                session.wrote(write_image(wish.edges, to_map(drawn, "colour"), settings=settings))
        if wish.report is not None:
            with session.stage("report"):
                from texloom.output.report import write_report

                told = account(shown, homecoming.skin, settings, dict(session.seconds), wish.command)
                session.wrote(write_report(wish.report, told))
        return {
            "method": "texton",
            "preset": wish.preset,
            "seed": wish.seed,
            "faces": len(model.mesh.faces),
            "split": len(faces.mesh.faces) - len(model.mesh.faces),
            "patches": faces.count,
            "texel": length,
            "textons": textons.count,
            "maps": list(exemplar.maps),
            "dropped": list(dropped),
            "energy": list(quilted.energy),
            "stopped": quilted.stopped,
            "edge error": float(errors.mean.mean()) if len(errors.mean) else 0.0,
            "edges": len(errors.mean),
            "blended edges": int(shown.blended.sum()),
            "viewer distance": float(viewer.distance_to(faces.mesh)),
            "as": wish.home,
            "uv": homecoming.uv,
            "mends": list(model.mends),
        }

    return texture


def _method(wish: QuiltWish) -> Quilting:
    if wish.published:
        return texton.quilting()
    return Quilting() if wish.rounds is None else Quilting(rounds=wish.rounds)


def _width(wish: QuiltWish, side: int) -> float | None:
    """Texels across a patch, the sample's shorter side being given; None: every face alone.

    Raises: ParameterError, if patches would have no room in the sample.
    """
    if wish.published or wish.patch == 0:
        return None
    if wish.patch is not None and wish.patch > side / _MOST_PATCHES:
        raise ParameterError(
            f"--patch {wish.patch:g} has no room in a sample of {side} texels: give at most {side // _MOST_PATCHES}, "
            "or 0 to leave each face alone"
        )
    return usual_width((side, side)) if wish.patch is None else wish.patch


def _textons(wish: SurfaceWish, session: Session) -> tuple[Textons, tuple[str, ...]]:
    """Those of the samples, or of a file of textons; and the maps that not all samples have.

    Raises: ParameterError, where a file of textons comes with what it has no use for.
    """
    assert wish.quilting is not None
    saved = [sample for sample in wish.samples if sample.suffix.lower() == SUFFIX]
    if saved:
        if len(wish.samples) > 1:
            raise ParameterError(f"{saved[0].name} holds its own sample: give it alone, or all samples as images")
        for name, value in (("--mask", wish.mask), ("--directx-normals", wish.directx_normals or None)):
            if value is not None:
                raise ParameterError(f"{name} is for samples, {saved[0].name} is learnt already: learn it with {name}")
        with session.stage("read"):
            return load_textons(saved[0]), ()
    with session.stage("read"):
        joined = read_samples(wish.samples, mask=wish.mask, directx_normals=wish.directx_normals)
    tell_dropped(joined)
    with session.stage("learn"):
        learnt = texton.textons if wish.quilting.published else learn_textons
        return learnt(joined.exemplar, report=session.report), joined.dropped
