"""Image files to stored values and to maps; the colour space is decided here, once.

PNG, JPEG, TIFF, WebP, BMP and whatever else Pillow reads, with every bit of 16-bit PNGs; TIFF of any depth; EXR.
"""

from pathlib import Path

import numpy as np
from PIL import Image as Pillow
from PIL import ImageOps, UnidentifiedImageError

from texloom.arrays import MapKind
from texloom.errors import FileError
from texloom.exemplar.exemplar import Map, split_alpha, to_map
from texloom.io.exr import read_exr

# What each Pillow mode turns into: grey stays grey, all else becomes colour.
_MODES = {"1": "L", "L": "L", "LA": "LA", "La": "LA", "RGB": "RGB", "RGBA": "RGBA", "RGBa": "RGBA", "PA": "RGBA"}


def read_image(path: str | Path, *, kind: MapKind = "colour") -> Map:
    """One image as a map, its opacity left out. Colours become linear light; data and normals stay as stored.

    Raises: FileError, if it cannot be read.
    """
    return read_layers(path, kind=kind)[0]


def read_layers(path: str | Path, *, kind: MapKind = "colour") -> tuple[Map, Map | None]:
    """One image as a map, and its opacity as another where it has any that is not whole."""
    colour, alpha = split_alpha(read_stored(path))
    return to_map(colour, kind), None if alpha is None else to_map(alpha, "data")


def read_stored(path: str | Path) -> np.ndarray:
    """Stored values (row, column, 1 to 4 channels) as uint8, uint16 or float32, turned upright as EXIF says."""
    path = Path(path)
    if not path.exists():
        raise FileError(f"{path}: no such file")
    if path.is_dir():
        raise FileError(f"{path} is a folder: give an image")
    if path.stat().st_size == 0:
        raise FileError(f"{path.name} is empty (0 bytes): export it again")
    if path.suffix.lower() in (".tif", ".tiff"):
        return _read_tiff(path)
    return read_exr(path) if path.suffix.lower() == ".exr" else _read_with_pillow(path)


def _read_with_pillow(path: Path) -> np.ndarray:
    try:
        with Pillow.open(path) as picture:
            deep = _deep_png_layout(picture)
            if deep is not None:
                return _read_deep_png(path, deep)
            upright = ImageOps.exif_transpose(picture)
            return _pillow_values(upright)
    except UnidentifiedImageError as error:
        raise FileError(f"{path.name} is not an image that can be read: use PNG, JPEG, TIFF or WebP") from error
    except (OSError, SyntaxError, ValueError, Pillow.DecompressionBombError) as error:
        raise FileError(f"{path.name} cannot be read ({_brief(error)}): export it again") from error


def _pillow_values(picture: Pillow.Image) -> np.ndarray:
    """Stored values of an open picture, in the least number of channels that holds them."""
    if picture.mode.startswith("I;16"):
        return np.asarray(picture).astype(np.uint16)[..., None]
    if picture.mode == "I":
        return np.clip(np.asarray(picture), 0, 65535).astype(np.uint16)[..., None]
    if picture.mode == "F":
        return np.asarray(picture, np.float32)[..., None]
    if picture.mode == "P" or "transparency" in picture.info:
        mode = "RGBA" if "transparency" in picture.info else "RGB"
    else:
        mode = _MODES.get(picture.mode, "RGB")
    values = np.asarray(picture if picture.mode == mode else picture.convert(mode))
    return values[..., None] if values.ndim == 2 else values


def _deep_png_layout(picture: Pillow.Image) -> str | None:
    """How Pillow would lay out the bytes of a PNG of 16 bits and several channels; None for any other picture."""
    tile = getattr(picture, "tile", None)
    layout = str(tile[0].args) if picture.format == "PNG" and tile else ""
    return layout if layout in ("LA;16B", "RGB;16B", "RGBA;16B") else None


def _read_deep_png(path: Path, layout: str) -> np.ndarray:
    """All 16 bits of a PNG of several channels.

    Pillow keeps the high byte of each value only. Told that the file is little-endian, it takes the low byte for the
    high one: two readings give both. A grey pixel with opacity is 4 bytes, the size of an 8-bit RGBA pixel.
    """
    if layout == "LA;16B":
        return _decode_as(path, "RGBA").view(">u2").astype(np.uint16)
    high, low = _decode_as(path, layout), _decode_as(path, layout.replace("16B", "16L"))
    return high.astype(np.uint16) << np.uint16(8) | low


def _decode_as(path: Path, layout: str) -> np.ndarray:
    """The pixels of a PNG, its bytes laid out as ``layout`` whatever the file says."""
    with Pillow.open(path) as picture:
        tile = getattr(picture, "tile")[0]  # noqa: B009  (the type of an open file is not public)
        setattr(picture, "tile", [tile._replace(args=layout)])  # noqa: B010
        return np.array(picture)


def _read_tiff(path: Path) -> np.ndarray:
    """First page of a TIFF of any depth; layouts and compressions that tifffile lacks go through Pillow."""
    import logging

    import tifffile

    logging.getLogger("tifffile").setLevel(logging.CRITICAL)  # what is wrong with a file, our error says
    try:
        with tifffile.TiffFile(path) as file:
            page = file.pages.first
            if page.photometric not in (tifffile.PHOTOMETRIC.MINISBLACK, tifffile.PHOTOMETRIC.RGB):
                return _read_with_pillow(path)
            values = page.asarray()
    except Exception as error:  # tifffile raises whatever its parser and codecs raise
        if "imagecodecs" in str(error):
            return _read_with_pillow(path)
        raise FileError(f"{path.name} cannot be read ({_brief(error)}): export it again") from error
    if values.ndim == 2:
        values = values[..., None]
    if values.ndim != 3:
        raise FileError(f"{path.name} holds a volume of shape {values.shape}: save one picture")
    return _common_type(values[..., :4], path)


def _common_type(values: np.ndarray, path: Path) -> np.ndarray:
    """Values as uint8, uint16 or float32."""
    if values.dtype == bool:
        return values * np.uint8(255)
    if values.dtype.kind == "f":
        return values.astype(np.float32)
    if values.dtype in (np.uint8, np.uint16):
        return values.astype(values.dtype.newbyteorder("="))
    raise FileError(f"{path.name} holds {values.dtype} values: save it as 8-bit, 16-bit or float")


def _brief(error: BaseException) -> str:
    """The first line of another library's complaint."""
    return str(error).strip().split("\n")[0][:120] or type(error).__name__
