"""Orders of sites: along the field, front after front, and parts without neighbours."""

import numpy as np
import pytest

from tests.meshes import closed_meshes, cylinder, flat_square, torus, two_parts
from texloom.domain.order import colour_parts, sweep_order
from texloom.domain.surface import Surface
from texloom.field.direction import from_constant, from_vectors
from texloom.field.smooth import smoothest

ALONG = np.array([1.0, 0, 0])


def ranks(order: np.ndarray) -> np.ndarray:
    """When each site comes."""
    np.testing.assert_array_equal(np.sort(order), np.arange(len(order)))
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return rank


@pytest.mark.parametrize("scale", [1.0, 1e-4])
def test_a_sweep_goes_along_the_field_front_after_front(scale: float) -> None:
    """Sites on a lattice of a third of a texel: columns in their order; fronts, half a texel deep, from one side on."""
    mesh = flat_square(24, 8.0 * scale)
    surface = Surface.build(mesh, from_constant(mesh, 1, ALONG), texel=scale, spacing=np.inf)
    rank = ranks(sweep_order(surface))
    x, y = (surface.refined.mesh.vertices[:, :2] / scale).T
    start = np.array([x, y])[:, rank.argmin()]
    assert start[0] == pytest.approx(0, abs=1e-6)
    front = np.floor(x * (1 + 1e-7) / 0.5)
    front[np.isclose(x % 0.5, 0)] = np.nan  # on the line between two fronts either may have it
    sure = np.flatnonzero(np.isfinite(front))
    along = sure[np.argsort(rank[sure])]
    assert (np.diff(front[along]) >= 0).all()
    distance = np.hypot(x - start[0], y - start[1])
    inside = np.diff(front[along]) == 0
    assert (np.diff(distance[along])[inside] >= -1e-6).all()


def test_fronts_of_a_field_around_grow_from_one_side_to_the_other() -> None:
    """Where the field has no start all is one front: nearly every site has a neighbour before it."""
    for mesh in (torus(), cylinder()):
        field = from_vectors(mesh, 1, np.cross([0.0, 0, 1], mesh.vertices))
        surface = Surface.build(mesh, field, texel=0.1)
        rank = ranks(sweep_order(surface))
        first, second = surface.edges.T
        late = np.zeros(surface.count, bool)
        late[np.where(rank[first] > rank[second], first, second)] = True
        assert (~late).sum() <= 4  # of 1300 sites


def test_a_sweep_of_two_parts_visits_both() -> None:
    mesh = two_parts()
    ranks(sweep_order(Surface.build(mesh, smoothest(mesh, 4), texel=0.1)))


@pytest.mark.parametrize("name", closed_meshes())
def test_no_two_neighbours_are_in_one_part(name: str) -> None:
    mesh = closed_meshes()[name]
    surface = Surface.build(mesh, smoothest(mesh, 4), texel=float(np.sqrt(mesh.face_areas.sum() / 800)))
    parts = colour_parts(surface)
    colour = np.full(surface.count, -1)
    for number, part in enumerate(parts):
        assert len(part) and (colour[part] == -1).all()
        colour[part] = number
    assert colour.min() == 0 and len(parts) <= 9
    first, second = surface.edges.T
    assert (colour[first] != colour[second]).all()
