"""A stack of maps as a glTF material: base colour in sRGB, occlusion, roughness and metal packed, normals OpenGL."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from texloom.exemplar.exemplar import Map
from texloom.output.draft import Draft
from texloom.output.image import stored
from texloom.output.png import png_bytes

_PACKED = "occlusion-roughness-metallic"


class MaterialMaps(Mapping[str, Map]):
    """Maps that many files show: what a glTF material holds of them is encoded once, for the first of these files.

    Anywhere else they are the maps they were made of.
    """

    def __init__(self, maps: Mapping[str, Map]) -> None:
        self._maps = dict(maps)

    def __getitem__(self, name: str) -> Map:
        return self._maps[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._maps)

    def __len__(self) -> int:
        return len(self._maps)

    @cached_property
    def textures(self) -> dict[str, bytes]:
        """The PNG of each texture by its name, in the order a file holds them."""
        return {name: _png(map) for name, map in _shown(self._maps).items()}


def add_material(draft: Draft, maps: Mapping[str, Map], *, name: str = "texloom", uv_set: int = 0) -> int:
    """Append the material and its textures. Maps glTF has no place for ("height", ...) become extra textures.

    Red of the packed texture is occlusion, green roughness, blue metal (glTF 2.0 §3.9.2); a missing map counts as 1,
    1 and 0. The first colour map is the base colour if none is called "basecolor". ``MaterialMaps`` are encoded once.
    """
    textures = (maps if isinstance(maps, MaterialMaps) else MaterialMaps(maps)).textures
    at = {texture: _reference(draft.texture(png, texture), uv_set) for texture, png in textures.items()}
    slots: dict[str, Any] = {}
    pbr: dict[str, Any] = {"metallicFactor": 1.0 if "metallic" in maps else 0.0}
    pbr["roughnessFactor"] = 1.0 if "roughness" in maps else 0.9
    base, normal = base_colour(maps), _normal(maps)
    if base is not None:
        pbr["baseColorTexture"] = at[base]
    if "roughness" in maps or "metallic" in maps:
        pbr["metallicRoughnessTexture"] = at[_PACKED]
    if "ao" in maps:
        slots["occlusionTexture"] = at[_PACKED]
    if normal is not None:
        slots["normalTexture"] = at[normal]
    if "emissive" in maps:
        slots |= {"emissiveTexture": at["emissive"], "emissiveFactor": [1, 1, 1]}
    if "alpha" in maps:
        slots["alphaMode"] = "BLEND"
    extra = {name: at[name] for name in maps if name not in _placed(maps)}
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


def _shown(maps: Mapping[str, Map]) -> dict[str, Map]:
    """The maps as textures show them, by the textures' names."""
    shown: dict[str, Map] = {}
    base, packed, normal = base_colour(maps), _packed(maps), _normal(maps)
    if base is not None:
        shown[base] = _with_alpha(maps[base], maps.get("alpha"))
    if packed is not None:
        shown[_PACKED] = packed
    own = [name for name in (normal, "emissive") if name is not None and name in maps]
    others = [name for name in maps if name not in _placed(maps)]
    return shown | {name: maps[name] for name in own + others}


def _placed(maps: Mapping[str, Map]) -> set[str | None]:
    """Maps that have a slot of their own."""
    return {"ao", "roughness", "metallic", "emissive", "alpha", _normal(maps), base_colour(maps)}


def _normal(maps: Mapping[str, Map]) -> str | None:
    return next((name for name, map in maps.items() if map.kind == "normal"), None)


def _reference(texture: int, uv_set: int) -> dict[str, int]:
    return {"index": texture} | ({"texCoord": uv_set} if uv_set else {})


def _png(map: Map) -> bytes:
    return png_bytes(stored(map, 8 if map.bits == 8 else 16), srgb=map.kind == "colour")


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
