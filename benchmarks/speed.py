"""Seconds and memory: one image against G'MIC in the same run, and a large tileable stack."""

import sys
import tempfile
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks import machine, ours, report
from benchmarks.data import SEED

SAMPLE = "beans-192"
STACK = "bricks-rough-500"
SIZE, STACK_SIZE = 512, 2048
REPEATS = 3

_GMIC = """
import gmic, sys
gmic.run(f"srand 7 {sys.argv[1]} syntexturize_matchpatch 512,512 round cut 0,255 output {sys.argv[2]}")
"""
_GMIC_WARM = """
import gmic, sys, time
def run():
    start = time.perf_counter()
    gmic.run(f"srand 7 {sys.argv[1]} syntexturize_matchpatch 512,512 round cut 0,255 output {sys.argv[2]}")
    return time.perf_counter() - start
run()
with open(sys.argv[3], "w") as file:
    file.write(str(sorted(run() for _ in range(3))[1]))
"""


def main(data: Path) -> None:
    sample = data / "exemplars" / f"{SAMPLE}.png"
    rows = [_image(sample, threads) for threads in (1, 2)]
    stack = _stack(data / "pbr" / STACK)
    report.write("speed", title="Speed", sections=_sections(rows, stack), numbers={"image": rows, "stack": stack})


def _image(sample: Path, threads: int) -> dict[str, Any]:
    """Medians of a few runs, ours and G'MIC's in turn so that both see the same machine."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder, "out.png")
        line = ["image", sample, "-o", target, "--size", str(SIZE), "--seed", str(SEED)]
        ours.command(*line, threads=threads)  # kernels are compiled once, before the times
        cold = [(ours.command(*line, threads=threads), _gmic_process(sample, target, threads)) for _ in range(REPEATS)]
        return {
            "threads": threads,
            "warm": _warm(sample, threads),
            "gmic warm": _gmic_warm(sample, Path(folder), threads),
            "process": median(mine.seconds for mine, _ in cold),
            "gmic process": median(theirs.seconds for _, theirs in cold),
            "peak MB": median(mine.peak_megabytes for mine, _ in cold),
            "gmic peak MB": median(theirs.peak_megabytes for _, theirs in cold),
            "load before": machine.load(),
        }


def _warm(sample: Path, threads: int) -> float:
    """Median seconds of a call in a process that has made one before."""
    from texloom.kernels import launch

    launch.use(threads=threads)
    ours.grow(sample, SIZE)
    return median(ours.grow(sample, SIZE).seconds for _ in range(REPEATS))


def _gmic_process(sample: Path, target: Path, threads: int) -> ours.Spent:
    return ours.process([*_environment(threads), sys.executable, "-c", _GMIC, str(sample), str(target)])


def _gmic_warm(sample: Path, folder: Path, threads: int) -> float:
    noted = folder / "seconds"
    line = [sys.executable, "-c", _GMIC_WARM, str(sample), str(folder / "out.png"), str(noted)]
    ours.process([*_environment(threads), *line])
    return float(noted.read_text(encoding="utf-8"))


def _environment(threads: int) -> list[str]:
    """G'MIC works on OpenMP threads."""
    return ["env", f"OMP_NUM_THREADS={threads}"]


def _stack(folder: Path) -> dict[str, Any]:
    """A whole process that grows every map of a stack as one tile and writes it."""
    with tempfile.TemporaryDirectory() as target:
        line = ["image", folder, "-o", Path(target, "stack"), "--size", str(STACK_SIZE), "--tileable"]
        spent = ours.command(*line, "--seed", str(SEED))
        maps = len(list(Path(target, "stack").iterdir()))
    return {"maps": maps, "size": STACK_SIZE, "process": spent.seconds, "peak MB": spent.peak_megabytes}


def _sections(rows: list[dict[str, Any]], stack: dict[str, Any]) -> list[str]:
    return [
        f"{SIZE}² from {SAMPLE}, seed {SEED}: seconds, medians of {REPEATS}; *warm* is a call in a running process, "
        "*process* the whole command once kernels are cached.",
        report.table(list(rows[0]), [list(row.values()) for row in rows]),
        f"A tileable stack of {stack['maps']} maps ({STACK}) at {stack['size']}², the whole process: "
        f"**{stack['process']:.1f} s**, peak memory **{stack['peak MB'] / 1024:.2f} GB**.",
    ]
