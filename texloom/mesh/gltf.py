"""What reading and writing glTF share: the GLB container, its accessors, and the order its triangles are counted in."""

import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float64, Int32, Shaped

from texloom.errors import FileError

_MAGIC, _JSON, _BINARY = 0x46546C67, 0x4E4F534A, 0x004E4942
_COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6  # primitive modes


@dataclass(frozen=True, eq=False)
class Document:
    """A glTF file taken apart: the JSON as nested dictionaries, and the one binary chunk its buffer views cut."""

    json: dict[str, Any]
    binary: bytes


@dataclass(frozen=True, eq=False)
class Primitive:
    """Triangles under one material in one node, and where their vertices and triangles stand in the whole count."""

    node: int
    mesh: int
    primitive: int  # in its mesh
    material: str | None  # name, or "material N" where it has none; None where the primitive names no material
    attributes: dict[str, int]  # accessor of each attribute: POSITION, TEXCOORD_0, ...
    to_world: Float64[np.ndarray, "4 4"]
    triangles: Int32[np.ndarray, "triangle 3"]  # vertices of this primitive, in the file's winding
    vertex_count: int
    vertex_start: int  # vertices of all primitives before this one
    face_start: int  # triangles of all primitives before this one


def unpack(document: bytes) -> Document:
    """The parts of a GLB.

    Raises: FileError, if it is cut short or is no GLB of version 2.
    """
    if len(document) < 20:
        raise FileError(f"not a GLB: {len(document)} bytes are too few for a header")
    magic, version, length = struct.unpack_from("<III", document)
    if magic != _MAGIC or version != 2:
        raise FileError("not a GLB of version 2")
    if length > len(document):
        raise FileError(f"the GLB is cut short: its header promises {length} bytes, it has {len(document)}")
    chunks: dict[int, bytes] = {}
    offset = 12
    while offset + 8 <= length:
        size, kind = struct.unpack_from("<II", document, offset)
        if offset + 8 + size > length:
            raise FileError(f"the GLB is cut short: a chunk promises {size} bytes, {length - offset - 8} are left")
        chunks.setdefault(kind, document[offset + 8 : offset + 8 + size])
        offset += 8 + size
    return Document(parse_json(chunks.get(_JSON, b"")), chunks.get(_BINARY, b""))


def parse_json(text: bytes) -> dict[str, Any]:
    """The JSON part of a glTF file.

    Raises: FileError, if it is not JSON, or needs a compression we cannot undo.
    """
    try:
        parsed = json.loads(text.decode("utf-8"))
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        raise FileError(f"the glTF's JSON cannot be read: {error}") from None
    if not isinstance(parsed, dict):
        raise FileError("the glTF's JSON is not an object")
    packed = [name for name in parsed.get("extensionsRequired", []) if "draco" in name or "meshopt" in name]
    if packed:
        raise FileError(f"the glTF's geometry is compressed ({packed[0]}): save it without compression")
    return parsed


def pack(document: Document) -> bytes:
    """One GLB of the parts; its first buffer becomes the binary chunk, and must be the only one."""
    gap = b"\0" * (-len(document.binary) % 4)
    content = dict(document.json)
    if document.binary:
        content["buffers"] = [{**(content.get("buffers") or [{}])[0], "byteLength": len(document.binary)}]
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False).encode("utf-8")
    text += b" " * (-len(text) % 4)
    chunks = [struct.pack("<II", len(text), _JSON), text]
    if document.binary:
        chunks += [struct.pack("<II", len(document.binary) + len(gap), _BINARY), document.binary, gap]
    return b"".join([struct.pack("<III", _MAGIC, 2, 12 + sum(map(len, chunks))), *chunks])


def primitives(document: Document) -> list[Primitive]:
    """Every primitive made of triangles, in the one order vertices and triangles are counted in.

    Nodes of the default scene depth first (roots in their order, a node before its children, children in their
    order), and in each node the primitives of its mesh in their order. A mesh that two nodes show is counted twice.
    Points and lines are not counted. Strips and fans are cut into triangles.
    """
    content = document.json
    found: list[Primitive] = []
    vertices = faces = 0
    for node, to_world in _nodes(content):
        mesh = content["nodes"][node].get("mesh", -1)
        for number, primitive in enumerate(content["meshes"][mesh]["primitives"] if mesh >= 0 else []):
            mode = primitive.get("mode", _TRIANGLES)
            if mode not in (_TRIANGLES, _STRIP, _FAN) or "POSITION" not in primitive.get("attributes", {}):
                continue
            count = int(content["accessors"][primitive["attributes"]["POSITION"]]["count"])
            triangles = _triangles(document, primitive, mode, count)
            if triangles.size and (triangles.min() < 0 or triangles.max() >= count):
                raise FileError(
                    f"primitive {number} of node {node} names vertex {int(triangles.max())} (counted from 0), "
                    f"but it has {count} vertices"
                )
            found.append(
                Primitive(
                    node=node,
                    mesh=mesh,
                    primitive=number,
                    material=_material(content, primitive),
                    attributes=dict(primitive["attributes"]),
                    to_world=to_world,
                    triangles=triangles,
                    vertex_count=count,
                    vertex_start=vertices,
                    face_start=faces,
                )
            )
            vertices += count
            faces += len(triangles)
    return found


