"""A mesh on the sample itself: the file holds what a viewer and the blending shader need, and nothing is lost."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.output.quilted import thrown
from tests.output.shapes import grid_mesh, sphere
from tests.output.test_textured import animated_glb, stack
from texloom.exemplar.exemplar import Exemplar
from texloom.io.mesh import read_mesh
from texloom.mesh.gltf import accessor, unpack
from texloom.output import material
from texloom.output.blending import REACH, THRESHOLD, edge_errors, neighbours
from texloom.output.sample_uv import blending_attributes, on_sample, sample_uv, usable_maps, write_sample_uv

SHAPE = (16, 16)
SHADER = Path(__file__).parents[2] / "examples" / "10_texton" / "shader"
NAMES = ("_UV_A", "_UV_B", "_UV_C", "_BARY", "_BLEND")


def scene(mesh, texel):
    coordinates = thrown(mesh, SHAPE, texel=texel)
    maps = stack()
    errors = edge_errors(mesh, coordinates, maps["basecolor"].image)
    beside = neighbours(mesh, coordinates)
    return coordinates, maps, errors, beside, blending_attributes(beside, errors, SHAPE)


def attributes_of(path, node=0):
    """Arrays of a node's first primitive at its corners, and the document."""
    document = unpack(path.read_bytes())
    primitive = document.json["meshes"][document.json["nodes"][node]["mesh"]]["primitives"][0]
    corner = accessor(document, primitive["indices"])[:, 0]
    assert len({document.json["accessors"][at]["count"] for at in primitive["attributes"].values()}) == 1
    return {name: accessor(document, at)[corner] for name, at in primitive["attributes"].items()}, document


def _written(writer, path):
    writer(path)
    return path


def test_uvs_are_of_texel_centres():
    uv = sample_uv(np.array([[0, 0], [15, 31], [7.5, 15.5]]), (16, 32))
    np.testing.assert_allclose(uv, [[1 / 64, 31 / 32], [63 / 64, 1 / 32], [0.5, 0.5]])


def test_masked_texels_are_never_shown():
    maps = stack()
    mask = np.zeros((16, 16), bool)
    mask[4:12, 4:12] = True
    found = usable_maps(Exemplar(maps, mask))
    for name, map in maps.items():
        np.testing.assert_array_equal(found[name].image[mask], map.image[mask])
        np.testing.assert_array_equal(found[name].image[0, 0], map.image[4, 4])


def test_a_glb_holds_places_in_the_sample_and_what_blending_needs(tmp_path):
    import pygltflib

    mesh = sphere(5)
    coordinates, maps, errors, beside, further = scene(mesh, 0.15)
    on = on_sample(mesh, coordinates, SHAPE, further=further)
    path = write_sample_uv(tmp_path / "a.glb", None, on, maps, settings={"seed": "1"})[0]
    found, document = attributes_of(path)
    down = np.float32([1, -1]), np.float32([0, 1])
    np.testing.assert_allclose(found["POSITION"].reshape(-1, 3, 3), mesh.vertices[mesh.faces], atol=1e-6)
    shown = found["TEXCOORD_0"].reshape(-1, 3, 2) * 16 - 0.5
    np.testing.assert_allclose(shown[..., ::-1], coordinates, atol=1e-4)
    for k, name in enumerate(NAMES[:3]):
        expected = sample_uv(beside.positions[:, k], SHAPE) * down[0] + down[1]
        np.testing.assert_allclose(found[name].reshape(-1, 3, 2), expected, atol=1e-5)
    np.testing.assert_array_equal(found["_BARY"].reshape(-1, 3, 3), np.tile(np.eye(3), (len(mesh.faces), 1, 1)))
    gain = found["_BLEND"].reshape(-1, 3, 3)
    assert (gain == gain[:, :1]).all()
    np.testing.assert_allclose(np.sort(gain[:, 0].ravel())[1::2], np.sort(errors.mean * errors.length), rtol=1e-5)

    library = pygltflib.GLTF2().load(str(path))
    assert {(s.wrapS, s.wrapT) for s in library.samplers} == {(pygltflib.CLAMP_TO_EDGE, pygltflib.CLAMP_TO_EDGE)}
    assert len(library.images) == len({image.name for image in library.images}) == 4  # the sample's maps, once
    for entry in document.json["accessors"]:
        view = document.json["bufferViews"][entry["bufferView"]]
        assert view["byteOffset"] % 4 == 0 and view.get("byteStride", 4) % 4 == 0
        raw = {key: value for key, value in entry.items() if key != "normalized"}
        values = accessor(type(document)({**document.json, "accessors": [raw]}, document.binary), 0)
        np.testing.assert_array_equal(entry["min"], values.min(axis=0))
        np.testing.assert_array_equal(entry["max"], values.max(axis=0))


