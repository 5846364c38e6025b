"""Saved sources checked against the stack they are applied to."""

from typing import TYPE_CHECKING

from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.exemplar.exemplar import Exemplar
    from texloom.output.sources_file import SavedSources


def grid_of(saved: "SavedSources", exemplar: "Exemplar", name: str) -> tuple[int, int]:
    """Rows and columns of the image the sources are for, if this stack has the size of the sample they came from."""
    if "rows" not in saved.domain:
        raise ParameterError(f"{name} holds the sources of a surface: apply takes those of an image")
    asked = tuple(int(side) for side in saved.domain["sample"])
    if exemplar.shape != asked:
        raise ParameterError(
            f"{name} was made from a sample of {asked[1]}x{asked[0]} texels, but the stack is "
            f"{exemplar.shape[1]}x{exemplar.shape[0]}: resize it to match"
        )
    return int(saved.domain["rows"]), int(saved.domain["columns"])
