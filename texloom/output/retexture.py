"""A GLB that came in goes back with new maps on the primitives that were textured, and everything else as it was."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Float, Shaped

from texloom.exemplar.exemplar import Map
from texloom.mesh.gltf import Document, Primitive, accessor, primitives, unpack
from texloom.mesh.model import Model
from texloom.output.corners import shared_corners, unshared_corners
from texloom.output.draft import Draft
from texloom.output.material import add_material
from texloom.output.textured import add_further, flipped


def retextured_glb(
    model: Model,
    maps: Mapping[str, Map],
    *,
    uv: Float[np.ndarray, "face 3 2"] | None = None,
    tangents: Float[np.ndarray, "face 3 4"] | None = None,
    further: Mapping[str, Shaped[np.ndarray, "face 3 n"]] | None = None,
    clamp: bool = False,
    settings: Mapping[str, str] | None = None,
) -> bytes:
    """The model's file with its textured primitives on the baked maps.

    With ``uv`` (a fresh atlas, v up) vertices are split at the seams and carry all their attributes and morph targets
    along; without, the file's own first UV set is used and only the material changes (and TANGENT, where given, in
    world space). Nodes, transforms, skins, animations, other materials and all other data stay byte for byte. Colours
    at vertices would tint the maps: they are kept under the name ``_COLOR_0``. A mesh that several nodes show is
    copied for each node that is textured. ``further`` and ``clamp`` are those of a ``TexturedMesh``; further
    attributes need ``uv``, and make every corner a vertex of its own.
    """
    assert model.document is not None and model.primitive is not None, "only a glTF model can be retextured"
    assert uv is not None or not further, "further attributes come with new UVs"
    document = unpack(model.document)
    draft = Draft(document, clamp=clamp)
    material = _add_material_like(draft, document, model, maps)
    for part in primitives(document):
        chosen = np.flatnonzero((model.primitive == (part.node, part.primitive)).all(axis=1))
        if not len(chosen):
            continue
        entry = _own_primitive(draft, part)
        entry["material"] = material
        if "COLOR_0" in entry["attributes"]:
            entry["attributes"]["_COLOR_0"] = entry["attributes"].pop("COLOR_0")
        corner = (model.corner_origin[chosen] - part.vertex_start).reshape(-1)
        tangent = None if tangents is None else _to_local(part, tangents[chosen].reshape(-1, 4))
        if uv is None:
            if tangent is not None:
                entry["attributes"]["TANGENT"] = draft.attribute(_at_vertices(tangent, corner, part.vertex_count))
        else:
            beside = {name: values[chosen] for name, values in (further or {}).items()}
            _split(draft, document, entry, corner, uv[chosen].reshape(-1, 2), tangent, beside)
    return draft.packed(settings or {})


def _add_material_like(draft: Draft, document: Document, model: Model, maps: Mapping[str, Map]) -> int:
    """The new material, sided like the one it replaces."""
    number = add_material(draft, maps)
    assert model.primitive is not None
    node, primitive = (int(value) for value in model.primitive[0])
    old = document.json["meshes"][document.json["nodes"][node]["mesh"]]["primitives"][primitive].get("material")
    if old is not None:
        before = document.json["materials"][old]
        kept = {key: value for key, value in before.items() if key in ("name", "doubleSided")}
        draft.json["materials"][number] |= kept
    return number


def _own_primitive(draft: Draft, part: Primitive) -> dict[str, Any]:
    """The primitive's entry, in a mesh that no other node shows."""
    nodes = draft.json["nodes"]
    mesh = nodes[part.node]["mesh"]
    if sum(node.get("mesh") == mesh for node in nodes) > 1:
        copy = dict(draft.json["meshes"][mesh])
        copy["primitives"] = [{**entry, "attributes": dict(entry["attributes"])} for entry in copy["primitives"]]
        mesh = nodes[part.node]["mesh"] = draft.add("meshes", copy)
    return draft.json["meshes"][mesh]["primitives"][part.primitive]


def _split(
    draft: Draft,
    document: Document,
    entry: dict[str, Any],
    corner: Shaped[np.ndarray, "corner"],
    uv: Float[np.ndarray, "corner 2"],
    tangent: Float[np.ndarray, "corner 4"] | None,
    further: Mapping[str, Shaped[np.ndarray, "face 3 n"]],
) -> None:
    """New vertices, one for each (old vertex, UV), with every attribute of the old vertex and the new UV.

    With further attributes it is one for each corner.
    """
    first, vertex = unshared_corners(len(corner)) if further else shared_corners(corner, uv)
    old = corner[first]
    entry["attributes"] = _carried(draft, document, entry["attributes"], old)
    if "targets" in entry:
        entry["targets"] = [_carried(draft, document, target, old) for target in entry["targets"]]
    entry["attributes"]["TEXCOORD_0"] = draft.attribute(flipped(uv[first]))
    entry["attributes"].pop("TANGENT", None)
    if tangent is not None:
        entry["attributes"]["TANGENT"] = draft.attribute(tangent[first].astype("<f4"))
    entry["attributes"] |= add_further(draft, further)
    entry["indices"] = draft.indices(vertex.reshape(-1, 3))
    entry.pop("mode", None)  # strips and fans are triangles now


def _carried(
    draft: Draft, document: Document, attributes: Mapping[str, int], old: Shaped[np.ndarray, "vertex"]
) -> dict[str, int]:
    """New accessors with the rows of the old vertices, stored as they were."""
    carried = {}
    for name, index in attributes.items():
        described = dict(document.json["accessors"][index])
        normalized = bool(described.pop("normalized", False))
        as_stored = Document({**document.json, "accessors": {index: described}}, document.binary)
        carried[name] = draft.attribute(accessor(as_stored, index)[old], normalized=normalized)
    return carried


def _to_local(part: Primitive, tangents: Float[np.ndarray, "corner 4"]) -> Float[np.ndarray, "corner 4"]:
    """World tangents in the node's own space; handedness is that of the world, where viewers build the bitangent."""
    local = tangents.astype(np.float64)
    local[:, :3] = local[:, :3] @ np.linalg.pinv(part.to_world[:3, :3]).T
    length = np.linalg.norm(local[:, :3], axis=1, keepdims=True)
    local[:, :3] = np.divide(local[:, :3], length, out=np.tile([1.0, 0.0, 0.0], (len(local), 1)), where=length > 0)
    return local


def _at_vertices(
    tangent: Float[np.ndarray, "corner 4"], corner: Shaped[np.ndarray, "corner"], count: int
) -> Float[np.ndarray, "vertex 4"]:
    """The tangent of the first corner at each vertex; vertices in no face take any."""
    result = np.tile(np.array([1.0, 0.0, 0.0, 1.0], "<f4"), (count, 1))
    result[corner[::-1]] = tangent[::-1]
    return result
