"""Which map a file is, from its name: as Poly Haven, ambientCG, glTF exporters and people write them."""

import re
from dataclasses import dataclass
from pathlib import PurePath

_ROLES = {
    "basecolor": "basecolor albedo diffuse diff color colour col",
    "emissive": "emissive emission emit",
    "normal": "normal normals nor nrm normalgl normaldx",
    "roughness": "roughness rough rgh",
    "metallic": "metallic metalness metal",
    "height": "height displacement disp bump",
    "ao": "ao occlusion ambientocclusion",
    "alpha": "alpha opacity",
    "mask": "mask",
    "orm": "orm arm",
}
_ROLE_OF_WORD = {word: role for role, words in _ROLES.items() for word in words.split()}
_DIRECTX = {"dx", "directx", "normaldx"}
_OPENGL = {"gl", "opengl", "normalgl"}

ORDER = ("basecolor", "emissive", "normal", "roughness", "metallic", "height", "ao", "alpha")
"""Maps of a stack in the order they take: the first that is there leads."""

PACKED = ("ao", "roughness", "metallic")
"""What the red, green and blue of a packed "orm" hold."""


@dataclass(frozen=True)
class Role:
    """What a file holds: a map's name, "mask", or "orm"; and which way a normal's green points, if the name says."""

    name: str
    directx: bool | None = None  # True: green down; False: green up; None: the name does not say


def role_of(path: PurePath | str) -> Role | None:
    """The role of a file, or None. The last telling word counts: ``rough_metal_diff_1k.png`` is a basecolor."""
    stem = PurePath(path).stem
    words = re.findall(r"[a-z0-9]+", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", stem).lower())
    for place in reversed(range(len(words))):
        name = _ROLE_OF_WORD.get(words[place])
        if name == "normal":
            near = set(words[place : place + 2])
            return Role(name, True if near & _DIRECTX else False if near & _OPENGL else None)
        if name in ("roughness", "metallic") and {"roughness", "metallic"} <= set(words[max(place - 1, 0) : place + 1]):
            return Role("orm" if "occlusion" in words else "metallic-roughness")
        if name is not None:
            return Role(name)
    return None