def test_a_samples_pictures_are_encoded_once_for_many_meshes(tmp_path, monkeypatch):
    model = read_mesh(_written(animated_glb, tmp_path / "in.glb"), material="hide")
    made, encode = [], material.png_bytes
    monkeypatch.setattr(material, "png_bytes", lambda *args, **kwargs: made.append(1) or encode(*args, **kwargs))

    def files(maps, folder):
        folder.mkdir()
        for mesh, came in ((sphere(5), None), (grid_mesh(2)[0], None), (model.mesh, model)):
            on = on_sample(mesh, thrown(mesh, SHAPE, texel=0.25), SHAPE)
            write_sample_uv(folder / f"{len(mesh.faces)}.glb", came, on, maps)
        return [path.read_bytes() for path in sorted(folder.iterdir())]

    stacked = stack()
    stacked["alpha"] = stacked["roughness"]
    stacked["emissive"] = stacked["basecolor"]
    maps = usable_maps(Exemplar(stacked))
    once = files(maps, tmp_path / "once")
    assert len(made) == 5 and len(once) == 3  # with alpha, packed, normal, emissive, height
    assert once == files(stacked, tmp_path / "plain") and len(made) == 4 * 5
    assert list(maps) == list(stacked)


def test_tangents_run_along_the_samples_columns():
    mesh = grid_mesh(2)[0]
    on = on_sample(mesh, thrown(mesh, SHAPE, texel=0.06), SHAPE)
    assert on.tangents is not None and (on.tangents[..., 3] == 1).all()
    uv = on.uv.astype(np.float64)
    for face, corners in enumerate(mesh.vertices[mesh.faces]):
        sides = np.array([corners[1] - corners[0], corners[2] - corners[0]])
        steps = np.array([uv[face, 1] - uv[face, 0], uv[face, 2] - uv[face, 0]])
        along_u = np.linalg.solve(steps, sides)[0]
        np.testing.assert_allclose(on.tangents[face, 0, :3], along_u / np.linalg.norm(along_u), atol=1e-4)


def test_corners_share_vertices_where_nothing_tells_them_apart(tmp_path):
    mesh = grid_mesh(3)[0]
    one_map = (mesh.vertices[:, [1, 0]][mesh.faces] * [-10, 10] + [12, 2]).astype(np.float32)
    path = write_sample_uv(tmp_path / "a.glb", None, on_sample(mesh, one_map, SHAPE), stack())[0]
    document = unpack(path.read_bytes())
    attributes = document.json["meshes"][0]["primitives"][0]["attributes"]
    assert document.json["accessors"][attributes["POSITION"]]["count"] == len(mesh.vertices)
    assert not set(NAMES) & set(attributes)


