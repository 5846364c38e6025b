import base64
import json

import numpy as np
import pytest

from tests.meshes import as_mesh, octahedron, tetrahedron
from texloom.errors import FileError
from texloom.io.mesh import read_mesh
from texloom.mesh.gltf import Document, accessor, pack, primitives, unpack

QUARTER = np.sqrt(0.5)


def scene() -> Document:
    """Two meshes in a tree of three nodes: an octahedron twice (once mirrored), and a tetrahedron between them."""
    eight, four = octahedron(), tetrahedron()
    uv = np.linspace(0, 1, 12).reshape(6, 2)
    arrays = [
        eight.vertices.astype("<f4"),
        eight.faces.astype("<u2"),
        uv.astype("<f4"),
        four.vertices.astype("<f4"),
        four.faces.astype("<u4"),
        np.zeros((4, 2), "<f4"),
    ]
    binary, views = b"", []
    for array in arrays:
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": array.nbytes})
        binary += array.tobytes()
    accessors = [
        {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 6},
        {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 24},
        {"bufferView": 2, "componentType": 5126, "type": "VEC2", "count": 6},
        {"bufferView": 3, "componentType": 5126, "type": "VEC3", "count": 4},
        {"bufferView": 4, "componentType": 5125, "type": "SCALAR", "count": 12},
        {"bufferView": 5, "componentType": 5126, "type": "VEC2", "count": 4},
    ]
    content = {
        "asset": {"version": "2.0"},
        "extras": {"kept": True},
        "scene": 0,
        "scenes": [{"nodes": [2, 1]}],
        "nodes": [
            {"mesh": 1, "translation": [0, 0, 5], "rotation": [0, 0, QUARTER, QUARTER]},
            {"mesh": 0, "scale": [-1, 1, 1], "translation": [9, 0, 0]},
            {"mesh": 0, "children": [0], "scale": [2, 2, 2]},
        ],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0}]},
            {"primitives": [{"attributes": {"POSITION": 3, "TEXCOORD_0": 5}, "indices": 4, "material": 1}]},
        ],
        "materials": [{"name": "stone"}, {}],
        "buffers": [{"byteLength": len(binary)}],
        "bufferViews": views,
        "accessors": accessors,
    }
    return Document(content, binary)


@pytest.fixture
def glb(tmp_path):
    path = tmp_path / "scene.glb"
    path.write_bytes(pack(scene()))
    return path


def test_packing_and_unpacking_is_the_identity():
    again = unpack(pack(scene()))
    assert again.json == scene().json
    assert again.binary[: len(scene().binary)] == scene().binary


def test_primitives_are_counted_depth_first():
    found = primitives(scene())
    assert [(one.node, one.mesh, one.primitive) for one in found] == [(2, 0, 0), (0, 1, 0), (1, 0, 0)]
    assert [one.vertex_start for one in found] == [0, 6, 10]
    assert [one.face_start for one in found] == [0, 8, 12]
    assert [one.material for one in found] == ["stone", "material 1", "stone"]


def test_nodes_carry_their_triangles_into_the_world(glb):
    model = read_mesh(glb)
    assert model.mends == ()
    eight, four = octahedron(), tetrahedron()
    np.testing.assert_allclose(model.mesh.vertices[:6], 2 * eight.vertices)
    turned = four.vertices @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])  # a quarter turn about z
    np.testing.assert_allclose(model.mesh.vertices[6:10], 2 * (turned + [0, 0, 5]), atol=1e-6)
    np.testing.assert_allclose(model.mesh.vertices[10:], eight.vertices * [-1, 1, 1] + [9, 0, 0])
    np.testing.assert_array_equal(model.primitive[[0, 8, 12]], [[2, 0], [0, 0], [1, 0]])


def test_mirrored_nodes_keep_their_outside_out(glb):
    mesh = read_mesh(glb).mesh
    outward = mesh.vertices[mesh.faces[12:]].mean(axis=1) - [9, 0, 0]
    assert (np.einsum("ij,ij->i", outward, mesh.face_normals[12:]) > 0).all()


def test_coordinates_are_turned_up(glb):
    model = read_mesh(glb)
    stored = np.linspace(0, 1, 12).reshape(6, 2)
    np.testing.assert_allclose(model.uv[:8], (stored * [1, -1] + [0, 1])[octahedron().faces], atol=1e-6)


def test_a_material_keeps_the_count_of_the_whole_file(glb):
    model = read_mesh(glb, material="material 1")
    np.testing.assert_array_equal(model.face_origin, [8, 9, 10, 11])
    np.testing.assert_array_equal(model.corner_origin, tetrahedron().faces + 6)
    np.testing.assert_array_equal(model.primitive, [[0, 0]] * 4)


def test_the_document_is_kept_byte_for_byte(glb):
    assert read_mesh(glb).document == glb.read_bytes()


