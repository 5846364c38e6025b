"""Direction and scale fields, and the length of a texel, from the options of ``texloom surface``."""

from pathlib import Path

import numpy as np
from jaxtyping import Float64

from texloom.cli.guides import holds_arrows, placed_arrows, vertex_rows
from texloom.cli.session import Session
from texloom.cli.surface_wish import SurfaceWish
from texloom.domain.surface import texel_for_repeats
from texloom.errors import FieldError, ParameterError
from texloom.field import rbf
from texloom.field.curvature import along_curvature
from texloom.field.direction import DirectionField, from_constant, from_vectors
from texloom.field.scale import checked, from_arrows
from texloom.field.smooth import smoothest, through_arrows
from texloom.io.mesh import read_mesh
from texloom.mesh.mesh import Mesh
from texloom.mesh.model import Model

_NAMES = ("smooth", "curvature")
_MANY_ARROWS = 100  # beyond, a scale field of two solves an arrow takes too long
_RBF, _SPREAD = "rbf:", "spread:"
_REPEATS = 3.0  # sample widths across the mesh where neither --repeats nor --texel is given,
_MOST_TEXELS = 1.2e6  # or fewer of a large sample, so that it takes seconds and an atlas of 2048² holds it


def read_guided(
    path: Path, wish: SurfaceWish, session: Session
) -> tuple[Model, DirectionField, Float64[np.ndarray, "vertex"] | None]:
    """A mesh, its direction field and its scales."""
    guides = wish.guides
    with session.stage("read"):
        model = read_mesh(path, material=wish.material)
    with session.stage("field"):
        field = direction_field(model, guides.direction, order=guides.symmetry)
        return model, field, scale_field(model, guides.scale, guides.direction) if guides.progressive else None


def direction_field(model: Model, wish: str, *, order: int) -> DirectionField:
    """The field that ``--direction`` asks for: a name, x,y,z, a file, or ``rbf:`` or ``spread:`` and one of arrows."""
    mesh = model.mesh
    if wish == "smooth":
        return smoothest(mesh, order)
    if wish == "curvature":
        return along_curvature(mesh, order)
    path = guide_file(wish)
    if path is None:
        return from_constant(mesh, order, np.array(vector(wish)))
    if not holds_arrows(path):
        return from_vectors(mesh, order, vertex_rows(path, model, columns=3))
    placed = placed_arrows(path, model)
    if not len(placed.direction):
        raise FieldError(f"{path.name}: none of its {len(placed.scale)} arrows gives a direction")
    through = through_arrows
    if wish.startswith(_RBF):
        through = rbf.directions
    if wish.startswith(_SPREAD):
        from texloom.field import spread

        through = spread.directions
    return through(mesh, order, vertices=placed.direction_vertex, directions=placed.direction)


def scale_field(model: Model, path: Path | None, direction: str) -> Float64[np.ndarray, "vertex"] | None:
    """The scale at every vertex: from ``--scale``, else from the arrows of ``--direction``, else None (all 1)."""
    mesh = model.mesh
    if path is not None and not holds_arrows(path):
        return checked(mesh, vertex_rows(path, model, columns=1)[:, 0])
    file = path or guide_file(direction)
    if file is None or not holds_arrows(file):
        return None
    placed = placed_arrows(file, model)
    if not len(placed.scale):
        if path is not None:
            raise FieldError(f"{path.name}: none of its {len(placed.direction)} arrows gives a scale")
        return None
    if direction.startswith(_RBF):
        return rbf.scales(mesh, vertices=placed.scale_vertex, scales=placed.scale)
    smoothness = "biharmonic" if len(placed.scale) <= _MANY_ARROWS else "harmonic"
    return from_arrows(mesh, vertices=placed.scale_vertex, scales=placed.scale, smoothness=smoothness)


def texel_length(mesh: Mesh, columns: int, *, texel: float | None, repeats: float | None, few: bool) -> float:
    """World length of a texel of a sample so many wide: given, by ``repeats``, or usual; ``few`` bounds the usual."""
    if texel is not None:
        return texel
    length = texel_for_repeats(mesh, _REPEATS if repeats is None else repeats, columns)
    return length if repeats is not None or not few else max(length, (mesh.face_areas.sum() / _MOST_TEXELS) ** 0.5)


def guide_file(wish: str) -> Path | None:
    """The file that a wish for a direction names, if it names one."""
    return None if wish in _NAMES or vector(wish) is not None else Path(wish.removeprefix(_RBF).removeprefix(_SPREAD))


def vector(wish: str) -> tuple[float, ...] | None:
    """The numbers of x,y,z; None where the text is something else."""
    try:
        numbers = tuple(float(part) for part in wish.split(","))
    except ValueError:
        return None
    if len(numbers) != 3:
        raise ParameterError(f"--direction {wish}: a vector has 3 numbers, x,y,z; these are {len(numbers)}")
    return numbers
