"""Pictures of a vocabulary: which texton each texel has, and what each texton looks like."""

from math import ceil, sqrt

import numpy as np
from jaxtyping import Float32, UInt8

from texloom.arrays import Image
from texloom.search.textons import Textons

_MASKED = np.array([40, 40, 40], np.uint8)
_GOLDEN = 0.6180339887  # turns of the colour circle from one texton to the next: no two near ones look alike
_SHADES = (1.0, 0.62, 0.82)
_ENLARGED = 3  # pixels a texel of a texton
_GAP = 1  # texels between textons


def texton_colours(textons: Textons, orientation: int = 0) -> UInt8[np.ndarray, "row column 3"]:
    """The texton map in false colours, one a texton (Magda & Kriegman 2003, fig. 2); masked texels are dark grey."""
    number = np.arange(textons.count)
    hue = 2 * np.pi * (_GOLDEN * number[:, None] + np.arange(3) / 3)
    colour = (0.55 + 0.45 * np.cos(hue)) * np.take(_SHADES, number % len(_SHADES))[:, None]
    palette = np.concatenate([np.rint(255 * colour).astype(np.uint8), _MASKED[None]])
    return palette[textons.labels[orientation]]


def texton_tiles(textons: Textons) -> UInt8[np.ndarray, "row column channel"]:
    """The mean window of each texton, the commonest first, as the eye sees the leading map."""
    width = textons.settings.width
    window = _mean_windows(textons, textons.image[..., : 3 if textons.exemplar.lead.image.shape[2] >= 3 else 1])
    order = np.argsort(-np.diff(textons.bucket_start), kind="stable")
    across = ceil(sqrt(textons.count))
    pitch = width + _GAP
    sheet = np.ones((ceil(textons.count / across) * pitch, across * pitch, window.shape[3]), np.float32)
    for place, texton in enumerate(order):
        row, column = np.array(divmod(place, across)) * pitch
        sheet[row : row + width, column : column + width] = window[texton]
    shown = np.rint(255 * np.clip(sheet, 0.0, 1.0)).astype(np.uint8)
    return shown.repeat(_ENLARGED, axis=0).repeat(_ENLARGED, axis=1)


def _mean_windows(textons: Textons, image: Image) -> Float32[np.ndarray, "texton width width channel"]:
    """What lies around the texels of each texton, on average; the image mirrored at its border."""
    width, count = textons.settings.width, textons.count
    rows, columns, channels = image.shape
    padded = np.pad(image, ((width // 2, width // 2), (width // 2, width // 2), (0, 0)), mode="symmetric")
    usable = textons.exemplar.usable
    label = textons.labels[0][usable]
    mean = np.empty((count, width, width, channels), np.float32)
    for down, across, channel in np.ndindex(width, width, channels):
        values = padded[down : down + rows, across : across + columns, channel][usable]
        mean[:, down, across, channel] = np.bincount(label, weights=values, minlength=count)
    return mean / np.diff(textons.bucket_start)[:, None, None, None].astype(np.float32)
