"""The readers of text and binary formats, each against a mesh written by hand."""

import struct

import numpy as np
import pytest

from tests.meshes import octahedron
from texloom.errors import FileError
from texloom.io import obj
from texloom.io.obj import read_obj
from texloom.io.off import read_off
from texloom.io.ply import read_ply
from texloom.io.stl import read_stl
from texloom.io.triangles import fan

MESH = octahedron()
HEADER = (
    "ply\nformat {}\ncomment made by hand\nelement vertex 6\n{}element face 8\nproperty list uchar int vertex_indices\n"
)
XYZ = "property float x\nproperty float y\nproperty float z\n"


def assert_octahedron(read):
    np.testing.assert_array_equal(read.vertices[read.faces], MESH.vertices[MESH.faces])


def ply_body(order: str) -> bytes:
    vertices = b"".join(struct.pack(order + "3f", *vertex) for vertex in MESH.vertices)
    return vertices + b"".join(struct.pack(order + "B3i", 3, *face) for face in MESH.faces)


def test_polygons_become_fans():
    triangles, polygon = fan(np.array([4, 3, 5]))
    np.testing.assert_array_equal(triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [7, 8, 9], [7, 9, 10], [7, 10, 11]])
    np.testing.assert_array_equal(polygon, [0, 0, 1, 2, 2, 2])


@pytest.mark.parametrize(("name", "order"), [("binary_little_endian", "<"), ("binary_big_endian", ">")])
def test_binary_ply(name, order):
    header = HEADER.format(f"{name} 1.0", XYZ) + "end_header\n"
    assert_octahedron(read_ply(header.encode() + ply_body(order)))


def test_text_ply_with_more_than_we_need():
    extra = XYZ + "property uchar red\nproperty float s\nproperty float t\n"
    lines = [f"{x} {y} {z} 255 {i / 8} {i / 4}" for i, (x, y, z) in enumerate(MESH.vertices)]
    lines += ["3 " + " ".join(map(str, face)) for face in MESH.faces]
    read = read_ply((HEADER.format("ascii 1.0", extra) + "end_header\n" + "\n".join(lines) + "\n").encode())
    assert_octahedron(read)
    np.testing.assert_allclose(read.uv, np.stack([MESH.faces / 8, MESH.faces / 4], axis=-1))


def test_binary_ply_of_uneven_polygons():
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 5\n" + XYZ
    header += "element face 2\nproperty uchar flag\nproperty list uchar int vertex_index\nend_header\n"
    body = (
        struct.pack("<15f", *range(15)) + struct.pack("<BB3i", 1, 3, 0, 1, 2) + struct.pack("<BB4i", 1, 4, 0, 2, 3, 4)
    )
    np.testing.assert_array_equal(read_ply(header.encode() + body).faces, [[0, 1, 2], [0, 2, 3], [0, 3, 4]])


def test_ply_with_coordinates_at_the_corners_of_faces():
    header = "ply\nformat ascii 1.0\nelement vertex 4\n" + XYZ + "element face 1\n"
    header += "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
    read = read_ply((header + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 0.5 0 0.5 0.25 0 0.25\n").encode())
    np.testing.assert_array_equal(read.uv, [[[0, 0], [0.5, 0], [0.5, 0.25]], [[0, 0], [0.5, 0.25], [0, 0.25]]])


@pytest.mark.parametrize(("cut", "said"), [(-5, "cut short"), (40, "cut short")])
def test_binary_ply_cut_short_is_refused(cut, said):
    header = (HEADER.format("binary_little_endian 1.0", XYZ) + "end_header\n").encode()
    with pytest.raises(FileError, match=said):
        read_ply(header + ply_body("<")[:cut])
    with pytest.raises(FileError, match="8 bytes more follow"):
        read_ply(header + ply_body("<") + b"leftover")


def test_ply_of_a_negative_count_is_refused():
    with pytest.raises(FileError, match="line 3 of the PLY header"):
        read_ply(b"ply\nformat binary_little_endian 1.0\nelement vertex -5\nproperty float x\nend_header\n")


def test_obj_with_every_way_to_name_a_corner():
    text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n"
    text += b"f 1/1/1 2/2/1 3/3/1\nv 1 1 0 1.0\nvt 1 1 0\nf -3/-3 \\\n-1/-1 -2/-2 # comment\n".replace(
        b" # comment", b""
    )
    read = read_obj(text)
    np.testing.assert_array_equal(read.faces, [[0, 1, 2], [1, 3, 2]])
    np.testing.assert_array_equal(read.uv[1], [[1, 0], [1, 1], [0, 1]])
    without = read_obj(text + b"f 1//1 2//1 4//1\n")
    assert without.uv is None and len(without.faces) == 3


def test_obj_counts_back_from_where_the_face_stands():
    text = b"v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf -3/-3 -2/-2 -1/-1\nv 5 5 5\nvt 5 5\n"
    read = read_obj(text)
    np.testing.assert_array_equal(read.faces, [[1, 2, 3]])
    np.testing.assert_array_equal(read.uv, [[[0, 0], [1, 0], [0, 1]]])


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (b"v 1 2", "line 4: a position needs 3 numbers, got 'v 1 2'"),
        (b"v 1 2 x", "line 4: a position needs 3 numbers"),
        (b"f 1 2 4", "line 4: the face names vertex 4, but the file has 3 vertices"),
        (b"f 1 2 0", "line 4: the face names vertex 0"),
        (b"f -4 1 2", "line 4: the face names vertex"),
        (b"f 1 2 three", "line 4: 'f 1 2 three' is not a face"),
        (b"f 1 2", "line 4: a face needs three vertices"),
    ],
)
def test_obj_lines_that_cannot_be_meant_are_named(line, said):
    with pytest.raises(FileError, match=said):
        read_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + line + b"\nf 1 2 3\n")


