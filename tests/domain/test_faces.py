"""Faces laid flat in texels: similar to what they are on the surface, along the field, each patch in one plane."""

import numpy as np
import pytest
from numpy import ndarray

from tests.meshes import all_meshes, as_mesh, flat_square, joined, octahedron, shifted, single_triangle, sphere, torus
from texloom.domain.faces import Faces
from texloom.errors import FieldError, ParameterError
from texloom.field.direction import ORDERS, DirectionField, from_constant
from texloom.field.smooth import smoothest
from texloom.mesh.mesh import Mesh

MESHES = all_meshes()
X = np.array([1.0, 0, 0])


def texel_of(mesh: Mesh, across: float = 12.0) -> float:
    """So long that the longest edge has about so many."""
    return float(mesh.edge_lengths.max()) / across


def offsets(mesh: Mesh, field: DirectionField, vectors: ndarray) -> ndarray:
    """(face, corner) vectors in space as column + 1j * row, in world units: the convention in so many words."""
    power = field.power.astype(complex).mean(1)
    angle = np.angle(power) / field.order
    x, y = mesh.face_frames[:, 0], mesh.face_frames[:, 1]
    along = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
    up = np.cross(mesh.face_normals, along)
    return np.einsum("fcd,fd->fc", vectors, along) - 1j * np.einsum("fcd,fd->fc", vectors, up)


def sides(corners: ndarray) -> ndarray:
    """From each corner to the next."""
    return np.roll(corners, -1, axis=1) - corners


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("name", MESHES)
def test_a_face_lies_flat_along_the_field(name, order):
    mesh = MESHES[name]
    field, texel = smoothest(mesh, order), texel_of(mesh)
    faces = Faces.build(mesh, field, texel=texel)
    expected = offsets(mesh, field, sides(mesh.vertices[mesh.faces])) / texel
    np.testing.assert_allclose(sides(faces.layout), expected, atol=1e-4)
    np.testing.assert_allclose(faces.layout.mean(1), 0, atol=1e-4)
    turned = np.imag(np.conj(sides(faces.layout)[:, 0]) * sides(faces.layout)[:, 1])
    assert (turned[mesh.face_areas > 1e-3 * mesh.face_areas.max()] < 0).all()  # rows run down: corners run clockwise
    assert faces.count == len(mesh.faces) and (faces.patch == np.arange(faces.count)).all()
    assert faces.order == order and faces.refined is None


def test_columns_run_along_the_direction_and_rows_down():
    square = flat_square(3, size=6.0)
    corner = square.vertices[square.faces]
    for direction, expected in [
        ([1, 0, 0], corner[..., 0] - 1j * corner[..., 1]),
        ([0, 1, 0], corner[..., 1] + 1j * corner[..., 0]),
    ]:
        faces = Faces.build(square, from_constant(square, 1, np.array(direction, float)), texel=0.5)
        np.testing.assert_allclose(sides(faces.layout), sides(expected) / 0.5, atol=1e-5)


def test_a_scale_makes_faces_smaller_in_the_sample():
    mesh = sphere(2)
    scale = np.exp(mesh.vertices[:, 0])
    field = smoothest(mesh, 2)
    plain = Faces.build(mesh, field, texel=0.1)
    scaled = Faces.build(mesh, field, texel=0.1, scale=scale)
    np.testing.assert_allclose(scaled.layout * scale[mesh.faces].mean(1)[:, None], plain.layout, rtol=1e-5)


def test_a_face_without_a_direction_lies_somehow():
    mesh = single_triangle()
    faces = Faces.build(mesh, DirectionField(4, np.zeros((1, 3), np.complex64)), texel=0.1)
    np.testing.assert_allclose(np.abs(sides(faces.layout)), [[10, np.sqrt(200), 10]], rtol=1e-6)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("width", [None, 30.0], ids=["faces", "groups"])
