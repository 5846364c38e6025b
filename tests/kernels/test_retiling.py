"""Splits refused where a face would oppose the ground."""

import numpy as np
import pytest

from texloom.kernels.launch import launch
from texloom.kernels.retiling import split_edges
from texloom.mesh.mesh import Mesh
from texloom.points.tiling import any_halfedge

DIAMOND = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.8, 0], [0.5, -0.8, 0]], np.float64)
FACES = np.array([[0, 1, 2], [1, 0, 3]], np.int32)


def splits(edge: int, at: tuple[float, float, float], *, anyhow: bool) -> int:
    """How many points a split at ``at`` puts on a halfedge of two faces that lie flat."""
    points = np.concatenate([DIAMOND, [at]])
    tails = np.concatenate([FACES, np.full((2, 3), -1, np.int32)]).reshape(-1)
    twins = np.concatenate([Mesh(DIAMOND, FACES).twins, np.full(6, -1, np.int32)])
    first = np.append(any_halfedge(FACES, 4), np.int32(-1))
    normals, rim, count = np.tile([0.0, 0.0, 1.0], (5, 1)), np.ones(5, np.int32), np.zeros(2, np.int32)
    places = {"at": points, "normal": normals, "scale": np.ones(5)}
    net = {"tail": tails, "twin": twins, "first": first, "rim": rim}
    inputs = [np.array([edge], np.int32), 1, 4, 2, anyhow, places, 0.0]
    launch(split_edges, 1, inputs=inputs, outputs=[np.empty(4096, np.int32), net, count])
    return int(count[0])


@pytest.mark.parametrize(("at", "fits"), [((0.5, 0, 0), True), ((0.5, 1.2, 0), False), ((-0.5, 0.1, 0), False)])
def test_an_edge_is_cut_where_its_faces_stay_upright(at: tuple[float, float, float], fits: bool) -> None:
    assert splits(0, at, anyhow=False) == fits
    assert splits(0, at, anyhow=True) == 1


def test_the_rim_is_cut_whatever_comes_of_it() -> None:
    assert splits(1, (0.2, -0.3, 0), anyhow=False) == 1
