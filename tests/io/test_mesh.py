import numpy as np
import pytest
from scipy.spatial import KDTree

from tests.data import DATA, needs_data
from texloom.errors import FileError, MeshError, ParameterError, TexloomError
from texloom.io.mesh import read_mesh

OBJ = """\
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl ground
f 1/1 2/2 3/3 4/4
usemtl wall
f 1/1 5/4 2/2
"""

BAD = {  # (mends or error expected, faces left)
    "degenerate-area.obj": ("dropped 4 degenerate faces", 68),
    "degenerate-index.obj": ("dropped 5 degenerate faces", 67),
    "duplicate-faces.obj": ("dropped 48 duplicate faces", 72),
    "edge-three-faces.obj": ("split 1 non-manifold edge", 74),
    "empty.obj": (MeshError, "the mesh is empty"),
    "faces-negative-index.obj": (None, 72),
    "far-from-origin.obj": (None, 320),
    "flat-sphere.obj": ("dropped 152 duplicate faces", 152),
    "flipped-random.obj": ("turned over 111 faces", 320),
    "header-count-wrong.ply": (FileError, "promises 99 vertex rows and 72 face rows, 171 lines in all, but 121 follow"),
    "index-out-of-range.obj": (FileError, "line 86: the face names vertex 90, but the file has 49 vertices"),
    "mobius-strip.obj": ("cut one-sided (non-orientable) parts open along 2 edges", 160),
    "not-a-mesh.ply": (FileError, "not a PLY file"),
    "points-only.obj": (MeshError, "49 vertices but no faces"),
    "single-triangle.obj": (None, 1),
    "soup.obj": ("welded 167 duplicate vertices", 72),
    "truncated.obj": (FileError, "line 62: a face needs three vertices or more, got 'f 8 15'"),
    "vertex-bowtie.obj": ("split 1 non-manifold vertex", 640),
    "vertex-inf.obj": (MeshError, "vertex 6 .* is at .*inf"),
    "vertex-nan.obj": (MeshError, "vertex 37 .* is at .*nan"),
}

GOOD = {  # vertices, faces and boundary halfedges after mending
    "armadillo-15k.obj": (14587, 29170, 0),
    "block-slivers.obj": (90, 180, 0),
    "bunny-watertight-3k.obj": (3485, 6966, 0),
    "camel-head-open-11k.obj": (11381, 22704, 56),
    "format-cube.off": (8, 12, 0),
    "format-sphere-ascii.stl": (162, 320, 0),
    "format-spot-textured.glb": (2930, 5856, 0),
    "format-wingnut-binary.stl": (3047, 6090, 0),
    "oblong-flipped-duplicates.obj": (422, 840, 0),
    "spot-quads-3k.obj": (2930, 5856, 0),
    "spot-loop-187k.ply": (187394, 374784, 0),
    "two-knots-6k.obj": (5760, 11520, 0),
}


@pytest.fixture
def obj(tmp_path):
    path = tmp_path / "room.obj"
    path.write_text(OBJ)
    return path


def test_polygons_are_fanned_and_coordinates_kept(obj):
    model = read_mesh(obj)
    np.testing.assert_array_equal(model.mesh.faces, [[0, 1, 2], [0, 2, 3], [0, 4, 1]])
    np.testing.assert_array_equal(model.uv[:2], [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]])
    np.testing.assert_array_equal(model.corner_origin, model.mesh.faces)
    assert model.path == obj
    assert model.document is None and model.primitive is None


def test_a_material_selects_its_faces(obj):
    model = read_mesh(obj, material="wall")
    np.testing.assert_array_equal(model.face_origin, [2])
    np.testing.assert_array_equal(model.corner_origin, [[0, 4, 1]])
    assert model.mends == ("dropped 2 unreferenced vertices",)


def test_a_material_that_is_not_there_is_refused(obj):
    with pytest.raises(ParameterError, match="room.obj: there is no material 'roof'; the file has: 'ground', 'wall'"):
        read_mesh(obj, material="roof")


def test_unknown_and_missing_files_are_refused(tmp_path):
    with pytest.raises(FileError, match=r"a.blend: '.blend' is not a mesh format we read; these are: .obj .ply .off"):
        read_mesh(tmp_path / "a.blend")
    with pytest.raises(FileError, match="a.obj: no such file"):
        read_mesh(tmp_path / "a.obj")
    (tmp_path / "folder.stl").mkdir()
    with pytest.raises(FileError, match="folder.stl: cannot be read"):
        read_mesh(tmp_path / "folder.stl")


@pytest.mark.parametrize("suffix", ["obj", "ply", "off", "stl", "glb", "gltf"])
@pytest.mark.parametrize("content", [b"", b"\0" * 300, b"ply\nOFF\nsolid\n{}", bytes(range(256)) * 3])
def test_files_that_are_nothing_are_refused_in_one_line(tmp_path, suffix, content):
    path = tmp_path / f"nothing.{suffix}"
    path.write_bytes(content)
    with pytest.raises(TexloomError, match=f"^nothing.{suffix}: [^\n]+$"):
        read_mesh(path)


def test_an_index_too_wide_is_refused_not_wrapped(tmp_path):
    (tmp_path / "wide.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 4294967298\n")
    with pytest.raises(MeshError, match="wide.off: face 0 .* names vertex 4294967298"):
        read_mesh(tmp_path / "wide.off")


def test_signalling_nans_are_refused_quietly(tmp_path):
    corners = np.zeros((1, 50), np.uint8)
    corners[0, 12:16] = (1, 0, 160, 127)
    (tmp_path / "nan.stl").write_bytes(bytes(80) + b"\1\0\0\0" + corners.tobytes())
    with pytest.raises(MeshError, match="vertex 0 .* is at .nan"):
        read_mesh(tmp_path / "nan.stl")


@needs_data
@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_mended_aloud_or_refused(name):
    expected, rest = BAD[name]
    if isinstance(expected, type):
        with pytest.raises(expected, match=f"^{name}: .*{rest}"):
            read_mesh(DATA / "meshes-bad" / name)
        return
    model = read_mesh(DATA / "meshes-bad" / name)
    assert len(model.mesh.faces) == rest
    assert model.mends == () if expected is None else expected in model.mends


@needs_data
@pytest.mark.parametrize("name", GOOD)
def test_good_files_are_read_whole(name):
    mesh = read_mesh(DATA / "meshes" / name).mesh
    assert (len(mesh.vertices), len(mesh.faces), int((mesh.twins < 0).sum())) == GOOD[name]


@needs_data
@pytest.mark.parametrize("name", ["spot-3k.obj", "format-spot-textured.glb"])
def test_the_same_model_in_two_formats_has_the_same_coordinates(name):
    corners = []
    for model in (read_mesh(DATA / "meshes" / name), read_mesh(DATA / "meshes" / "spot-quads-3k.obj")):
        assert model.uv is not None and model.uv.shape == (5856, 3, 2)
        corners.append(np.concatenate([model.mesh.vertices[model.mesh.faces], model.uv], axis=2).reshape(-1, 5))
    for one, other in (corners, corners[::-1]):
        assert KDTree(one).query(other)[0].max() < 2e-3
