"""A textured surface taken up again to be scored: from the GLB of its vertex colours, or from saved sources."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float32, Shaped

from texloom.arrays import Image
from texloom.cli.guides import on_mesh
from texloom.cli.reapply import ATLAS, SURFACE, check_sample
from texloom.domain.patches import Patches
from texloom.domain.surface import Surface
from texloom.errors import FileError, ParameterError
from texloom.exemplar.colour import encode
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.field.direction import from_vectors
from texloom.mesh.gltf import Document, accessor, primitives, unpack
from texloom.mesh.mesh import Mesh
from texloom.metrics import SurfaceScores, apparent_sources, score_surface, surface_copy_side
from texloom.metrics.patches import Usable, encoded
from texloom.output.gather import gather_sites
from texloom.output.image import stored
from texloom.output.material import base_colour
from texloom.output.sources_file import SavedSources
from texloom.sources import SourceMap

_WIDTH = 24  # texels: side of the patches that are looked at, and from one to the next
_AGAIN = "texture the mesh --as vertex and score that .glb"
_INSTEAD = "score the .glb that --as vertex writes, or the file that --sources saves"


@dataclass(frozen=True, eq=False)
class Painted:
    """A surface, and what each of its sites shows of the maps, as an exemplar keeps them (colours in linear light)."""

    surface: Surface
    values: dict[str, Float32[np.ndarray, "site channel"]]
    sources: SourceMap | None = None  # where they are known


def score_painted(exemplar: Exemplar, painted: Painted) -> dict[str, dict[str, float]]:
    """``SurfaceScores`` of every map that the sample and the surface both have; ``copy`` is that of the first.

    Raises: ParameterError, if there is none, or no patch fits on the surface.
    """
    names = [name for name in exemplar.maps if name in painted.values]
    if not names:
        held = f"the sample holds {', '.join(exemplar.maps)}, the surface {', '.join(painted.values)}"
        raise ParameterError(f"{held}: no map in common")
    patches = scored_patches(painted.surface)
    scores = {name: vars(score_sites(exemplar.maps[name], patches, painted.values[name])) for name in names}
    sources = painted.sources
    if sources is None:
        lead = exemplar.maps[names[0]]
        seen = _as_seen(lead, painted.values[names[0]])
        sources = apparent_sources(_sample(lead), painted.surface, seen, usable=exemplar.mask)
    copied = surface_copy_side(sources, painted.surface)
    return {name: {**own, "copy": copied} for name, own in scores.items()}


def scored_patches(surface: Surface) -> Patches:
    """Patches side by side over the whole surface."""
    return surface.patches(surface.centres(_WIDTH, 0), _WIDTH)


def score_sites(
    sample: Map,
    patches: Patches,
    values: Float32[np.ndarray, "site channel"],
    *,
    usable: Usable = None,
    most: int | None = None,
) -> SurfaceScores:
    """Scores of one map, both as stored; see ``score_surface``."""
    return score_surface(_sample(sample), patches, _as_seen(sample, values), usable=usable, most=most)


def _sample(sample: Map) -> Image:
    """A map as stored, 16 bits where it is float."""
    return encoded(stored(sample, min(sample.bits, 16)))


def _as_seen(sample: Map, values: Float32[np.ndarray, "site channel"]) -> Float32[np.ndarray, "site channel"]:
    """What sites show of a map, as stored."""
    seen = np.clip(encode(values) if sample.kind == "colour" else values, 0.0, 1.0)
    return np.ascontiguousarray(seen[:, : sample.image.shape[2]], np.float32)


def from_sources(saved: SavedSources, exemplar: Exemplar, name: str) -> Painted:
    """The surface that sources were saved with, and what they show of the exemplar.

    Raises: ParameterError, if they lack their surface or are of a sample of another size.
    """
    check_sample(saved, exemplar, name)
    sites = {key.removeprefix(SURFACE): array for key, array in saved.domain.items() if key.startswith(SURFACE)}
    if not sites and any(key.startswith(ATLAS) for key in saved.domain):
        raise ParameterError(f"{name} holds what the texels of an atlas show, not where they lie: {_AGAIN}")
    if not sites:
        raise ParameterError(f"{name} does not say where its sites lie: grow the surface again with --sources")
    surface = _surface(
        Mesh(sites["vertices"], sites["faces"]),
        sites["direction"],
        sites["scale"],
        texel=float(sites["texel"]),
        symmetry=int(sites["symmetry"]),
    )
    values = {key: gather_sites(saved.sources, map) for key, map in exemplar.maps.items()}
    return Painted(surface, values, saved.sources)


def from_glb(path: Path, exemplar: Exemplar) -> Painted:
    """The surface of a GLB with vertex colours as ``texloom surface --as vertex`` writes it.

    Raises: FileError, if it cannot be read; ParameterError, if it lacks its colours, its field or its texel.
    """
    from texloom.io.mesh import read_mesh

    if path.suffix.lower() not in (".glb", ".gltf"):
        raise ParameterError(f"{path.name} is a mesh without a direction field: {_INSTEAD}")
    model = read_mesh(path)
    assert model.document is not None
    document = unpack(model.document)
    read = _attributes(path, document)
    base = base_colour(exemplar.maps) or next(iter(exemplar.maps))
    renamed = {base: "COLOR_0", **{name: f"_{name.upper()}" for name in exemplar.maps if name != base}}
    values = {name: on_mesh(read[kind], model) for name, kind in renamed.items() if kind in read}
    scale = read.get("_SCALE", np.ones((len(read["TANGENT"]), 1), np.float32))
    surface = _surface(
        model.mesh,
        on_mesh(read["TANGENT"][:, :3], model),
        on_mesh(scale[:, 0], model),
        texel=_texel(path, document),
        symmetry=_symmetry(document),
    )
    return Painted(surface, values)


def _surface(
    mesh: Mesh,
    direction: Shaped[np.ndarray, "vertex 3"],
    scale: Shaped[np.ndarray, "vertex"],
    *,
    texel: float,
    symmetry: int,
) -> Surface:
    """The vertices as sites."""
    field = from_vectors(mesh, symmetry, direction.astype(np.float64))
    return Surface.build(mesh, field, texel=texel, scale=scale, spacing=np.inf)


def _attributes(path: Path, document: Document) -> dict[str, np.ndarray]:
    """Vertex attributes that all primitives have, strung together as ``primitives`` counts vertices."""
    parts = primitives(document)
    shared = set.intersection(*(set(part.attributes) for part in parts))
    if "_UV_A" in shared:
        raise ParameterError(f"{path.name} shows the sample itself, face by face: {_AGAIN}")
    for kind, what in (("COLOR_0", "vertex colours"), ("TANGENT", "direction field")):
        if kind not in shared:
            raise ParameterError(f"{path.name} carries no {what}: {_INSTEAD}")
    return {
        kind: np.concatenate([accessor(document, part.attributes[kind]).astype(np.float32) for part in parts])
        for kind in shared
    }


def _texel(path: Path, document: Document) -> float:
    """World length of a texel, from the extras of the mesh."""
    extras = [mesh.get("extras") for mesh in document.json["meshes"]]
    lengths = {entry["texel"] for entry in extras if isinstance(entry, dict) and "texel" in entry}
    if len(lengths) != 1:
        raise ParameterError(f"{path.name} does not say how long a texel is: {_INSTEAD}")
    try:
        return float(lengths.pop())
    except (TypeError, ValueError):
        raise FileError(f"{path.name}: its texel is not a length: {_INSTEAD}") from None


def _symmetry(document: Document) -> int:
    """The field's symmetry, from the settings of the run."""
    settings = document.json["asset"].get("extras", {}).get("texloom", {})
    return int(settings.get("symmetry", 1))