def accessor(document: Document, index: int) -> Shaped[np.ndarray, "item width"]:
    """The values of an accessor, one row an item: integers as stored, normalized ones as float32 in [-1, 1].

    Raises: FileError, if it reads past its buffer.
    """
    described = document.json["accessors"][index]
    kind, width = np.dtype(_COMPONENTS[described["componentType"]]), _WIDTHS[described["type"]]
    count = int(described["count"])
    if "bufferView" in described:
        values = _view(document, described["bufferView"], described.get("byteOffset", 0), kind, width, count, index)
    else:
        values = np.zeros((count, width), kind)
    if "sparse" in described:
        values = _with_sparse(document, described["sparse"], values, index)
    if described.get("normalized") and kind != np.float32:
        values = np.maximum(values.astype(np.float32) / np.iinfo(kind).max, np.float32(-1))
    return values


def _view(
    document: Document, view: int, offset: int, kind: np.dtype[Any], width: int, count: int, index: int
) -> np.ndarray:
    """``count`` rows of ``width`` components out of a buffer view, at its stride."""
    described = document.json["bufferViews"][view]
    start = described.get("byteOffset", 0) + offset
    stride = described.get("byteStride") or kind.itemsize * width
    end = start + stride * (count - 1) + kind.itemsize * width if count else start
    if start < 0 or end > len(document.binary) or described.get("buffer", 0) != 0:
        raise FileError(f"accessor {index} reads up to byte {end}, but the buffer has {len(document.binary)}")
    rows = np.ndarray((count, width), kind, document.binary, start, (stride, kind.itemsize))
    return np.ascontiguousarray(rows)


def _with_sparse(document: Document, sparse: dict[str, Any], values: np.ndarray, index: int) -> np.ndarray:
    """The values with the sparse accessor's replacements in place."""
    count = int(sparse["count"])
    at, new = sparse["indices"], sparse["values"]
    at_kind = np.dtype(_COMPONENTS[at["componentType"]])
    rows = _view(document, at["bufferView"], at.get("byteOffset", 0), at_kind, 1, count, index)[:, 0]
    replaced = values.copy()
    replaced[rows] = _view(
        document, new["bufferView"], new.get("byteOffset", 0), values.dtype, values.shape[1], count, index
    )
    return replaced


def _triangles(document: Document, primitive: dict[str, Any], mode: int, vertex_count: int) -> np.ndarray:
    """Vertices of each triangle, strips and fans cut up with their winding kept."""
    if "indices" in primitive:
        order = accessor(document, primitive["indices"])[:, 0].astype(np.int64)
    else:
        order = np.arange(vertex_count)
    if mode == _TRIANGLES:
        return order[: len(order) // 3 * 3].reshape(-1, 3).astype(np.int32)
    first = np.arange(max(len(order) - 2, 0))
    if mode == _FAN:
        corners = np.stack([np.zeros_like(first), first + 1, first + 2], axis=1)
    else:
        odd = first % 2  # every other triangle of a strip runs backwards
        corners = np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)
    return order[corners].astype(np.int32)


def _material(content: dict[str, Any], primitive: dict[str, Any]) -> str | None:
    """Name of a primitive's material; a nameless one is called by its number."""
    number = primitive.get("material")
    return None if number is None else content["materials"][number].get("name") or f"material {number}"


def _nodes(content: dict[str, Any]) -> Iterator[tuple[int, np.ndarray]]:
    """Nodes of the default scene depth first, each with its transform to the world (a skinned mesh has none)."""
    nodes = content.get("nodes", [])
    scenes = content.get("scenes", [])
    if scenes:
        roots = scenes[content.get("scene", 0)].get("nodes", [])
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [node for node in range(len(nodes)) if node not in children]
    pending = [(root, np.eye(4)) for root in reversed(roots)]
    seen: set[int] = set()
    while pending:
        node, parent = pending.pop()
        if node in seen:
            raise FileError(f"node {node} has two parents: a glTF scene must be a tree")
        seen.add(node)
        to_world = parent @ _local(nodes[node])
        yield node, np.eye(4) if "skin" in nodes[node] else to_world
        pending += [(child, to_world) for child in reversed(nodes[node].get("children", []))]


def _local(node: dict[str, Any]) -> np.ndarray:
    """A node's own transform: its matrix (stored by columns), or translation · rotation · scale."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    transform = np.eye(4)
    transform[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    transform[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), np.float64)
    transform[:3, 3] = node.get("translation", (0, 0, 0))
    return transform
