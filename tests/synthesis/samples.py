"""Small exemplars drawn with a few lines of NumPy, and small places to grow them on."""

import numpy as np
from numpy import ndarray

from tests.meshes import sphere
from texloom.domain.surface import Surface
from texloom.exemplar.exemplar import Exemplar, Map, from_array
from texloom.field.smooth import smoothest


def blobs(size: int = 32, channels: int = 3, seed: int = 0) -> ndarray:
    """Smooth spots of several sizes: waves of random direction, tone by tone, as 8-bit values."""
    rng = np.random.default_rng(seed)
    row, column = np.mgrid[:size, :size]
    waves = rng.normal(0, 0.45, (channels, 6, 2))
    phase = rng.random((channels, 6)) * 2 * np.pi
    tone = np.sin(waves[..., 0, None, None] * row + waves[..., 1, None, None] * column + phase[..., None, None]).sum(1)
    return np.moveaxis(np.clip(128 + 45 * tone, 0, 255), 0, -1).astype(np.uint8)


def exemplar(size: int = 32, channels: int = 3, seed: int = 0) -> Exemplar:
    """Blobs of one (grey) or three channels, or as a stack of a colour and a height map for more."""
    if channels <= 3:
        return from_array(blobs(size, channels, seed))
    stack = from_array(blobs(size, 3, seed)).maps | from_array(blobs(size, channels - 3, seed + 1), name="normal").maps
    return Exemplar(stack)


def holes(size: int = 32) -> ndarray:
    """A mask with a hole in the middle and a corner cut off."""
    mask = np.ones((size, size), bool)
    mask[size // 3 : size // 2, size // 3 : size // 2 + 2] = False
    mask[-size // 4 :, -size // 5 :] = False
    return mask


def flagged(mask: ndarray) -> Exemplar:
    """An exemplar whose second map tells masked texels (1) from usable ones (0), which have its attention as well."""
    base = from_array(blobs(len(mask)), mask=mask)
    return Exemplar(base.maps | {"flag": Map(1 - mask[..., None].astype(np.float32), "data", 32)}, mask)


def ball(sites: int = 700) -> Surface:
    """A sphere with a smooth field of four directions."""
    mesh = sphere(2)
    return Surface.build(mesh, smoothest(mesh, 4), texel=float(np.sqrt(mesh.face_areas.sum() / sites)))
