"""Fresh atlases: nothing overlaps, nothing folds, charts keep their distance and their scale."""

import numpy as np
import pytest
from scipy.ndimage import binary_dilation, label

from tests.output.shapes import grid_mesh, sphere
from texloom.mesh.mesh import Mesh
from texloom.output.charts import FaceGraph, grow_charts
from texloom.output.unwrap import unwrap, unwrap_large
from texloom.output.uv import covers_of, diagnose_uv


def helix(turns: int = 3, steps: int = 40) -> Mesh:
    """A ramp that winds over itself: every face looks up, so only the overlap tells."""
    t = np.linspace(0, 2 * np.pi * turns, turns * steps)
    inner = np.stack([np.cos(t), 0.1 * t, -np.sin(t)], axis=1)
    outer = inner * [2, 1, 2]
    a = np.arange(len(t) - 1)
    n = len(t)
    faces = np.concatenate([np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)])
    return Mesh(np.concatenate([inner, outer]), faces.astype(np.int32))


@pytest.mark.parametrize("make", [unwrap, unwrap_large])
@pytest.mark.parametrize("mesh", [sphere(12), helix(), grid_mesh(6)[0]], ids=["sphere", "helix", "square"])
def test_a_fresh_atlas_is_usable(make, mesh):
    uv = make(mesh, size=256, gutter=4)
    found = diagnose_uv(uv)
    assert uv.shape == (len(mesh.faces), 3, 2) and found.usable and found.outside == 0, str(found)


def test_charts_look_one_way_and_a_square_is_one_chart():
    mesh = sphere(16)
    chart = grow_charts(FaceGraph(mesh))
    assert 4 <= chart.max() + 1 <= 16
    for number in range(chart.max() + 1):
        normals = mesh.face_normals[chart == number]
        axis = (normals * mesh.face_areas[chart == number][:, None]).sum(axis=0)
        assert (normals @ axis >= 0.5 * np.linalg.norm(axis) - 1e-9).all()
    assert grow_charts(FaceGraph(grid_mesh(5)[0])).max() == 0


def test_large_charts_are_never_mirrored_and_keep_one_scale():
    mesh = grid_mesh(6, 3.0)[0]
    uv = unwrap_large(mesh, size=256, gutter=4).astype(float)
    first, second = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    np.testing.assert_allclose(area / (2 * mesh.face_areas), area[0] / (2 * mesh.face_areas[0]), rtol=1e-4)
    assert (area > 0).all()


def test_charts_keep_the_gutter_between_them():
    size, gutter = 512, 8
    covered = covers_of(unwrap_large(sphere(16), size=size, gutter=gutter), size)[0] > 0
    apart = label(covered, np.ones((3, 3)))[1]
    grown = binary_dilation(covered, np.ones((3, 3)), iterations=gutter // 2 - 1)
    assert label(grown, np.ones((3, 3)))[1] == apart > 4
