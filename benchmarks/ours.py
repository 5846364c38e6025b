"""The calls of texloom that the benchmarks time."""

import os
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.data import SEED


@dataclass(frozen=True, eq=False)
class Grown:
    """Stored maps of a picture grown in this process, and the seconds from loaded sample to them."""

    maps: dict[str, np.ndarray]
    seconds: float
    stages: dict[str, float]


def grow(sample: Path, size: int, *, method: Any = None, tileable: bool = False, seed: int = SEED) -> Grown:
    """A method (None: the default) on a square of ``size`` texels; reading the sample is not timed."""
    from texloom.domain.grid import Grid
    from texloom.io.stack import read_exemplar
    from texloom.output.gather import gather_images
    from texloom.output.image import stored
    from texloom.synthesis.synthesize import synthesize

    exemplar = read_exemplar(sample)
    start = time.perf_counter()
    result = synthesize(exemplar, Grid(size, size, wrap=tileable), method, seed=seed)
    maps = gather_images(result.sources, exemplar, rows=size, columns=size)
    pictures = {name: stored(map, map.bits) for name, map in maps.items()}
    return Grown(pictures, time.perf_counter() - start, result.seconds)


@dataclass(frozen=True)
class Spent:
    """What a finished process took."""

    seconds: float
    peak_megabytes: float


def command(*arguments: str | Path, threads: int | None = None) -> Spent:
    """Wall seconds and peak resident memory of one whole ``texloom`` process."""
    chosen = [] if threads is None else ["--threads", str(threads)]
    return process([str(Path(sys.executable).with_name("texloom")), *map(str, arguments), *chosen])


def process(line: Sequence[str]) -> Spent:
    """Wall seconds and peak resident memory of one process; its output is dropped, its failure is ours."""
    start = time.perf_counter()
    with subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as child:
        message = child.stderr.read() if child.stderr else ""
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise RuntimeError(f"{' '.join(line[:4])} … ended with {child.returncode}: {message.strip()[-300:]}")
    return Spent(time.perf_counter() - start, _megabytes(usage))


def _megabytes(usage: resource.struct_rusage) -> float:
    return usage.ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
