"""Matrix products that give the same bits on any number of threads.

A threaded product splits its sums by the number of threads, so their rounding would follow the machine. Products here
run on one thread each, in blocks of fixed size, and our own pool works on the blocks.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from texloom.kernels.launch import parallel_map


@contextmanager
def single_threaded() -> Iterator[None]:
    """Inside, every matrix product runs on the calling thread alone."""
    with _controller("scipy.linalg" in sys.modules).limit(limits=1, user_api="blas"):
        yield


def over_blocks(function: Callable[[int, int], Any], count: int, block: int) -> list[Any]:
    """``function(first, last)`` over consecutive blocks of items, in the pool, products single-threaded."""
    starts = range(0, count, block)
    with single_threaded():
        return parallel_map(lambda i: function(starts[i], min(starts[i] + block, count)), len(starts))


@cache
def _controller(scipy_loaded: bool) -> Any:
    """Finding the BLAS libraries takes milliseconds, so once, and again when SciPy has brought its own."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
