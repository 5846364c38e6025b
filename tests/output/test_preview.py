"""Pictures of meshes: visibility against a naive z-buffer, shape of the result, and that light behaves."""

import numpy as np

from tests.output.shapes import grid_mesh, sphere
from texloom.kernels.launch import launch
from texloom.kernels.raster import draw_rows
from texloom.output.camera import Camera, project
from texloom.output.preview import Skin, preview
from texloom.output.rows import face_rows


def test_the_closest_face_is_seen():
    rng = np.random.default_rng(0)
    corners, close = rng.uniform(-2, 22, (25, 3, 2)), rng.random((25, 3)).astype(np.float32)
    rows = face_rows(corners, 20)
    visible, depth = np.empty((20, 20), np.int32), np.empty((20, 20), np.float32)
    launch(draw_rows, 20, inputs=[*rows.arrays, close], outputs=[visible, depth])
    for row in range(20):
        for column in range(20):
            best, face = -1.0, -1
            for f, triangle in enumerate(rows.corners):
                weights = np.linalg.solve(np.vstack([triangle.T, np.ones(3)]), [column, row, 1])
                if (weights >= 0).all() and weights @ close[f] > best:
                    best, face = weights @ close[f], f
            assert visible[row, column] == face


def test_a_mesh_fills_the_picture_from_every_side():
    mesh = sphere()
    for azimuth in (0.0, 77.0):
        for field_of_view in (0.0, 30.0):
            view = project(mesh.vertices, Camera(azimuth=azimuth, field_of_view=field_of_view), 100)
            low, high = view.screen.min(axis=0), view.screen.max(axis=0)
            assert low.min() >= 5 and high.max() <= 95 and (high - low).max() > 87
            assert (view.distance > 0).all()


def test_views_are_laid_out_and_the_same_every_time():
    mesh = sphere()
    white = Skin(colours=np.full((len(mesh.vertices), 3), 0.8, np.float32))
    picture = preview(mesh.vertices, mesh.faces, white, normals=mesh.vertex_normals, size=48)
    assert picture.shape == (96, 96, 3) and picture.dtype == np.uint8
    again = preview(mesh.vertices, mesh.faces, white, normals=mesh.vertex_normals, size=48)
    np.testing.assert_array_equal(picture, again)
    assert preview(mesh.vertices, mesh.faces, white, normals=mesh.vertex_normals, size=32, views=3).shape == (32, 96, 3)


def test_the_key_light_comes_from_the_upper_left():
    mesh = sphere(24)
    skin = Skin(colours=np.full((len(mesh.vertices), 3), 0.5, np.float32), gloss=0.0)
    picture = preview(mesh.vertices, mesh.faces, skin, normals=mesh.vertex_normals, size=64, views=1).astype(int)
    assert picture[20, 20].sum() > picture[32, 50].sum() > 0
    assert picture[20, 20].sum() > picture[50, 44].sum()


def test_a_texture_is_seen_upright_and_unmirrored():
    mesh, uv = grid_mesh(2)
    texture = np.zeros((8, 8, 3), np.float32)
    texture[:4, :4, 0] = texture[:4, 4:, 1] = texture[4:, :4, 2] = 1.0
    camera = Camera(azimuth=0.0, elevation=0.0)
    skin = Skin(texture=texture, uv=uv, gloss=0.0)
    normals = np.tile([0.0, 0, 1], (9, 1))
    picture = preview(mesh.vertices, mesh.faces, skin, normals=normals, size=64, views=[camera])
    assert [int(picture[r, c].argmax()) for r, c in ((16, 16), (16, 48), (48, 16))] == [0, 1, 2]
    assert picture[48, 48].max() < 30
