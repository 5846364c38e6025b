"""glTF and GLB: every triangle of the scene in world space, and the file kept whole."""

import base64
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from texloom.errors import FileError
from texloom.io.triangles import Triangles
from texloom.mesh.gltf import Document, Primitive, accessor, pack, parse_json, primitives, unpack

_IMAGE_KINDS = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".webp": "image/webp"}


def read_gltf(path: Path, content: bytes) -> Triangles:
    """The triangles of a scene, counted as ``texloom.mesh.gltf.primitives`` counts them.

    ``document`` is a GLB that needs no other file: buffers and pictures beside a ``.gltf`` are packed into it.

    Raises: FileError, if a part of the file is missing or wrong.
    """
    try:
        document, whole = _self_contained(path, content)
        found = primitives(document)
        return _triangles(document, found, whole)
    except (KeyError, IndexError, TypeError, ValueError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"the glTF is not as its format demands: {type(error).__name__} {error}") from None


def _triangles(document: Document, found: list[Primitive], whole: bytes) -> Triangles:
    """Primitives strung together; mirrored nodes wind their triangles the other way."""
    vertices, faces, uv, material, primitive = [np.zeros((0, 3))], [np.zeros((0, 3), np.int32)], [], [], []
    names = list(dict.fromkeys(record.material for record in found if record.material is not None))
    for record in found:
        local = accessor(document, record.attributes["POSITION"]).astype(np.float64)
        vertices.append(local @ record.to_world[:3, :3].T + record.to_world[:3, 3])
        triangles = record.triangles
        if np.linalg.det(record.to_world[:3, :3]) < 0:
            triangles = triangles[:, [0, 2, 1]]
        faces.append(triangles + np.int32(record.vertex_start))
        uv.append(_corner_uv(document, record, triangles))
        number = -1 if record.material is None else names.index(record.material)
        material.append(np.full(len(triangles), number, np.int32))
        primitive.append(np.broadcast_to(np.array([record.node, record.primitive], np.int32), (len(triangles), 2)))
    has_uv = any(values is not None for values in uv)
    return Triangles(
        np.concatenate(vertices),
        np.concatenate(faces),
        np.concatenate([_or_nan(values, record) for values, record in zip(uv, found, strict=True)]) if has_uv else None,
        np.concatenate(material) if material else np.zeros(0, np.int32),
        tuple(names),
        np.concatenate(primitive) if primitive else np.zeros((0, 2), np.int32),
        whole,
    )


def _corner_uv(document: Document, record: Primitive, triangles: np.ndarray) -> np.ndarray | None:
    """Texture coordinates at corners, v up; None where the primitive has none."""
    if "TEXCOORD_0" not in record.attributes:
        return None
    stored = accessor(document, record.attributes["TEXCOORD_0"])[:, :2].astype(np.float32)
    return np.stack([stored[:, 0], 1 - stored[:, 1]], axis=1)[triangles]


def _or_nan(uv: np.ndarray | None, record: Primitive) -> np.ndarray:
    """Corners without coordinates, while other primitives have them, are NaN."""
    return np.full((len(record.triangles), 3, 2), np.nan, np.float32) if uv is None else uv


def _self_contained(path: Path, content: bytes) -> tuple[Document, bytes]:
    """The document with one inner buffer, and the bytes of it as a GLB (those read, if they are one already)."""
    document = unpack(content) if content[:4] == b"glTF" else Document(parse_json(content), b"")
    buffers = document.json.get("buffers", [])
    images = document.json.get("images", [])
    is_whole = content[:4] == b"glTF" and len(buffers) <= 1 and not any("uri" in entry for entry in [*buffers, *images])
    if is_whole:
        return document, content
    packed = _pack_buffers(path, document)
    return packed, pack(packed)


def _pack_buffers(path: Path, document: Document) -> Document:
    """All buffers in one, and pictures in buffer views of it."""
    content: dict[str, Any] = {**document.json}
    binary = bytearray()
    starts = []
    for buffer in content.get("buffers", []):
        binary += b"\0" * (-len(binary) % 4)
        starts.append(len(binary))
        stored = _fetch(path, buffer["uri"]) if "uri" in buffer else document.binary
        if len(stored) < buffer["byteLength"]:
            raise FileError(f"a buffer promises {buffer['byteLength']} bytes, but has {len(stored)}")
        binary += stored[: buffer["byteLength"]]
    views = [
        {**view, "buffer": 0, "byteOffset": view.get("byteOffset", 0) + starts[view["buffer"]]}
        for view in content.get("bufferViews", [])
    ]
    images = []
    for image in content.get("images", []):
        if "uri" in image:
            binary += b"\0" * (-len(binary) % 4)
            stored = _fetch(path, image["uri"])
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(stored)})
            binary += stored
            kind = image.get("mimeType") or _image_kind(image["uri"])
            image = {key: value for key, value in image.items() if key != "uri"}
            image |= {"bufferView": len(views) - 1, "mimeType": kind}
        images.append(image)
    content["buffers"] = [{"byteLength": len(binary)}]
    content["bufferViews"] = views
    if images:
        content["images"] = images
    return Document(content, bytes(binary))


def _fetch(path: Path, uri: str) -> bytes:
    """The bytes behind a URI: inline, or a file beside the glTF."""
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2])
    if "://" in uri:
        raise FileError(f"'{uri[:60]}' is on the network: save the glTF with its parts beside it, or as GLB")
    beside = path.parent / unquote(uri)
    try:
        return beside.read_bytes()
    except OSError:
        raise FileError(f"{beside.name}, which the glTF needs, is missing beside it") from None


def _image_kind(uri: str) -> str:
    """MIME type of a picture, from its URI."""
    if uri.startswith("data:"):
        return uri[5:].partition(";")[0]
    return _IMAGE_KINDS.get(Path(uri).suffix.lower(), "image/png")
