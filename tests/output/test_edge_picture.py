"""The picture of edge errors: bad edges stand out in their colour, good ones are not there, no face is lost."""

import numpy as np
import pytest

from tests.output.quilted import continued, thrown
from tests.output.shapes import grid_mesh, sphere
from texloom.exemplar.exemplar import Map
from texloom.output.blending import edge_errors
from texloom.output.edge_picture import _drawn, edge_picture

SHAPE = (40, 40)


def grey_and_noise():
    image = np.full((*SHAPE, 3), 0.4, np.float32)
    return image, np.random.default_rng(0).random((*SHAPE, 3), dtype=np.float32)


def colourful(picture):
    """Share of pixels with a hue, the legend left out."""
    return float((np.ptp(picture[: 2 * 96].astype(int), axis=2) > 40).mean())


def test_bad_edges_are_coloured_and_perfect_ones_are_not():
    mesh = grid_mesh(4)[0]
    image, noise = grey_and_noise()
    coordinates = continued(mesh, 18.0)
    good = edge_picture(
        mesh, coordinates, edge_errors(mesh, coordinates, noise), sample=Map(image, "colour", 8), size=96
    )
    apart = thrown(mesh, SHAPE, texel=0.02)
    bad = edge_picture(mesh, apart, edge_errors(mesh, apart, noise), sample=Map(image, "colour", 8), size=96)
    assert good.shape == bad.shape and good.shape[1] == 2 * 96
    assert colourful(good) == 0 < 0.02 < colourful(bad)
    legend = good[2 * 96 :].astype(int)
    assert (np.ptp(legend, axis=2) > 40).mean() > 0.05 and (legend.sum(2) < 300).mean() > 0.01


@pytest.mark.parametrize("width", [0.01, 0.2])
def test_the_pieces_are_the_faces(width):
    mesh = sphere(6)
    error = np.random.default_rng(4).uniform(-20, 60, mesh.faces.shape).clip(0).astype(np.float32)
    drawn = _drawn(mesh, error, width, 0.02)
    places = np.einsum("pcb,pbi->pci", drawn.corners, mesh.vertices[mesh.faces[drawn.parent]])
    area = 0.5 * np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1)
    np.testing.assert_allclose(np.bincount(drawn.parent, area), mesh.face_areas, rtol=1e-6)
    assert np.isclose(drawn.error.max(), error.max())


def test_faces_under_a_pixel_take_their_worst_edge():
    mesh = sphere(6)
    error = np.tile(np.float32([10, 30, 20]), (len(mesh.faces), 1))
    drawn = _drawn(mesh, error, 0.5, 10.0)
    assert len(drawn.parent) == len(mesh.faces) and (drawn.error == 30).all()