def test_rims_and_bounds_are_those_of_plain_loops(name, width):
    mesh = MESHES[name]
    faces = Faces.build(mesh, smoothest(mesh, 4), texel=texel_of(mesh), width=width)
    start, rim = faces.rim
    for p in range(faces.count):
        mine = [3 * f + c for f in np.flatnonzero(faces.patch == p) for c in range(3)]
        mine = [h for h in mine if mesh.twins[h] >= 0 and faces.patch[mesh.twins[h] // 3] != p]
        here = slice(start[p], start[p + 1])
        assert rim[here].tolist() == mine
        assert faces.across[here].tolist() == [faces.patch[mesh.twins[h] // 3] for h in mine]
        ends = [(faces.layout[h // 3, h % 3], faces.layout[h // 3, (h + 1) % 3 if h % 3 < 2 else 0]) for h in mine]
        np.testing.assert_allclose(faces.border_length[here], [abs(b - a) for a, b in ends], rtol=1e-4, atol=1e-6)
        corners = faces.layout[faces.patch == p].ravel()
        for b, turn in enumerate([1, 1j, -1, -1j]):
            there = turn * corners
            np.testing.assert_allclose(faces.bounds[0][p, b], [there.real.min(), there.imag.min()], atol=1e-4)
            np.testing.assert_allclose(faces.bounds[1][p, b], [there.real.max(), there.imag.max()], atol=1e-4)


@pytest.mark.parametrize("order", ORDERS)
def test_the_origin_is_inside_a_patch_however_it_is_turned(order):
    mesh = joined(torus(20, 10), shifted(flat_square(5), (4, 0, 0)))
    faces = Faces.build(mesh, smoothest(mesh, order), texel=0.02, width=20.0)
    assert faces.count < len(mesh.faces)
    least, greatest = faces.bounds
    assert least.shape == (faces.count, order, 2) and (least < 0).all() and (greatest > 0).all()


def test_a_patch_of_several_faces_has_one_place_a_vertex():
    mesh = sphere(3)
    faces = Faces.build(mesh, smoothest(mesh, 2), texel=0.02, width=24.0, seed=3)
    assert faces.count < len(mesh.faces) / 2
    assert sorted(set(faces.patch)) == list(range(faces.count))
    for p in range(faces.count):
        place: dict[int, complex] = {}
        for f in np.flatnonzero(faces.patch == p):
            for vertex, at in zip(mesh.faces[f], faces.layout[f], strict=True):
                assert place.setdefault(int(vertex), at) == at
    other = Faces.build(mesh, smoothest(mesh, 2), texel=0.02, width=24.0, seed=4)
    assert other.count != faces.count or (other.patch != faces.patch).any()


def test_a_patch_that_closes_on_itself_has_no_rim_there():
    closed = torus(12, 6)
    faces = Faces.build(closed, smoothest(closed, 1), texel=0.05)
    whole = Faces(
        faces.mesh, faces.field, faces.texel, faces.scale, np.zeros(len(closed.faces), np.int32), faces.layout
    )
    assert whole.count == 1 and len(whole.rim[1]) == 0 and whole.rim[0].tolist() == [0, 0]


@pytest.mark.parametrize("scaled", [False, True], ids=["plain", "scaled"])
def test_faces_are_split_until_no_side_is_longer(scaled):
    mesh = octahedron()
    power = np.exp(1j * np.random.default_rng(0).random((8, 1)) * 6)  # one direction a face
    field = DirectionField(2, np.repeat(power, 3, axis=1).astype(np.complex64))
    scale = np.array([1.0, 1, 1, 1, 8, 0.5]) if scaled else None
    whole = Faces.build(mesh, field, texel=0.05, scale=scale)
    faces = Faces.build(mesh, field, texel=0.05, scale=scale, most=7.0)
    assert np.abs(sides(whole.layout)).max() > 7 >= np.abs(sides(faces.layout)).max() - 1e-4
    refined = faces.refined
    assert refined is not None and refined.mesh is faces.mesh
    home = np.einsum("fcb,fbd->fcd", refined.corner_barycentric, mesh.vertices[mesh.faces][refined.parent])
    np.testing.assert_allclose(home, faces.mesh.vertices[faces.mesh.faces], atol=1e-6)
    if not scaled:  # a child lies in its parent's plane as its parent does, the other way round or not
        inside = np.einsum("fcb,fb->fc", refined.corner_barycentric, whole.layout[refined.parent])
        np.testing.assert_allclose((sides(inside) / sides(faces.layout)) ** 2, 1, atol=1e-3)


def test_a_scale_is_carried_to_split_faces():
    square = flat_square(1, size=1.0)
    scale = 1 + square.vertices[:, 0]
    faces = Faces.build(square, from_constant(square, 1, X), texel=0.01, scale=scale, most=9.0)
    corner = faces.mesh.vertices[faces.mesh.faces]
    length = 0.01 * (1 + corner[..., 0].mean(1))
    expected = sides(corner[..., 0] - 1j * corner[..., 1]) / length[:, None]
    np.testing.assert_allclose(sides(faces.layout), expected, rtol=1e-4, atol=1e-4)


def test_nothing_is_split_where_all_is_small():
    mesh = flat_square(4)
    faces = Faces.build(mesh, from_constant(mesh, 1, X), texel=0.1, most=4.0)
    assert faces.mesh is mesh and faces.refined is None


def test_a_mesh_that_falls_apart_has_patches_without_a_rim():
    mesh = as_mesh(np.random.default_rng(0).normal(size=(12, 3)), np.arange(12).reshape(4, 3))
    faces = Faces.build(mesh, smoothest(mesh, 1), texel=0.3)
    assert faces.count == 4 and faces.rim[0].tolist() == [0] * 5
    assert len(faces.across) == len(faces.border_length) == 0


@pytest.mark.parametrize(
    "wrong, message",
    [
        ({"texel": 0.0}, "a texel of 0 world units"),
        ({"texel": float("nan")}, "a texel of nan world units"),
        ({"width": 0.0}, "groups 0 texels wide"),
        ({"most": 0.0}, "faces split to sides of 0 texels"),
        ({"most": float("nan")}, "faces split to sides of nan texels"),
    ],
)
def test_lengths_are_checked(wrong, message):
    mesh = flat_square(2)
    with pytest.raises(ParameterError, match=message):
        Faces.build(mesh, from_constant(mesh, 1, X), **({"texel": 0.1} | wrong))


@pytest.mark.parametrize("scale", [np.zeros(9), np.full(9, np.nan), np.ones(8)])
def test_scales_are_checked(scale):
    mesh = flat_square(2)
    with pytest.raises(FieldError, match="scales"):
        Faces.build(mesh, from_constant(mesh, 1, X), texel=0.1, scale=scale)
