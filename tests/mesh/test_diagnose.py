import numpy as np
import pytest

from tests.meshes import all_meshes, as_mesh, joined, sphere, torus
from texloom.mesh.diagnose import diagnose

SHAPES = {  # parts, boundary loops, Euler characteristic, genus
    "sphere": (1, 0, 2, 0),
    "torus": (1, 0, 0, 1),
    "octahedron": (1, 0, 2, 0),
    "tetrahedron": (1, 0, 2, 0),
    "flat_square": (1, 1, 1, 0),
    "cone": (1, 1, 1, 0),
    "cylinder": (1, 2, 0, 0),
    "single_triangle": (1, 1, 1, 0),
    "slivers": (1, 1, 1, 0),
    "obtuse": (1, 1, 1, 0),
    "two_parts": (2, 1, 3, 0),
    "tiny_far": (1, 0, 2, 0),
}


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_are_told_by_counting(name):
    found = diagnose(all_meshes()[name])
    assert (found.parts, found.boundary_loops, found.euler, found.genus) == SHAPES[name]
    assert found.manifold and found.oriented
    assert found.closed == (found.boundary_loops == 0)


def test_handles_of_all_parts_add_up():
    assert diagnose(joined(torus(8, 6), sphere(1), torus(8, 6))).genus == 2


def test_what_is_wrong_is_counted():
    crowded = diagnose(as_mesh(np.eye(5, 3), [[0, 1, 2], [1, 0, 3], [0, 1, 4]]))
    assert (crowded.crowded_edges, crowded.manifold, crowded.genus) == (1, False, None)
    bowtie = diagnose(as_mesh(np.eye(5, 3), [[0, 1, 2], [0, 3, 4]]))
    assert (bowtie.bowtie_vertices, bowtie.manifold, bowtie.parts) == (1, False, 1)
    turned = diagnose(as_mesh(np.eye(4, 3), [[0, 1, 2], [0, 1, 3]]))
    assert (turned.oriented, turned.manifold, turned.genus) == (False, True, None)


def test_sizes():
    found = diagnose(all_meshes()["slivers"])
    assert found.size == pytest.approx((1, 1e-3, 0))
    assert found.slivers == 72
    assert found.area == pytest.approx(1e-3)
