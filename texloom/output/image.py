"""Maps written as image files, each the way its exemplar map was stored."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from jaxtyping import Float32

from texloom.arrays import Image
from texloom.errors import FileError, ParameterError
from texloom.exemplar.colour import encode
from texloom.exemplar.exemplar import Map
from texloom.kernels.launch import parallel_map
from texloom.output.atomic import atomic
from texloom.output.exr import exr_bytes
from texloom.output.png import png_bytes

_ROWS = 64  # rows encoded at a time


def write_image(path: str | Path, map: Map, *, settings: Mapping[str, str] | None = None) -> Path:
    """One map as one file; the suffix chooses the format.

    PNG holds 8 or 16 bits (a float map becomes 16); TIFF keeps 8, 16 or float; EXR is float; JPEG is 8 bits. Integers
    of a colour are sRGB; floats stay linear light, as film expects. ``settings`` are stored in the file as text.
    """
    path = Path(path)
    writer = _writer(path)
    with atomic(path) as beside:
        writer(beside, map, dict(settings or {}))
    return path


def write_images(
    path: str | Path, maps: Mapping[str, Map], *, settings: Mapping[str, str] | None = None, suffix: str = ".png"
) -> list[Path]:
    """A stack of maps: a folder with one file a map, or a single file where there is one map (with "alpha" or not).

    ``path`` is a file if its suffix is that of an image, else a folder, made where it is missing; all files of a folder
    appear together or not at all. ``suffix`` is the format in a folder; a float map in a folder of PNGs becomes EXR.
    """
    path = Path(path)
    if path.suffix.lower() in _WRITERS or (path.suffix and not path.is_dir()):
        return [write_image(path, single_map(maps, path), settings=settings)]
    targets = {name: path / f"{name}{_suffix_for(map, suffix)}" for name, map in maps.items()}
    writers = {name: _writer(target) for name, target in targets.items()}
    made = not path.exists()
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{path} cannot be made ({error.strerror}): choose another folder") from error
    try:
        with ExitStack() as files:
            for name, target in targets.items():
                writers[name](files.enter_context(atomic(target)), maps[name], dict(settings or {}))
    except BaseException:
        if made and not any(path.iterdir()):
            path.rmdir()
        raise
    return list(targets.values())


def single_map(maps: Mapping[str, Map], path: Path) -> Map:
    """The one map to write to a single file: a stack of one, or a colour with its "alpha" as a further channel."""
    names = [name for name in maps if name != "alpha"] or ["alpha"]
    if len(names) > 1:
        raise ParameterError(
            f"{path.name} is one file, but there are {len(maps)} maps ({', '.join(maps)}): give a folder instead"
        )
    first = maps[names[0]]
    if names[0] == "alpha" or "alpha" not in maps or first.image.shape[2] not in (1, 3):
        return first
    layered = np.concatenate([first.image, maps["alpha"].image], axis=2)
    return Map(layered, first.kind, max(first.bits, maps["alpha"].bits))


def stored(map: Map, bits: int) -> np.ndarray:
    """Values as a file of this depth stores them: colours as sRGB in integers, floats untouched; alpha never encoded.

    A map read from 8 or 16 bits and copied texel by texel gives back exactly the integers it was read from.
    """
    if bits == 32:
        return np.ascontiguousarray(map.image, np.float32)
    result = np.empty(map.image.shape, np.uint8 if bits == 8 else np.uint16)
    colours = 1 if map.image.shape[2] < 3 else 3

    def store_rows(number: int) -> None:
        rows = slice(number * _ROWS, (number + 1) * _ROWS)
        values = map.image[rows]
        if map.kind == "colour":
            values = np.concatenate([encode(values[..., :colours]), values[..., colours:]], axis=2)
        result[rows] = _quantised(values, bits)

    parallel_map(store_rows, -(-len(result) // _ROWS))
    return result


def _quantised(values: Float32[np.ndarray, "*shape"], bits: int) -> np.ndarray:
    largest = 2**bits - 1
    return np.rint(np.clip(values, 0.0, 1.0) * np.float32(largest)).astype(np.uint8 if bits == 8 else np.uint16)


def _write_png(path: Path, map: Map, settings: dict[str, str]) -> None:
    image = stored(map, 8 if map.bits == 8 else 16)
    path.write_bytes(png_bytes(image, text=settings, srgb=map.kind == "colour"))


def _write_exr(path: Path, map: Map, settings: dict[str, str]) -> None:
    path.write_bytes(exr_bytes(stored(map, 32), text=settings))


def _write_tiff(path: Path, map: Map, settings: dict[str, str]) -> None:
    import tifffile

    image = stored(map, map.bits)
    grey = image.shape[2] < 3
    extra = ["unassalpha"] if image.shape[2] in (2, 4) else None
    tifffile.imwrite(
        path,
        image[..., 0] if image.shape[2] == 1 else image,
        photometric="minisblack" if grey else "rgb",
        extrasamples=extra,
        description="\n".join(f"{key}: {value}" for key, value in settings.items()),
        metadata=None,
        compression="zlib",
        software=False,
    )


def _write_jpeg(path: Path, map: Map, settings: dict[str, str]) -> None:
    from PIL import Image as Pillow

    image = stored(map, 8)
    image = image[..., 0] if image.shape[2] < 3 else image[..., :3]
    comment = "\n".join(f"{key}: {value}" for key, value in settings.items())
    Pillow.fromarray(image).save(path, quality=95, subsampling=0, comment=comment.encode())


_WRITERS: dict[str, Callable[[Path, Map, dict[str, str]], None]] = {
    ".png": _write_png,
    ".tif": _write_tiff,
    ".tiff": _write_tiff,
    ".exr": _write_exr,
    ".jpg": _write_jpeg,
    ".jpeg": _write_jpeg,
}


def _writer(path: Path) -> Callable[[Path, Map, dict[str, str]], None]:
    try:
        return _WRITERS[path.suffix.lower()]
    except KeyError:
        raise FileError(
            f"{path.name}: cannot write {path.suffix or 'no suffix'}: use .png, .tif, .exr or .jpg"
        ) from None


def _suffix_for(map: Map, suffix: str) -> str:
    return ".exr" if map.bits == 32 and suffix.lower() == ".png" else suffix


def encoded_picture(linear: Image) -> np.ndarray:
    """Linear light as 8-bit sRGB, for previews."""
    return stored(Map(linear, "colour", 8), 8)
