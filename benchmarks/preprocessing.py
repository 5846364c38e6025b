"""Seconds to learn a sample's textons, and to read them again."""

import tempfile
from pathlib import Path
from typing import Any

from benchmarks.clock import best
from benchmarks.data import SEED
from benchmarks.quilting import TEXTONS
from texloom.exemplar.exemplar import Exemplar
from texloom.io.stack import read_exemplar
from texloom.output.textons_file import load_textons, save_textons
from texloom.search.textons import learn_textons

PUBLISHED = {64: 7.0, 128: 38.0, 200: 432.0, 256: 997.0}  # seconds on an Athlon at 1.3 GHz (table 1)
SAMPLES = ("text-newsprint-256", "tiles-azulejo-256", "sand-ripples-256", "leaves-ivy-384", "mud-cracked-400")
ORIENTATIONS = 16
TIMES = 3  # of each, the best counts


def preprocessing(data: Path) -> list[dict[str, Any]]:
    """Table 1: one row a sample size."""
    return [_row(data, side) for side in TEXTONS]


def _row(data: Path, side: int) -> dict[str, Any]:
    """Medians over the samples, cropped to one size."""
    timed = [_time(read_exemplar(data / "exemplars" / f"{name}.png"), side) for name in SAMPLES]
    one, every, load, passes = (sorted(values) for values in zip(*timed, strict=True))
    middle = len(SAMPLES) // 2
    row = {
        "sample": f"{side}²",
        "textons": TEXTONS[side],
        "published s": PUBLISHED[side],
        "median s": round(one[middle], 3),
        "slowest s": round(one[-1], 3),
        "times faster": round(PUBLISHED[side] / one[middle]),
        "passes": f"{passes[0]} to {passes[-1]}",
        f"{ORIENTATIONS} orientations s": round(every[middle], 3),
        "load ms": round(1000 * load[middle], 1),
    }
    print(f"  {row}", flush=True)
    return row


def _time(whole: Exemplar, side: int) -> tuple[float, float, float, int]:
    """Seconds to learn one orientation, all of them, and to read a saved file; passes of the first."""
    sample = whole.crop(slice(0, side), slice(0, side))
    one, textons = best(lambda: learn_textons(sample, count=TEXTONS[side], orientations=1, seed=SEED), TIMES)
    passes = textons.passes
    every, textons = best(
        lambda: learn_textons(sample, count=TEXTONS[side], orientations=ORIENTATIONS, seed=SEED),
        1 if side > 128 else TIMES,
    )
    with tempfile.TemporaryDirectory() as folder:
        path = save_textons(Path(folder) / "sample.textons", textons)
        load, _ = best(lambda: load_textons(path), TIMES)
    return one, every, load, passes
