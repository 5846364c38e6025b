"""Scale fields: how much larger than its sample the texture is around each vertex; 1 leaves it as it is."""

from typing import Literal

import numpy as np
from jaxtyping import Float, Float64, Int

from texloom.errors import FieldError
from texloom.field.laplacian import connection_laplacian
from texloom.field.multigrid import Multigrid, plus_diagonal, principal_block
from texloom.field.transport import Transport
from texloom.mesh.mesh import Mesh

Smoothness = Literal["biharmonic", "harmonic"]

_TOLERANCE = 1e-8
_SHIFT = 1e-6  # over the area: makes the Laplacian of a closed surface definite, and changes nothing else


def uniform(mesh: Mesh, scale: float = 1.0) -> Float64[np.ndarray, "vertex"]:
    """One scale everywhere."""
    return checked(mesh, np.full(len(mesh.vertices), scale, float))


def checked(mesh: Mesh, scales: Float[np.ndarray, "vertex"]) -> Float64[np.ndarray, "vertex"]:
    """Scales given for every vertex.

    Raises: FieldError, unless there is one for each vertex, finite and above 0.
    """
    if np.shape(scales) != (len(mesh.vertices),):
        raise FieldError(f"{np.size(scales)} scales for {len(mesh.vertices)} vertices: give one number for each vertex")
    return _positive(np.asarray(scales, float), "scales")


def from_arrows(
    mesh: Mesh,
    *,
    vertices: Int[np.ndarray, "arrow"],
    scales: Float[np.ndarray, "arrow"],
    smoothness: Smoothness = "biharmonic",
) -> Float64[np.ndarray, "vertex"]:
    """Scales that vary smoothly between those given at some vertices, and never leave their range.

    Interpolated as logarithms, so that between 1 and 4 lies 2. "biharmonic" is a smooth slope from arrow to arrow and
    costs two linear solves an arrow; "harmonic" is one solve, but keeps a middle value with a spike at every arrow:
    choose it for arrows by the hundred. Several at one vertex count as their geometric mean; a part of the mesh
    without arrows gets the mean of all.

    Raises: FieldError, if there is no arrow, or a scale is not finite and above 0.
    """
    if len(scales) == 0:
        raise FieldError("no arrow gives a scale: give one, or a number for each vertex")
    places, same = np.unique(vertices, return_inverse=True)
    logs = np.bincount(same, weights=np.log(_positive(np.asarray(scales, float), "arrows' scales")))
    logs /= np.bincount(same)
    value = np.full(len(mesh.vertices), logs.mean())
    interpolate = _biharmonic if smoothness == "biharmonic" else _harmonic
    for part in np.unique(mesh.vertex_parts[places]):
        here, mine = mesh.vertex_parts == part, mesh.vertex_parts[places] == part
        value[here] = interpolate(mesh, here, places[mine], logs[mine])
    value[places] = logs
    return np.exp(np.clip(value, logs.min(), logs.max()))


def _harmonic(mesh: Mesh, here: np.ndarray, places: np.ndarray, logs: np.ndarray) -> Float64[np.ndarray, "here"]:
    """The least steep interpolation on one part."""
    laplacian = connection_laplacian(Transport(mesh), 0)
    value = np.zeros(len(here), complex)
    value[places] = logs
    free = here.copy()
    free[places] = False
    if free.any():
        right = -(laplacian @ value)[free]
        value[free] = Multigrid(principal_block(laplacian, free)).solve(right, tolerance=_TOLERANCE)
    return np.real(value[here])


def _biharmonic(mesh: Mesh, here: np.ndarray, places: np.ndarray, logs: np.ndarray) -> Float64[np.ndarray, "here"]:
    """The least bent interpolation on one part: Σ λ_j G_j + c with Σ λ_j = 0.

    G_j is the response of the squared Laplacian to a load at arrow j, balanced over the part.
    """
    mass = np.maximum(mesh.vertex_areas[here], 1e-300)
    area = mass.sum()
    laplacian = principal_block(connection_laplacian(Transport(mesh), 0), here)
    system = Multigrid(plus_diagonal(laplacian, _SHIFT * mass / area))
    at = np.searchsorted(np.flatnonzero(here), places)
    responses = np.empty((len(mass), len(at)))
    for j, place in enumerate(at):
        load = -mass / area
        load[place] += 1.0
        responses[:, j] = _balanced(system, _balanced(system, load, mass) * mass, mass)
    count = len(at)
    matrix = np.ones((count + 1, count + 1))
    matrix[:count, :count], matrix[count, count] = responses[at], 0.0
    *weights, constant = np.linalg.solve(matrix, np.append(logs, 0.0))
    return (responses * np.array(weights)).sum(axis=1) + constant


def _balanced(
    system: Multigrid, load: Float64[np.ndarray, "n"], mass: Float64[np.ndarray, "n"]
) -> Float64[np.ndarray, "n"]:
    """The response of the Laplacian to a load that sums to 0, itself 0 in the mean."""
    response = np.real(system.solve(load.astype(complex), tolerance=_TOLERANCE))
    return response - (mass * response).sum() / mass.sum()


def _positive(scales: Float64[np.ndarray, "n"], what: str) -> Float64[np.ndarray, "n"]:
    wrong = np.flatnonzero(~(np.isfinite(scales) & (scales > 0)))
    if len(wrong):
        raise FieldError(
            f"{len(wrong)} of {len(scales)} {what} are not finite numbers above 0 "
            f"(the first is number {wrong[0]}: {scales[wrong[0]]:g}): give positive ones"
        )
    return scales
