"""An exemplar from one image, or from a folder with one image a map."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool

from texloom.errors import ExemplarError, FileError
from texloom.exemplar.appearance import fill_masked
from texloom.exemplar.exemplar import Exemplar, Map, combine_masks, kind_of
from texloom.io.image import read_layers
from texloom.io.names import ORDER, PACKED, Role, role_of
from texloom.kernels.launch import parallel_map

_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp", ".tga", ".exr")


def read_exemplar(
    path: str | Path,
    *,
    mask: str | Path | Bool[np.ndarray, "row column"] | None = None,
    directx_normals: bool = False,
) -> Exemplar:
    """The exemplar in an image file or in a folder of maps.

    An image is a basecolor. Of a folder, each file's name tells its map (``texloom.io.names``); other images are left
    alone, and a lone image is a basecolor whatever its name. Opacity becomes the map "alpha"; texels of opacity 0, or
    dark in ``mask`` (or in the folder's mask file), are not used. ``directx_normals`` says that a normal map whose
    name does not tell has green down.

    Raises: FileError or ExemplarError, naming the file.
    """
    path = Path(path)
    try:
        if path.is_dir():
            return _read_folder(path, mask, directx_normals)
        colour, alpha = read_layers(path)
        return _assemble({"basecolor": colour}, alpha, mask)
    except ExemplarError as error:
        raise ExemplarError(f"{path.name}: {error}") from error


def read_mask(path: str | Path) -> Bool[np.ndarray, "row column"]:
    """True where an image is brighter than middle grey and not transparent."""
    grey, alpha = read_layers(path, kind="data")
    bright = grey.image.mean(axis=2) > 0.5
    return bright if alpha is None else bright & (alpha.image[..., 0] > 0.5)


def _read_folder(
    folder: Path, mask: str | Path | Bool[np.ndarray, "row column"] | None, directx_normals: bool
) -> Exemplar:
    roles = _roles_in(folder)
    names = [name for name in roles if name != "mask"]
    layers = parallel_map(lambda i: read_layers(roles[names[i]][0], kind=kind_of(names[i])), len(names))
    read = {name: layer[0] for name, layer in zip(names, layers, strict=True)}
    alphas = {name: layer[1] for name, layer in zip(names, layers, strict=True)}
    found = _unpack(read)
    for name in [name for name in found if kind_of(name) != "colour"]:
        found[name] = (
            _as_normal(found[name], *roles[name], directx_normals) if name == "normal" else _first(found[name])
        )
    if mask is None and "mask" in roles:
        mask = roles["mask"][0]
    return _assemble({name: found[name] for name in ORDER if name in found}, alphas.get("basecolor"), mask)


def _roles_in(folder: Path) -> dict[str, tuple[Path, Role]]:
    """The file of each role. Where a normal map comes both ways, the OpenGL one."""
    images = sorted(file for file in folder.iterdir() if file.suffix.lower() in _SUFFIXES and file.is_file())
    if not images:
        raise FileError(f"{folder.name} holds no image: put one file a map in it, such as basecolor.png and normal.png")
    roles: dict[str, tuple[Path, Role]] = {}
    for file in images:
        role = role_of(file)
        if role is None:
            continue
        rival = roles.get(role.name)
        if rival is not None and role.directx == rival[1].directx:
            raise FileError(f"{folder.name} has two files for {role.name}, {rival[0].name} and {file.name}: keep one")
        if rival is None or rival[1].directx:
            roles[role.name] = (file, role)
    if not set(roles) - {"mask"}:
        if len(images) == 1:
            return {"basecolor": (images[0], Role("basecolor"))}
        raise FileError(
            f"{folder.name} holds {len(images)} images, but no name tells its map: "
            "name them basecolor, normal, roughness, metallic, height, ao or alpha"
        )
    return roles


def _unpack(read: Mapping[str, Map]) -> dict[str, Map]:
    """Packed channels as maps of their own; a file of its own comes before a packed channel."""
    found = {name: m for name, m in read.items() if name not in ("orm", "metallic-roughness")}
    for packed in ("orm", "metallic-roughness"):
        if packed not in read:
            continue
        image = read[packed].image
        if image.shape[2] < 3:
            raise ExemplarError(f"the {packed} map has {image.shape[2]} channel, but packs {', '.join(PACKED)} in 3")
        for channel, name in enumerate(PACKED):
            if name not in found and not (packed == "metallic-roughness" and name == "ao"):
                found[name] = replace(read[packed], image=np.ascontiguousarray(image[..., channel : channel + 1]))
    return found


def _first(m: Map) -> Map:
    """A data map is one number a texel, also where it was stored as grey in three channels."""
    return m if m.image.shape[2] == 1 else replace(m, image=np.ascontiguousarray(m.image[..., :1]))


def _as_normal(m: Map, file: Path, role: Role, directx_normals: bool) -> Map:
    """A normal map with green up."""
    if m.image.shape[2] != 3:
        raise ExemplarError(f"{file.name} has {m.image.shape[2]} channel, but a normal map needs 3")
    if not (directx_normals if role.directx is None else role.directx):
        return m
    image = m.image.copy()
    image[..., 1] = 1.0 - image[..., 1]
    return replace(m, image=image)


def _assemble(
    maps: dict[str, Map], alpha: Map | None, mask: str | Path | Bool[np.ndarray, "row column"] | None
) -> Exemplar:
    """The exemplar, its mask gathered from opacity and from the mask asked for.

    Texels that are not used take the values of the nearest used ones: outputs read between texels, and nothing of what
    was masked may show there.
    """
    if alpha is not None:
        maps.setdefault("alpha", alpha)
    usable = read_mask(mask) if isinstance(mask, (str, Path)) else mask
    exemplar = Exemplar(maps, usable)
    if "alpha" in maps:
        exemplar = Exemplar(maps, combine_masks(usable, maps["alpha"].image[..., 0] > 0.0))
    if exemplar.mask is None:
        return exemplar
    shown = {name: replace(m, image=fill_masked(m.image, exemplar.mask)) for name, m in maps.items()}
    return Exemplar(shown, exemplar.mask)