@pytest.mark.parametrize("blending", [False, True])
def test_a_glb_that_came_in_keeps_what_it_had(tmp_path, blending):
    before = unpack(animated_glb(tmp_path / "in.glb"))
    model = read_mesh(tmp_path / "in.glb", material="hide")
    coordinates, maps, _, _, further = scene(model.mesh, 0.25)
    on = on_sample(model.mesh, coordinates, SHAPE, further=further if blending else None)
    path = write_sample_uv(tmp_path / "out.glb", model, on, maps)[0]
    _, after = attributes_of(path)
    assert after.binary[: len(before.binary)] == before.binary
    for entry in after.json["accessors"]:
        assert after.json["bufferViews"][entry["bufferView"]]["byteOffset"] % 4 == 0
    for kind in ("animations", "skins", "scenes"):
        assert after.json[kind] == before.json[kind]
    old = before.json["meshes"][0]["primitives"][0]
    corner = accessor(before, old["indices"])[:, 0]
    for node, faces in enumerate(np.split(np.arange(len(coordinates)), 2)):
        found, _ = attributes_of(path, node)
        for name in ("POSITION", "NORMAL", "JOINTS_0", "WEIGHTS_0"):
            np.testing.assert_array_equal(found[name], accessor(before, old["attributes"][name])[corner])
        shown = found["TEXCOORD_0"].reshape(-1, 3, 2)[..., ::-1] * 16 - 0.5
        np.testing.assert_allclose(shown, coordinates[faces], atol=1e-4)
        assert (set(NAMES) <= set(found)) == blending
        if blending:
            np.testing.assert_allclose(found["_UV_B"].reshape(-1, 3, 2), further["_UV_B"][faces])
            np.testing.assert_allclose(found["_BLEND"].reshape(-1, 3, 3), further["_BLEND"][faces])
            np.testing.assert_array_equal(found["_BARY"].reshape(-1, 3, 3)[:, 1], np.tile([0, 1, 0], (len(faces), 1)))


def test_an_obj_shows_places_in_the_sample(tmp_path):
    import trimesh

    mesh = grid_mesh(2)[0]
    coordinates = thrown(mesh, SHAPE, texel=0.06)
    write_sample_uv(tmp_path / "a.obj", None, on_sample(mesh, coordinates, SHAPE), stack())
    found = trimesh.load(tmp_path / "a.obj", process=False)
    np.testing.assert_allclose(found.visual.uv[found.faces], sample_uv(coordinates, SHAPE), atol=1e-6)
    assert "map_Kd -clamp on a-basecolor.png" in (tmp_path / "a.mtl").read_text()


def test_the_shader_says_what_the_bake_does():
    fragment, vertex = ((SHADER / name).read_text() for name in ("blend.frag", "blend.vert"))
    page = (SHADER / "view.html").read_text()
    assert float(re.search(r"REACH = ([\d.]+)", fragment)[1]) == REACH
    assert float(re.search(r'"threshold", (\d+)', page)[1]) == THRESHOLD
    assert all(re.search(rf"\b{name}\b", vertex) for name in (*NAMES, "POSITION", "TEXCOORD_0", "TANGENT"))


def test_the_shader_finds_the_middle_of_an_edge_from_differences_between_pixels():
    """The fragment shader's arithmetic, in perspective: three pixels of a face give its corners back."""
    rng = np.random.default_rng(2)
    corners = rng.normal(size=(3, 3)) + [0, 0, 6]  # the eye at the origin

    def seen(x, y):
        """Corner weights and place behind a pixel: where its ray meets the face."""
        weights = np.linalg.solve(np.concatenate([corners.T], axis=0), [x, y, 1.0])
        weights /= weights.sum()
        return weights, weights @ corners

    middle_x, middle_y = (corners.mean(0) / corners.mean(0)[2])[:2]
    (b, place), (right, place_x), (below, place_y) = (
        seen(middle_x + dx, middle_y + dy) for dx, dy in ((0, 0), (1e-3, 0), (0, 1e-3))
    )
    bx, by, dx, dy = right - b, below - b, place_x - place, place_y - place
    area = bx[0] * by[1] - bx[1] * by[0]
    to_0, to_1 = (dx * by[1] - dy * bx[1]) / area, (dy * bx[0] - dx * by[0]) / area
    for k in range(3):
        way = 0.5 - b
        way[k] = -b[k]
        found = place + way[0] * to_0 + way[1] * to_1
        np.testing.assert_allclose(found, (corners[(k + 1) % 3] + corners[(k + 2) % 3]) / 2, atol=1e-6)
