"""Between stored sRGB and linear light (IEC 61966-2-1)."""

from functools import cache

import numpy as np
from jaxtyping import Float32, UInt8, UInt16


def encode(linear: Float32[np.ndarray, "*shape"]) -> Float32[np.ndarray, "*shape"]:
    """sRGB values of linear light; clipped to [0, 1], which is all that sRGB can hold."""
    light = np.clip(linear, 0.0, 1.0, dtype=np.float32)
    encoded = np.power(light, np.float32(1 / 2.4))
    encoded *= np.float32(1.055)
    encoded -= np.float32(0.055)
    dark = light <= np.float32(0.0031308)
    encoded[dark] = light[dark] * np.float32(12.92)
    return encoded


def decode(stored: UInt8[np.ndarray, "*shape"] | UInt16[np.ndarray, "*shape"]) -> Float32[np.ndarray, "*shape"]:
    """Linear light of stored sRGB integers, by table."""
    return np.take(_decode_table(np.iinfo(stored.dtype).max), stored)


@cache
def _decode_table(largest: int) -> Float32[np.ndarray, "value"]:
    """Linear light of every stored value ``0 .. largest``."""
    encoded = np.arange(largest + 1) / largest
    light = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return light.astype(np.float32)