SQUARE = b"v 0 0 0.5\nv 1 0 0.5\nv 1 1 -1e-3\nv 0 1 0.25\n"


@pytest.mark.parametrize(
    ("text", "at_one_go"),
    [
        (SQUARE + b"f 1 2 3\nf 1 3 4\n", True),
        (SQUARE + b"f 1 2 3 4\n", True),
        (SQUARE + b"f -4 -3 -2\nf 1 3 -1", True),
        (SQUARE.replace(b"\n", b" 1.0\r\n") + b"f 1 2 3\r\n\r\n", True),
        (b"# a square\n\no square\n" + SQUARE + b"vn 0 0 1\n\ns off\ng\nf 1 2 3\n# its end", True),
        (SQUARE + b"f 1 2 3\nf 1 2 3 4\n", False),
        (SQUARE + b"f 1 2 3\nv 2 2 2\nf 1 2 -1\n", False),
        (SQUARE + b"f 1 2 \\\n3\n", False),
        (SQUARE + b"# is it \\\nv 9 9 9\nf 1 2 3\n", False),
        (SQUARE + b"# is it \rv 9 9 9\nf 1 2 3\n", False),
        (SQUARE + b"vt 0 0\nf 1/1 2/1 3/1\n", False),
        (SQUARE + b"usemtl moss\nf 1 2 3\n", False),
        (SQUARE, False),
    ],
)
def test_obj_read_at_one_go_is_obj_read_by_lines(text, at_one_go, monkeypatch):
    read = read_obj(text)
    assert (obj._plain(text) is not None) == at_one_go
    monkeypatch.setattr(obj, "_plain", lambda content: None)
    by_lines = read_obj(text)
    for one, other in ((read.vertices, by_lines.vertices), (read.faces, by_lines.faces), (read.uv, by_lines.uv)):
        assert (one is None) == (other is None)
        np.testing.assert_array_equal(one, other, strict=True)
    np.testing.assert_array_equal(read.material, by_lines.material, strict=True)
    assert read.materials == by_lines.materials


@pytest.mark.parametrize(
    "line", [b"f 1 2 5", b"f 1 2 0", b"f -5 1 2", b"f 1 2 99999999999999999999", b"v 1 2", b"f 1 2"]
)
def test_obj_of_one_wrong_line_is_not_read_at_one_go(line):
    text = line + b"\n" + SQUARE + b"f 1 2 3\n" if line[:1] == b"v" else SQUARE + b"f 1 2 3\n" + line
    assert obj._plain(text) is None


def test_off_with_comments_and_colours():
    text = "COFF # octahedron\n\n6 8 12\n"
    text += "\n".join(f"{x} {y} {z} 255 0 0 255" for x, y, z in MESH.vertices)
    text += "\n" + "\n".join(f"3 {a} {b} {c} 0.1 0.2 0.3" for a, b, c in MESH.faces)
    assert_octahedron(read_off(text.encode()))
    with pytest.raises(FileError, match="promises 6 vertices and 8 faces, 14 lines in all, but 13 follow"):
        read_off(text.rsplit("\n", 1)[0].encode())


def test_stl_as_bytes_and_as_text():
    corners = MESH.vertices[MESH.faces]
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *triangle.reshape(-1), 0) for triangle in corners)
    binary = b"solid but binary".ljust(80, b" ") + struct.pack("<I", 8) + facets
    assert_octahedron(read_stl(binary))
    with pytest.raises(FileError, match=r"promises 8 triangles \(484 bytes\), it has 474"):
        read_stl(binary[:-10].replace(b"solid", b"SOLUD"))
    lines = "".join(f"vertex {x} {y} {z}\n" for x, y, z in corners.reshape(-1, 3))
    assert_octahedron(read_stl(f"solid s\n{lines}endsolid s\n".encode()))
    with pytest.raises(FileError, match="23 vertices do not make whole triangles"):
        read_stl(f"solid s\n{lines.rsplit('vertex', 1)[0]}".encode())
