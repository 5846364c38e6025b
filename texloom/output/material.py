"""A stack of maps as a glTF material: base colour in sRGB, occlusion, roughness and metal packed, normals OpenGL."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from texloom.exemplar.exemplar import Map
from texloom.output.draft import Draft
from texloom.output.image import stored
from texloom.output.png import png_bytes


def add_material(draft: Draft, maps: Mapping[str, Map], *, name: str = "texloom", uv_set: int = 0) -> int:
    """Append the material and its textures. Maps glTF has no place for ("height", ...) become extra textures.

    Red of the packed texture is occlusion, green roughness, blue metal (glTF 2.0 §3.9.2); a missing map counts as 1,
    1 and 0. The first colour map is the base colour if none is called "basecolor".
    """
    slots: dict[str, Any] = {}
    pbr: dict[str, Any] = {"metallicFactor": 1.0 if "metallic" in maps else 0.0}
    pbr["roughnessFactor"] = 1.0 if "roughness" in maps else 0.9
    base = base_colour(maps)
    if base is not None:
        pbr["baseColorTexture"] = _slot(draft, _with_alpha(maps[base], maps.get("alpha")), base, uv_set)
    packed = _packed(maps)
    if packed is not None:
        texture = _slot(draft, packed, "occlusion-roughness-metallic", uv_set)
        if "roughness" in maps or "metallic" in maps:
            pbr["metallicRoughnessTexture"] = texture
        if "ao" in maps:
            slots["occlusionTexture"] = texture
    for normal in (name for name, map in maps.items() if map.kind == "normal"):
        slots.setdefault("normalTexture", _slot(draft, maps[normal], normal, uv_set))
    if "emissive" in maps:
        slots |= {"emissiveTexture": _slot(draft, maps["emissive"], "emissive", uv_set), "emissiveFactor": [1, 1, 1]}
    if "alpha" in maps:
        slots["alphaMode"] = "BLEND"
    extra = {name: _slot(draft, maps[name], name, uv_set) for name in maps if name not in _placed(maps, base)}
    if extra:
        slots["extras"] = {"texloom": extra}
    return draft.add("materials", {"name": name, "pbrMetallicRoughness": pbr, **slots})


def base_colour(maps: Mapping[str, Map]) -> str | None:
    """The map a viewer shows as colour: "basecolor", else the first colour, else the first of all that is data."""
    if "basecolor" in maps:
        return "basecolor"
    colours = [name for name, map in maps.items() if map.kind == "colour" and name != "emissive"]
    others = [name for name, map in maps.items() if map.kind == "data"] if len(maps) == 1 else []
    return next(iter(colours + others), None)


def _placed(maps: Mapping[str, Map], base: str | None) -> set[str]:
    """Maps that have a slot of their own."""
    normals = [name for name, map in maps.items() if map.kind == "normal"][:1]
    return {"ao", "roughness", "metallic", "emissive", "alpha", *normals, *([base] if base else [])}


def _slot(draft: Draft, map: Map, name: str, uv_set: int) -> dict[str, Any]:
    image = stored(map, 8 if map.bits == 8 else 16)
    reference = {"index": draft.texture(png_bytes(image, srgb=map.kind == "colour"), name)}
    return reference | ({"texCoord": uv_set} if uv_set else {})


def _with_alpha(map: Map, alpha: Map | None) -> Map:
    """Three colours, and opacity where there is one."""
    image = np.broadcast_to(map.image, (*map.image.shape[:2], 3)) if map.image.shape[2] == 1 else map.image
    if alpha is not None and image.shape[2] == 3:
        image = np.concatenate([image, alpha.image[..., :1]], axis=2)
    return Map(np.ascontiguousarray(image), map.kind, map.bits)


def _packed(maps: Mapping[str, Map]) -> Map | None:
    """Occlusion, roughness and metal as one map, None where all are missing."""
    given = [maps.get(name) for name in ("ao", "roughness", "metallic")]
    present = [map for map in given if map is not None]
    if not present:
        return None
    missing = (1.0, 1.0, 0.0)
    shape = present[0].image.shape[:2]
    planes = [
        np.full(shape, value, np.float32) if map is None else map.image[..., 0]
        for map, value in zip(given, missing, strict=True)
    ]
    return Map(np.stack(planes, axis=2), "data", max(map.bits for map in present))
