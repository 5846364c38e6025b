"""Meshes with maps: what is written is what other readers find; a GLB comes back with all else as it was."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from tests.output.shapes import flat_surface, grid_mesh
from texloom.exemplar.exemplar import Exemplar, Map, to_map
from texloom.io.mesh import read_mesh
from texloom.mesh.gltf import Document, accessor, pack, unpack
from texloom.output.draft import Draft
from texloom.output.gather import gather_sites
from texloom.output.retexture import retextured_glb
from texloom.output.textured import TexturedMesh, write_textured
from texloom.output.vertex_colours import write_vertex_colours
from texloom.sources import SourceMap

RNG = np.random.default_rng(5)


def stack(size=16):
    def values(channels, depth=np.uint8):
        return RNG.integers(0, np.iinfo(depth).max, (size, size, channels)).astype(depth)

    return {
        "basecolor": to_map(values(3), "colour"),
        "normal": to_map(values(3), "normal"),
        "roughness": to_map(values(1), "data"),
        "ao": to_map(values(1, np.uint16), "data"),
        "height": to_map(values(1), "data"),
    }


def textured_square():
    mesh, uv = grid_mesh(3)
    normals, tangents = np.tile([0.0, 0, 1], (16, 1)), np.tile([1.0, 0, 0, 1], (18, 3, 1))
    return TexturedMesh(vertices=mesh.vertices, faces=mesh.faces, normals=normals, uv=uv, tangents=tangents)


def test_a_glb_is_read_by_others_as_it_was_written(tmp_path):
    import trimesh

    mesh, maps = textured_square(), stack()
    path = write_textured(tmp_path / "a.glb", mesh, maps, settings={"seed": "7"})[0]
    found = trimesh.load(path, force="mesh", process=False)
    np.testing.assert_allclose(found.triangles, mesh.vertices[mesh.faces], atol=1e-7)
    np.testing.assert_allclose(found.visual.uv[found.faces], mesh.uv, atol=1e-6)
    material = found.visual.material
    colour = np.rint(255 * _encoded(maps["basecolor"])).astype(np.uint8)
    np.testing.assert_array_equal(np.asarray(material.baseColorTexture.convert("RGB")), colour)
    roughness = np.asarray(material.metallicRoughnessTexture)
    assert roughness.shape == (16, 16, 3)
    np.testing.assert_allclose(roughness[..., 1] / 255, maps["roughness"].image[..., 0], atol=1 / 255)
    assert (roughness[..., 2] == 0).all() and material.normalTexture is not None


def _encoded(map: Map):
    from texloom.exemplar.colour import encode

    return encode(map.image)


def test_the_gltf_library_agrees_on_the_details(tmp_path):
    import pygltflib

    path = write_textured(tmp_path / "a.glb", textured_square(), stack(), settings={"seed": "7"})[0]
    found = pygltflib.GLTF2().load(str(path))
    material = found.materials[0]
    assert material.occlusionTexture.index == material.pbrMetallicRoughness.metallicRoughnessTexture.index
    assert material.pbrMetallicRoughness.metallicFactor == 0
    assert found.asset.extras["texloom"]["seed"] == "7"
    assert found.meshes[0].primitives[0].attributes.TANGENT is not None
    assert "height" in material.extras["texloom"]


def test_an_obj_comes_with_its_material_and_pictures(tmp_path):
    import trimesh

    mesh, maps = textured_square(), stack()
    files = write_textured(tmp_path / "a.obj", mesh, maps)
    assert {path.name for path in files} == {"a.obj", "a.mtl", *(f"a-{name}.png" for name in maps)}
    found = trimesh.load(tmp_path / "a.obj", process=False)
    np.testing.assert_allclose(found.triangles, mesh.vertices[mesh.faces], atol=1e-7)
    np.testing.assert_allclose(found.visual.uv[found.faces], mesh.uv, atol=1e-6)
    assert found.visual.material.image.size == (16, 16)


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
def test_vertex_colours_are_linear_in_glb_and_srgb_in_ply(tmp_path, depth):
    import trimesh

    values = RNG.integers(0, np.iinfo(depth).max, (16, 16, 3)).astype(depth)
    exemplar = Exemplar({"basecolor": to_map(values, "colour"), "roughness": to_map(values[..., :1], "data")})
    mesh, _ = grid_mesh(3)
    position = RNG.integers(0, 16, (16, 1, 2)).astype(np.float32)
    sources = SourceMap(position, np.ones((16, 1), np.float32))
    surface = flat_surface(mesh, 0.5, 0.3)
    ply = trimesh.load(write_vertex_colours(tmp_path / "a.ply", surface, sources, exemplar), process=False)
    at = position[:, 0].astype(int)
    shown = values[at[:, 0], at[:, 1]]
    expected = shown if depth is np.uint8 else np.rint(shown / 257)
    np.testing.assert_allclose(ply.visual.vertex_colors[:, :3], expected, atol=0 if depth is np.uint8 else 1)
    document = unpack(write_vertex_colours(tmp_path / "a.glb", surface, sources, exemplar).read_bytes())
    attributes = document.json["meshes"][0]["primitives"][0]["attributes"]
    colours = accessor(document, attributes["COLOR_0"])
    np.testing.assert_allclose(colours[:, :3], gather_sites(sources, exemplar.maps["basecolor"]), atol=1e-5)
    np.testing.assert_allclose(accessor(document, attributes["TANGENT"])[:, :3], surface.direction, atol=1e-6)
    assert "_ROUGHNESS" in attributes and document.json["meshes"][0]["extras"]["texel"] == 0.5


def animated_glb(path: Path) -> bytes:
    """Two instances of a skinned square with a morph target and an old material, a second mesh, and an animation."""
    mesh, uv = grid_mesh(2)
    draft = Draft()
    count = len(mesh.vertices)
    uv_at = np.zeros((count, 2), "<f4")
    uv_at[mesh.faces.reshape(-1)] = uv.reshape(-1, 2)
    attributes = {
        "POSITION": draft.attribute(mesh.vertices.astype("<f4")),
        "NORMAL": draft.attribute(np.tile(np.array([0, 0, 1], "<f4"), (count, 1))),
        "TEXCOORD_0": draft.attribute(uv_at * np.float32([1, -1]) + np.float32([0, 1])),
        "JOINTS_0": draft.attribute(np.tile(np.arange(4, dtype=np.uint8) % 2, (count, 1))),
        "WEIGHTS_0": draft.attribute(RNG.dirichlet(np.ones(4), count).astype("<f4")),
        "COLOR_0": draft.attribute(RNG.integers(0, 255, (count, 3)).astype(np.uint8), normalized=True),
    }
    target = {"POSITION": draft.attribute(RNG.normal(size=(count, 3)).astype("<f4"))}
    primitive = {"attributes": attributes, "indices": draft.indices(mesh.faces), "targets": [target], "material": 0}
    other = {"attributes": {"POSITION": attributes["POSITION"]}, "indices": primitive["indices"], "material": 1}
    draft.json["materials"] = [{"name": "hide", "doubleSided": True, "extensions": {"X_odd": {}}}, {"name": "eyes"}]
    draft.add("meshes", {"primitives": [primitive, other], "weights": [0.5]})
    times = draft.attribute(np.array([[0.0], [1.0]], "<f4"))
    moves = draft.attribute(np.array([[0, 0, 0], [1, 2, 3]], "<f4"))
    draft.json |= {
        "nodes": [
            {"mesh": 0, "translation": [1, 2, 3], "name": "first", "children": [2]},
            {"mesh": 0, "scale": [2, 2, 2], "rotation": [0, 0.6, 0, 0.8], "extras": {"kept": True}},
            {"name": "bone"},
        ],
        "scenes": [{"nodes": [0, 1]}],
        "scene": 0,
        "skins": [{"joints": [2, 0]}],
        "animations": [
            {
                "samplers": [{"input": times, "output": moves}],
                "channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}],
            }
        ],
    }
    document = unpack(draft.packed({}))
    content = pack(Document(document.json, document.binary))
    path.write_bytes(content)
    return content


@pytest.mark.parametrize("fresh", [False, True])
def test_a_glb_goes_back_with_everything_else_untouched(tmp_path, fresh):
    before = unpack(animated_glb(tmp_path / "in.glb"))
    model = read_mesh(tmp_path / "in.glb", material="hide")
    assert model.uv is not None and len(model.mesh.faces) == 16
    uv = (model.uv * 0.5 + (np.arange(16) % 2 * 0.5)[:, None, None]).astype(np.float32) if fresh else None
    tangents = np.tile([1.0, 0, 0, 1], (16, 3, 1))
    (tmp_path / "out.glb").write_bytes(retextured_glb(model, stack(), uv=uv, tangents=tangents, settings={"seed": "1"}))
    after = unpack((tmp_path / "out.glb").read_bytes())
    assert after.binary[: len(before.binary)] == before.binary
    for kind in ("accessors", "bufferViews", "materials"):
        assert after.json[kind][: len(before.json[kind])] == before.json[kind]
    for kind in ("animations", "skins", "scenes", "scene"):
        assert after.json[kind] == before.json[kind]
    kept = [{key: value for key, value in node.items() if key != "mesh"} for node in after.json["nodes"]]
    assert kept == [{key: value for key, value in node.items() if key != "mesh"} for node in before.json["nodes"]]
    meshes = [after.json["meshes"][after.json["nodes"][node]["mesh"]] for node in (0, 1)]
    assert meshes[0] is not meshes[1] and all(mesh["primitives"][1]["material"] == 1 for mesh in meshes)
    material = after.json["materials"][meshes[0]["primitives"][0]["material"]]
    assert material["doubleSided"] and "baseColorTexture" in material["pbrMetallicRoughness"]
    again = read_mesh(tmp_path / "out.glb", material="hide") if not fresh else None
    if again is not None and again.uv is not None:
        np.testing.assert_array_equal(again.uv, model.uv)
    old = before.json["meshes"][0]["primitives"][0]
    for mesh in meshes:
        new = mesh["primitives"][0]
        corner = accessor(after, new["indices"])[:, 0]
        old_corner = accessor(before, old["indices"])[:, 0]
        pairs = {name: (name, old["attributes"][name]) for name in ("POSITION", "NORMAL", "JOINTS_0", "WEIGHTS_0")}
        pairs["_COLOR_0"] = ("_COLOR_0", old["attributes"]["COLOR_0"])
        assert "COLOR_0" not in new["attributes"]
        for name, (_, index) in pairs.items():
            found = accessor(after, new["attributes"][name])[corner]
            np.testing.assert_array_equal(found, accessor(before, index)[old_corner])
            assert (
                after.json["accessors"][new["attributes"][name]]["componentType"]
                == (before.json["accessors"][index]["componentType"])
            )
        moved = accessor(after, new["targets"][0]["POSITION"])[corner]
        np.testing.assert_array_equal(moved, accessor(before, old["targets"][0]["POSITION"])[old_corner])
    if uv is not None:
        found = [accessor(after, mesh["primitives"][0]["attributes"]["TEXCOORD_0"]) for mesh in meshes]
        corners = [accessor(after, mesh["primitives"][0]["indices"])[:, 0] for mesh in meshes]
        stored = np.concatenate([uv_at[corner] for uv_at, corner in zip(found, corners, strict=True)])
        np.testing.assert_allclose(stored * [1, -1] + [0, 1], uv.reshape(-1, 2), atol=1e-6)
    assert json.dumps(after.json["asset"]).count("texloom") == 2


def test_a_turned_node_gets_its_tangents_in_its_own_space(tmp_path):
    animated_glb(tmp_path / "in.glb")
    model = read_mesh(tmp_path / "in.glb", material="hide")
    world = np.tile([0.8, 0.0, -0.6, 1.0], (16, 3, 1))  # local +x under the second node's rotation, among others
    after = unpack(retextured_glb(model, stack(), tangents=world))
    mesh = after.json["meshes"][after.json["nodes"][1]["mesh"]]
    tangent = accessor(after, mesh["primitives"][0]["attributes"]["TANGENT"])
    turn = 2 * np.arctan2(0.6, 0.8)
    rotation = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    np.testing.assert_allclose(tangent[:, :3] @ rotation.T, np.tile([0.8, 0, -0.6], (9, 1)), atol=1e-6)


def test_pictures_in_the_glb_keep_sixteen_bits(tmp_path):
    write_textured(tmp_path / "a.obj", textured_square(), {"ao": stack()["ao"]})
    with Pillow.open(tmp_path / "a-ao.png") as picture:
        assert picture.mode.startswith("I;16")
