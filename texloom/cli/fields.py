"""Direction and scale fields from the options of ``texloom surface``."""

from pathlib import Path

import numpy as np
from jaxtyping import Float64

from texloom.cli.guides import Guides, read_guides
from texloom.errors import ParameterError
from texloom.field.direction import DirectionField, from_constant, from_vectors
from texloom.field.smooth import smoothest, through_arrows
from texloom.mesh.model import Model

_NAMES = ("smooth", "curvature")


def direction_field(model: Model, wish: str, *, order: int) -> DirectionField:
    """The field that ``--direction`` asks for: a name, a vector x,y,z, a file, or ``rbf:`` and a file."""
    mesh = model.mesh
    if wish == "smooth":
        return smoothest(mesh, order)
    if wish == "curvature":
        from texloom.field.curvature import along_curvature

        return along_curvature(mesh, order)
    vector = _vector(wish)
    if vector is not None:
        return from_constant(mesh, order, vector)
    path = guide_file(wish)
    assert path is not None
    guides = read_guides(path, model, wanted="direction")
    vertices, directions = guides.directed()
    if wish.startswith("rbf:"):
        from texloom.field.rbf import through_arrows_rbf

        return through_arrows_rbf(mesh, order, vertices=vertices, directions=directions)
    if _is_everywhere(guides, model):
        vectors = np.zeros_like(mesh.vertices)
        vectors[vertices] = directions
        return from_vectors(mesh, order, vectors)
    return through_arrows(mesh, order, vertices=vertices, directions=directions)


def scale_field(model: Model, path: Path | None, direction: str) -> Float64[np.ndarray, "vertex"] | None:
    """The scale at every vertex: from ``--scale``, else from the arrows of ``--direction``, else None (all 1)."""
    arrows = guide_file(direction)
    if path is not None:
        vertices, scales = read_guides(path, model, wanted="scale").scaled()
    elif arrows is not None and arrows.suffix.lower() == ".json":
        vertices, scales = read_guides(arrows, model, wanted="direction").scaled()
    else:
        return None
    if not len(vertices):
        return None
    from texloom.field.scale import interpolate_scale

    return interpolate_scale(model.mesh, vertices=vertices, scales=scales)


def guide_file(wish: str) -> Path | None:
    """The file a wish for a direction names, if it names one."""
    if wish in _NAMES or _vector(wish) is not None:
        return None
    return Path(wish.removeprefix("rbf:"))


def _vector(wish: str) -> Float64[np.ndarray, "3"] | None:
    """Three numbers, if that is what the text is."""
    parts = wish.split(",")
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        return None
    if len(numbers) != 3:
        raise ParameterError(f"--direction {wish}: a vector has 3 numbers, x,y,z, these are {len(numbers)}")
    return np.array(numbers)


def _is_everywhere(guides: Guides, model: Model) -> bool:
    """Whether every vertex has a direction, as an array gives it."""
    return len(np.unique(guides.directed()[0])) == len(model.mesh.vertices)
