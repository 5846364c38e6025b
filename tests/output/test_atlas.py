"""Atlases: the rasteriser against a naive one, a baked plane against its exemplar, normals in the atlas's frame."""

import numpy as np
import pytest

from tests.output.shapes import flat_surface, grid_mesh
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Map
from texloom.kernels import raster as kernels
from texloom.kernels.launch import launch
from texloom.output.atlas import bake, lay_atlas
from texloom.output.rows import face_rows
from texloom.output.tangents import corner_tangents
from texloom.sources import SourceMap


def cross(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def naive_owner(corners, rows, columns):
    owner = np.full((rows, columns), -1)
    for row in range(rows):
        for column in range(columns):
            for face, (a, b, c) in enumerate(corners):
                area, p = cross(a, b, c), (column, row)
                sides = np.sign(area) * np.array([cross(b, c, p), cross(c, a, p), cross(a, b, p)])
                if area != 0 and (sides >= 0).all():
                    owner[row, column] = face
                    break
    return owner


def owners(corners, size, reach):
    rows = face_rows(corners, size, reach=reach)
    owner, gap = np.empty((size, size), np.int32), np.empty((size, size), np.float32)
    launch(kernels.own_texels, size, inputs=[*rows.arrays, reach], outputs=[owner, gap])
    return owner


def test_the_lowest_face_over_a_texel_owns_it():
    corners = np.random.default_rng(0).integers(-3 * 256, 20 * 256, (40, 3, 2)) / 256
    corners[:8] = np.round(corners[:8])  # edges through centres, and shared corners
    corners[8] = corners[9]
    np.testing.assert_array_equal(owners(corners, 18, 0.0), naive_owner(corners, 18, 18))


def test_faces_that_share_edges_leave_no_gap():
    mesh, _ = grid_mesh(7, 13.37)
    assert (owners(mesh.vertices[mesh.faces][..., :2], 13, 0.0) >= 0).all()


def test_a_sliver_between_centres_still_owns_the_texels_it_touches():
    sliver = np.array([[[1.3, 2.4], [6.7, 2.4], [6.7, 2.45]]])
    assert (owners(sliver, 10, 0.0) < 0).all()
    assert (owners(sliver, 10, 0.7072)[2, 2:7] == 0).all()


@pytest.mark.parametrize("turn", [0.0, 0.9, -2.5])
def test_a_plane_shows_the_exemplar_as_an_image_does(turn):
    """Sites that hold one continuous picture bake to that picture, whatever the direction field."""
    size = 32
    mesh, uv = grid_mesh(8, float(size))
    surface = flat_surface(mesh, 1.0, turn)
    rng = np.random.default_rng(1)
    image = rng.random((size, size, 3), dtype=np.float32)
    x, y = mesh.vertices[:, 0] - 0.5, size - mesh.vertices[:, 1] - 0.5
    position = np.stack([y, x], axis=1)[:, None].astype(np.float32)
    turns = np.full((len(x), 1), -turn, np.float32)
    sources = SourceMap(position, np.ones((len(x), 1), np.float32), turns)
    atlas = lay_atlas(surface, uv, size=size, gutter=0)
    found = bake(sources, atlas, {"a": Map(image, "data", 8)})["a"].image
    np.testing.assert_allclose(found, image, atol=2e-4)


@pytest.mark.parametrize("field", [0.0, 1.1])
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("spin", [0.0, 0.7])
def test_baked_normals_mean_the_same_direction_in_the_world(field, mirrored, spin):
    mesh, uv = grid_mesh(3)
    uv = uv - 0.5
    uv = 0.6 * np.stack([uv @ [np.cos(spin), -np.sin(spin)], uv @ [np.sin(spin), np.cos(spin)]], axis=2)
    uv = (uv * [-1 if mirrored else 1, 1] + 0.5).astype(np.float32)
    normals = np.tile([0.0, 0.0, 1.0], (*mesh.faces.shape, 1))
    tangents = corner_tangents(mesh.vertices, mesh.faces, uv, normals=normals)
    surface = flat_surface(mesh, 1.0, field)
    vector = np.array([0.48, 0.6, 0.64])
    map = Map(np.full((4, 4, 3), 0.5 * vector + 0.5, np.float32), "normal", 8)
    count = len(mesh.vertices)
    sources = SourceMap(np.zeros((count, 1, 2), np.float32), np.ones((count, 1), np.float32))
    atlas = lay_atlas(surface, uv, size=24, gutter=2, tangents=tangents)
    baked = 2 * bake(sources, atlas, {"normal": map})["normal"].image[12, 12] - 1
    tangent, hand = tangents[0, 0, :3], tangents[0, 0, 3]
    world = baked[0] * tangent + baked[1] * hand * np.cross([0, 0, 1], tangent) + baked[2] * np.array([0, 0, 1])
    right = np.array([np.cos(field), np.sin(field), 0])
    expected = vector[0] * right + vector[1] * np.cross([0, 0, 1], right) + vector[2] * np.array([0, 0, 1])
    assert hand == (-1 if mirrored else 1)
    np.testing.assert_allclose(world, expected, atol=1e-5)


def test_uvs_outside_the_unit_square_wrap():
    mesh, uv = grid_mesh(4, 16.0)
    surface, gradient = flat_surface(mesh, 1.0), np.random.default_rng(2).random((16, 16, 1), dtype=np.float32)
    position = np.stack([15.5 - mesh.vertices[:, 1], mesh.vertices[:, 0] - 0.5], axis=1)[:, None].astype(np.float32)
    sources = SourceMap(position, np.ones((len(position), 1), np.float32))
    maps = {"a": Map(gradient, "data", 8)}
    plain = bake(sources, lay_atlas(surface, uv, size=16, gutter=0), maps)["a"].image
    moved = bake(sources, lay_atlas(surface, uv + np.float32([3.5, -0.25]), size=16, gutter=0), maps)["a"].image
    np.testing.assert_allclose(moved, np.roll(plain, (4, 8), axis=(0, 1)), atol=1e-4)


def test_normal_maps_without_tangents_and_odd_sizes_are_refused():
    mesh, uv = grid_mesh(2)
    surface = flat_surface(mesh, 1.0)
    sources = SourceMap(np.zeros((9, 1, 2), np.float32), np.ones((9, 1), np.float32))
    map = Map(np.full((4, 4, 3), 0.5, np.float32), "normal", 8)
    with pytest.raises(ParameterError, match="tangents"):
        bake(sources, lay_atlas(surface, uv, size=8), {"normal": map})
    with pytest.raises(ParameterError, match="0 texels"):
        lay_atlas(surface, uv, size=0)