def test_a_gltf_is_packed_with_what_lies_beside_it(tmp_path):
    document = scene()
    content = json.loads(json.dumps(document.json))
    content["buffers"][0]["uri"] = "my%20buffer.bin"
    content["images"] = [{"uri": "skin.png"}, {"uri": "data:image/jpeg;base64," + base64.b64encode(b"jpeg").decode()}]
    (tmp_path / "scene.gltf").write_text(json.dumps(content))
    with pytest.raises(FileError, match=r"scene.gltf: my buffer.bin, which the glTF needs, is missing"):
        read_mesh(tmp_path / "scene.gltf")
    (tmp_path / "my buffer.bin").write_bytes(document.binary)
    (tmp_path / "skin.png").write_bytes(b"pixels")
    model = read_mesh(tmp_path / "scene.gltf")
    packed = unpack(model.document)
    views = [packed.json["bufferViews"][image["bufferView"]] for image in packed.json["images"]]
    stored = [packed.binary[view["byteOffset"] :][: view["byteLength"]] for view in views]
    assert stored == [b"pixels", b"jpeg"]
    assert [image["mimeType"] for image in packed.json["images"]] == ["image/png", "image/jpeg"]
    assert packed.json["extras"] == {"kept": True}
    assert [len(one.triangles) for one in primitives(packed)] == [8, 4, 8]


@pytest.mark.parametrize(
    ("mode", "expected"), [(5, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]), (6, [[0, 1, 2], [0, 2, 3], [0, 3, 4]])]
)
def test_strips_and_fans_are_cut_up(mode, expected):
    document = scene()
    one = document.json["meshes"][1]["primitives"][0]
    one["mode"] = mode
    del one["indices"]
    one["attributes"] = {"POSITION": 6}
    document.json["accessors"].append({**document.json["accessors"][0], "count": 5})
    np.testing.assert_array_equal(primitives(document)[1].triangles, expected)


def test_sparse_normalized_and_strided_accessors():
    binary = np.array([[255, 0, 9, 9], [51, 102, 9, 9]], np.uint8).tobytes() + b"\1" + bytes([0, 255])
    content = {
        "bufferViews": [
            {"buffer": 0, "byteLength": 8, "byteStride": 4},
            {"buffer": 0, "byteOffset": 8, "byteLength": 1},
            {"buffer": 0, "byteOffset": 9, "byteLength": 2},
        ],
        "accessors": [{"bufferView": 0, "componentType": 5121, "type": "VEC2", "count": 2, "normalized": True}],
    }
    np.testing.assert_allclose(accessor(Document(content, binary), 0), [[1, 0], [0.2, 0.4]])
    content["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": 1, "componentType": 5121},
        "values": {"bufferView": 2},
    }
    np.testing.assert_allclose(accessor(Document(content, binary), 0), [[1, 0], [0, 1]])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda content: content["accessors"][0].update(count=600), "accessor 0 reads up to byte"),
        (lambda content: content["accessors"][3].update(count=2), "names vertex 3 .* but it has 2 vertices"),
        (lambda content: content["nodes"][0].update(children=[2]), "two parents"),
        (lambda content: content.update(extensionsRequired=["KHR_draco_mesh_compression"]), "compressed .KHR_draco"),
        (lambda content: content["scenes"][0].update(nodes=[77]), "not as its format demands"),
        (lambda content: content.update(meshes=7), "not as its format demands"),
    ],
)
def test_documents_that_contradict_themselves_are_refused(tmp_path, change, said):
    document = scene()
    change(document.json)
    (tmp_path / "bad.glb").write_bytes(pack(document))
    with pytest.raises(FileError, match=f"^bad.glb: .*{said}"):
        read_mesh(tmp_path / "bad.glb")


def test_a_glb_cut_short_is_refused(glb):
    whole = glb.read_bytes()
    for length in (3, 15, 40, len(whole) // 2, len(whole) - 4):
        glb.write_bytes(whole[:length])
        with pytest.raises(FileError):
            read_mesh(glb)


def test_seams_are_welded_and_coordinates_survive(tmp_path):
    mesh = as_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [3, 4, 5]])
    uv = np.array([[0, 0], [0.4, 0], [0, 0.4], [0.6, 1], [1, 1], [1, 0.6]], np.float32)
    arrays = [mesh.vertices.astype("<f4").tobytes(), mesh.faces.astype("<u4").tobytes(), uv.tobytes()]
    starts = np.cumsum([0, *map(len, arrays)])
    content = {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1}]}],
        "buffers": [{"byteLength": int(starts[-1])}],
        "bufferViews": [{"buffer": 0, "byteOffset": int(starts[i]), "byteLength": len(arrays[i])} for i in range(3)],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 6},
            {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 6},
            {"bufferView": 2, "componentType": 5126, "type": "VEC2", "count": 6},
        ],
    }
    (tmp_path / "seam.glb").write_bytes(pack(Document(content, b"".join(arrays))))
    model = read_mesh(tmp_path / "seam.glb")
    assert model.mends == ("welded 2 duplicate vertices",)
    assert len(model.mesh.vertices) == 4
    np.testing.assert_array_equal(model.corner_origin, mesh.faces)
    np.testing.assert_allclose(model.uv, (uv * [1, -1] + [0, 1])[mesh.faces], atol=1e-6)


def test_a_matrix_is_stored_by_columns():
    document = scene()
    document.json["nodes"][1] = {"mesh": 0, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1]}
    np.testing.assert_array_equal(primitives(document)[2].to_world @ [1, 0, 0, 1], [7, 9, 9, 1])
    document.json["nodes"][1]["skin"] = 0  # a skinned mesh stands where its skin puts it, not its node
    np.testing.assert_array_equal(primitives(document)[2].to_world, np.eye(4))
