"""Saved sources: what is kept with them, and how they are shown with another stack."""

from typing import TYPE_CHECKING

import numpy as np

from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.output.gather import gather_images
from texloom.output.sources_file import SavedSources

if TYPE_CHECKING:
    from texloom.domain.surface import Surface
    from texloom.output.atlas import Atlas

_ATLAS, SURFACE = "atlas.", "surface."


def image_domain(rows: int, columns: int, exemplar: Exemplar) -> dict[str, np.ndarray]:
    """What the sources of an image are kept with."""
    return {"rows": np.array(rows), "columns": np.array(columns), "sample": np.array(exemplar.shape)}


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
    laid = {} if atlas is None else {name: values for name, values in vars(atlas).items() if values is not None}
    kept = {"sample": np.array(exemplar.shape)}
    kept |= {SURFACE + name: values for name, values in sites.items()}
    return kept | {_ATLAS + name: values for name, values in laid.items()}


def reapply(saved: SavedSources, exemplar: Exemplar, name: str) -> dict[str, Map]:
    """Every map of the stack, arranged as the sources say.

    Raises: ParameterError, unless the stack has the size of the sample the sources came from.
    """
    check_sample(saved, exemplar, name)
    if "rows" in saved.domain:
        rows, columns = int(saved.domain["rows"]), int(saved.domain["columns"])
        return gather_images(saved.sources, exemplar, rows=rows, columns=columns)
    laid = {name.removeprefix(_ATLAS): array for name, array in saved.domain.items() if name.startswith(_ATLAS)}
    if not laid:
        raise ParameterError(f"{name} holds sources of vertex colours: grow the surface again with --as atlas")
    from texloom.output.atlas import Atlas, bake

    return bake(saved.sources, Atlas(**laid), exemplar.maps)


def check_sample(saved: SavedSources, exemplar: Exemplar, name: str) -> None:
    """Raises: ParameterError, unless the stack has the size of the sample the sources came from."""
    asked = tuple(int(side) for side in saved.domain.get("sample", ()))
    if exemplar.shape != asked:
        of = "x".join(str(side) for side in reversed(asked)) or "unknown size"
        raise ParameterError(
            f"{name} was made from a sample of {of} texels, but the stack is "
            f"{exemplar.shape[1]}x{exemplar.shape[0]}: resize it to match"
        )
