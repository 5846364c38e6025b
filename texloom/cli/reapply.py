"""Saved sources shown with another stack: on the image, or on the atlas, they were grown for."""

from dataclasses import fields

import numpy as np

from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.output.atlas import Atlas, bake
from texloom.output.gather import gather_images
from texloom.output.sources_file import SavedSources

_ATLAS = "atlas."


def image_domain(rows: int, columns: int, exemplar: Exemplar) -> dict[str, np.ndarray]:
    """What the sources of an image are kept with."""
    return {"rows": np.array(rows), "columns": np.array(columns), "sample": np.array(exemplar.shape)}


def surface_domain(atlas: Atlas | None, exemplar: Exemplar) -> dict[str, np.ndarray]:
    """What the sources of a surface are kept with: the atlas they were baked on, if they were."""
    kept = {} if atlas is None else {_ATLAS + field.name: getattr(atlas, field.name) for field in fields(Atlas)}
    kept = {name: values for name, values in kept.items() if values is not None}
    return {"sample": np.array(exemplar.shape), **kept}


def reapply(saved: SavedSources, exemplar: Exemplar, name: str) -> dict[str, Map]:
    """Every map of the stack, arranged as the sources say.

    Raises: ParameterError, unless the stack has the size of the sample the sources came from.
    """
    asked = tuple(int(side) for side in saved.domain.get("sample", ()))
    if exemplar.shape != asked:
        of = "x".join(str(side) for side in reversed(asked)) or "unknown size"
        raise ParameterError(
            f"{name} was made from a sample of {of} texels, but the stack is "
            f"{exemplar.shape[1]}x{exemplar.shape[0]}: resize it to match"
        )
    if "rows" in saved.domain:
        rows, columns = int(saved.domain["rows"]), int(saved.domain["columns"])
        return gather_images(saved.sources, exemplar, rows=rows, columns=columns)
    laid = {name.removeprefix(_ATLAS): array for name, array in saved.domain.items() if name.startswith(_ATLAS)}
    if not laid:
        raise ParameterError(f"{name} holds sources of vertex colours: grow the surface again with --as atlas")
    return bake(saved.sources, Atlas(**laid), exemplar.maps)
