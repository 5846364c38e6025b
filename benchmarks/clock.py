"""Seconds of a call."""

import time
from collections.abc import Callable
from typing import Any


def best(work: Callable[[], Any], times: int = 5) -> tuple[float, Any]:
    """The least wall time of several runs after a first one, and what came out."""
    result = work()
    seconds = []
    for _ in range(times):
        last, result = once(work)
        seconds.append(last)
    return min(seconds), result


def once(work: Callable[[], Any]) -> tuple[float, Any]:
    """Wall time of a call, and what came out."""
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result
