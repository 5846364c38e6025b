"""A glTF document being written: accessors, textures and materials appended to what is already there."""

import copy
from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Shaped

import texloom
from texloom.mesh.gltf import Document, pack

_COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_VERTICES, _INDICES = 34962, 34963  # buffer view targets
_LINEAR, _MIPMAPS, _REPEAT, _CLAMP = 9729, 9987, 10497, 33071


class Draft:
    """Starts empty or from a document, whose binary part stays as it is: what is new comes behind it.

    New textures repeat, or with ``clamp`` end in their outermost texels. Arrays are not copied: they must stay as they
    are until the document is packed.
    """

    def __init__(self, document: Document | None = None, *, clamp: bool = False) -> None:
        self._wrap = _CLAMP if clamp else _REPEAT
        self.json: dict[str, Any] = copy.deepcopy(document.json) if document else {"asset": {"version": "2.0"}}
        self._binary: list[Any] = [document.binary] if document else []
        self._length = len(document.binary) if document else 0

    def add(self, kind: str, entry: dict[str, Any]) -> int:
        """Append to one of the document's lists ("materials", "nodes", ...); the index there."""
        entries = self.json.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def attribute(self, values: Shaped[np.ndarray, "vertex width"], *, normalized: bool = False) -> int:
        """A vertex attribute: an accessor of its own buffer view, rows padded to four bytes, with its bounds."""
        values = np.ascontiguousarray(values)
        row = values.dtype.itemsize * values.shape[1]
        stride = -(-row // 4) * 4
        view: dict[str, Any] = {"target": _VERTICES}
        content = values
        if stride != row:
            view["byteStride"] = stride
            content = np.zeros((len(values), stride), np.uint8)
            content[:, :row] = values.view(np.uint8).reshape(len(values), row)
        entry = self._described(values, self._view(content, view))
        if normalized:
            entry["normalized"] = True
        return self.add("accessors", entry)

    def indices(self, faces: Shaped[np.ndarray, "face 3"]) -> int:
        """Triangle corners as unsigned 32-bit integers."""
        flat = np.ascontiguousarray(faces, "<u4").reshape(-1, 1)
        return self.add("accessors", self._described(flat, self._view(flat, {"target": _INDICES})))

    def texture(self, png: bytes, name: str) -> int:
        """A mipmapped texture of a PNG kept inside the document."""
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self._view(png, {})})
        sampler = {"magFilter": _LINEAR, "minFilter": _MIPMAPS, "wrapS": self._wrap, "wrapT": self._wrap}
        samplers = self.json.setdefault("samplers", [])
        if sampler not in samplers:
            samplers.append(sampler)
        return self.add("textures", {"source": image, "sampler": samplers.index(sampler)})

    def packed(self, settings: Mapping[str, str]) -> bytes:
        """The document as a GLB, with what made it."""
        asset = self.json["asset"]
        asset["generator"] = f"texloom {version()}"
        if settings:
            asset.setdefault("extras", {})["texloom"] = dict(settings)
        return pack(Document(self.json, b"".join(self._binary)))

    def _view(self, content: bytes | np.ndarray, entry: dict[str, Any]) -> int:
        """A buffer view of new bytes, on a border of four."""
        size = content.nbytes if isinstance(content, np.ndarray) else len(content)
        gap = -self._length % 4
        self._binary += [b"\0" * gap, content]
        described = {"buffer": 0, "byteOffset": self._length + gap, "byteLength": size, **entry}
        self._length += gap + size
        return self.add("bufferViews", described)

    @staticmethod
    def _described(values: np.ndarray, view: int) -> dict[str, Any]:
        entry: dict[str, Any] = {
            "bufferView": view,
            "componentType": _COMPONENTS[values.dtype.str[1:]],
            "type": _TYPES[values.shape[1]],
            "count": len(values),
        }
        if len(values):
            along = np.ascontiguousarray(values.T)  # a hundred times as fast as column by column
            entry |= {"min": along.min(axis=1).tolist(), "max": along.max(axis=1).tolist()}
        return entry


def version() -> str:
    """Version of this package, as installed."""
    from importlib.metadata import PackageNotFoundError
    from importlib.metadata import version as installed

    try:
        return installed(texloom.__name__)
    except PackageNotFoundError:
        return "unknown"
