"""Saved sources: what is kept with them, and how they are shown with other stacks."""

from collections.abc import Sequence
from dataclasses import astuple, replace
from typing import TYPE_CHECKING

import numpy as np

from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, Map, Part
from texloom.exemplar.join import Joined, arrange
from texloom.output.gather import gather_images
from texloom.output.sources_file import SavedSources

if TYPE_CHECKING:
    from texloom.domain.surface import Surface
    from texloom.output.atlas import Atlas

ATLAS, SURFACE = "atlas.", "surface."


def image_domain(rows: int, columns: int, exemplar: Exemplar) -> dict[str, np.ndarray]:
    """What the sources of an image are kept with."""
    return {"rows": np.array(rows), "columns": np.array(columns), **_samples(exemplar)}


def surface_domain(surface: "Surface", atlas: "Atlas | None", exemplar: Exemplar) -> dict[str, np.ndarray]:
    """What the sources of a surface are kept with: its sites, and the atlas they were baked on, if they were."""
    sites = {
        "vertices": surface.refined.mesh.vertices,
        "faces": surface.refined.mesh.faces,
        "direction": surface.direction.astype(np.float32),
        "scale": surface.scale,
        "texel": np.array(surface.texel),
        "symmetry": np.array(surface.field.order),
    }
    kept = _samples(exemplar) | {SURFACE + name: values for name, values in sites.items()}
    return kept if atlas is None else kept | _laid(atlas)


def atlas_domain(atlas: "Atlas", exemplar: Exemplar) -> dict[str, np.ndarray]:
    """What sources are kept with that each belong to a texel of an atlas."""
    count = len(atlas.sites)
    own = np.repeat(np.arange(count, dtype=np.int32)[:, None], 3, axis=1)
    alone = np.broadcast_to(np.array([1, 0, 0], np.float32), (count, 3))
    still = np.zeros((count, 3, 2), np.float32)
    return _samples(exemplar) | _laid(replace(atlas, sites=own, barycentric=alone, offsets=still))


def _laid(atlas: "Atlas") -> dict[str, np.ndarray]:
    return {ATLAS + name: values for name, values in vars(atlas).items() if values is not None}


def rejoin(saved: SavedSources, stacks: Sequence[Exemplar], name: str) -> Joined:
    """Stacks laid where the samples lay that the sources came from.

    Raises: ParameterError, unless there is one for each sample, of its size and in its place.
    """
    parts = _parts(saved)
    if [stack.shape for stack in stacks] != [(part.rows, part.columns) for part in parts]:
        raise _misfit(parts, stacks, name)
    return arrange(stacks, parts)


def reapply(saved: SavedSources, exemplar: Exemplar, name: str) -> dict[str, Map]:
    """Every map of the exemplar, arranged as the sources say.

    Raises: ParameterError, unless it is as large as the sample the sources came from (of several: ``rejoin`` it).
    """
    check_sample(saved, exemplar, name)
    if "rows" in saved.domain:
        rows, columns = int(saved.domain["rows"]), int(saved.domain["columns"])
        return gather_images(saved.sources, exemplar, rows=rows, columns=columns)
    laid = {name.removeprefix(ATLAS): array for name, array in saved.domain.items() if name.startswith(ATLAS)}
    if not laid:
        raise ParameterError(f"{name} holds sources of vertex colours: grow the surface again with --as atlas")
    from texloom.output.atlas import Atlas, bake

    return bake(saved.sources, Atlas(**laid), exemplar.maps)


def check_sample(saved: SavedSources, exemplar: Exemplar, name: str) -> None:
    """Raises: ParameterError, unless the exemplar is laid out as the one the sources came from."""
    whole = Part(0, 0, *exemplar.shape)
    if _parts(saved) != (exemplar.parts or (whole,)):
        raise _misfit(_parts(saved), [exemplar], name)


def _samples(exemplar: Exemplar) -> dict[str, np.ndarray]:
    """The exemplar's size, and where each of several samples lies in it."""
    kept = {"sample": np.array(exemplar.shape)}
    if exemplar.parts:
        kept["parts"] = np.array([astuple(part) for part in exemplar.parts])
    return kept


def _parts(saved: SavedSources) -> tuple[Part, ...]:
    """Where the samples lie that the sources speak of; none where the file does not say."""
    if "parts" in saved.domain:
        return tuple(Part(*(int(value) for value in part)) for part in saved.domain["parts"])
    return (Part(0, 0, *(int(side) for side in saved.domain["sample"])),) if "sample" in saved.domain else ()


def _misfit(parts: Sequence[Part], stacks: Sequence[Exemplar], name: str) -> ParameterError:
    """What was asked for, and what was given."""
    asked = ", ".join(f"{part.columns}x{part.rows}" for part in parts) or "unknown size"
    given = ", ".join(f"{stack.shape[1]}x{stack.shape[0]}" for stack in stacks)
    if len(parts) > 1 or len(stacks) > 1:
        return ParameterError(
            f"{name} was made from samples of {asked} texels, but the stacks are {given}: "
            "give one for each sample, of its size and in this order"
        )
    return ParameterError(
        f"{name} was made from a sample of {asked} texels, but the stack is {given}: resize it to match"
    )
