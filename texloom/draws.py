"""Counter-based random draws: a hash of (seed, level, pass, index), never a state.

The same key gives the same number whatever the order, the thread count or the batch a site falls in.
"""

import numpy as np
from jaxtyping import Float32, Int, UInt32

_GOLDEN = np.uint32(0x9E3779B9)


def _mix(x: UInt32[np.ndarray, "..."]) -> UInt32[np.ndarray, "..."]:
    """The lowbias32 finalizer (Wellons 2018): every input bit flips each output bit with probability near 1/2."""
    x = x ^ (x >> np.uint32(16))
    x = x * np.uint32(0x7FEB352D)
    x = x ^ (x >> np.uint32(15))
    x = x * np.uint32(0x846CA68B)
    return x ^ (x >> np.uint32(16))


def key(seed: int, *counters: int) -> int:
    """One 32-bit key from a seed and any counters (level, pass, purpose), for kernels and for the draws below."""
    value = np.array([0], np.uint32)
    for counter in (seed, *counters):
        value = _mix(value + _GOLDEN + np.uint32(counter & 0xFFFFFFFF))
    return int(value[0])


def bits(seed: int, *counters: int, index: Int[np.ndarray, "n"]) -> UInt32[np.ndarray, "n"]:
    """32 random bits for every index."""
    return _mix(np.uint32(key(seed, *counters)) ^ _mix(np.asarray(index).astype(np.uint32) * _GOLDEN))


def uniform(seed: int, *counters: int, index: Int[np.ndarray, "n"]) -> Float32[np.ndarray, "n"]:
    """Uniform in [0, 1) for every index, 24 bits deep."""
    return (bits(seed, *counters, index=index) >> np.uint32(8)).astype(np.float32) * np.float32(2.0**-24)


def permutation(seed: int, *counters: int, count: int) -> Int[np.ndarray, "count"]:
    """A random order of ``range(count)``; equal bits keep the lower index first."""
    return np.argsort(bits(seed, *counters, index=np.arange(count)), kind="stable")
