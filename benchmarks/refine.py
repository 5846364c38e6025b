"""Pixel-based synthesis: pictures beside Resynthesizer, ten passes beside the published times, and fusion."""

import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from benchmarks import ours, peers, report
from benchmarks.data import SEED
from texloom.domain.grid import Grid
from texloom.exemplar.features import visible
from texloom.fusion.fuse import fuse
from texloom.fusion.labels import from_picture
from texloom.io.stack import read_exemplar
from texloom.metrics import score
from texloom.synthesis.refine import Refine

SIZE = 384
REGULAR = (
    "bricks-brown-192",
    "bricks-red-128",
    "chainmail-128",
    "cracker-128",
    "planks-stacked-192",
    "roof-slate-scales-128",
    "text-newsprint-256",
    "tiles-azulejo-256",
    "weave-wood-basket-192",
)
STRUCTURED = (
    "beans-192",
    "cells-green-161-64",
    "leaves-ivy-384",
    "mud-cracked-400",
    "net-cells-lines-424x283",
    "olives-242",
    "pebbles-grey-242",
    "scales-green-cells-192",
    "stones-brown-wall-128",
    "stones-flagstone-192",
)
PUBLISHED_SIZE = 200
PUBLISHED = "PCA 235–392 s, tree 2–4 s, ten passes 239–304 s"  # 192² samples, Pentium IV 3.2 GHz (table 1)
ORDERS = {
    "parallel": Refine(threshold=0.0),
    "scan-line": Refine(order="scan-line", threshold=0.0),
    "scan-line, nearest in the tree": Refine(order="scan-line", shortlist=1, threshold=0.0),
}
TIMED = ("beans-192", "bricks-brown-192", "stones-flagstone-192", "weave-wood-basket-192")
FUSED = ("bricks-brown-192", "stones-flagstone-192")
_MAP = "two-colour-wave-512.png"
_SCORES = ("coherence", "completeness", "swd", "copy", "seconds")


def main(data: Path) -> None:
    exemplars = data / "exemplars"
    ours.grow(exemplars / "beans-192.png", 64, method=Refine())  # load kernels outside the times
    pictures = {name: compare(exemplars / f"{name}.png") for name in REGULAR + STRUCTURED}
    passes = {(name, order): ten_passes(exemplars / f"{name}.png", order) for name in TIMED for order in ORDERS}
    fusion = [fused(data) for _ in range(3)]
    _write(pictures, passes, fusion)


def compare(path: Path) -> dict[str, dict[str, float]]:
    """Scores and seconds of Refine and of Resynthesizer on one sample."""
    with Image.open(path) as file:
        sample = file.convert("RGB")
    grown = ours.grow(path, SIZE, method=Refine())
    theirs, seconds = peers.timed(peers.resynthesizer, sample, SIZE)
    mine = next(iter(grown.maps.values()))[..., :3]
    row = {"texloom": (mine, grown.seconds), "resynthesizer": (theirs, seconds)}
    scores = {
        tool: {**asdict(score(np.asarray(sample), made)), "seconds": spent} for tool, (made, spent) in row.items()
    }
    print(f"  {path.stem}: coherence {scores['texloom']['coherence']:.2f}, {scores['resynthesizer']['coherence']:.2f}")
    return scores


def ten_passes(path: Path, order: str) -> dict[str, Any]:
    """Seconds of analysis and passes for the published size, and the scores of what came out."""
    with Image.open(path) as file:
        sample = np.asarray(file.convert("RGB"))
    grown = ours.grow(path, PUBLISHED_SIZE, method=ORDERS[order], tileable=True)
    scores = score(sample, next(iter(grown.maps.values()))[..., :3])
    row = {"seconds": grown.seconds, "analysis": grown.stages["analysis"], **asdict(scores)}
    print(f"  {path.stem}, {order}: {grown.seconds:.2f} s", flush=True)
    return row


def fused(data: Path) -> float:
    """Seconds from two loaded samples and a map to the picture of 512²."""
    samples = [read_exemplar(data / "exemplars" / f"{name}.png") for name in FUSED]
    picture = visible(read_exemplar(data / "fusion" / _MAP).lead)
    start = time.perf_counter()
    labels = from_picture(picture, len(samples)).labels
    fuse(samples, labels.ravel(), Grid(*labels.shape), seed=SEED)
    return time.perf_counter() - start


def _write(
    pictures: dict[str, dict[str, dict[str, float]]],
    passes: dict[tuple[str, str], dict[str, Any]],
    fusion: list[float],
) -> None:
    header = ["sample", *(f"{name} {tool}" for name in _SCORES for tool in ("ours", "theirs"))]
    body = [
        [name, *(row[tool][kind] for kind in _SCORES for tool in ("texloom", "resynthesizer"))]
        for name, row in pictures.items()
    ]
    better = sum(
        all(row["texloom"][kind] < row["resynthesizer"][kind] for kind in _SCORES[:2]) for row in pictures.values()
    )
    timed = [
        [name, order, *(row[kind] for kind in ("analysis", "seconds", *_SCORES[:4]))]
        for (name, order), row in passes.items()
    ]
    sections = [
        f"{SIZE}² from near-regular and structured samples, seed {SEED}: `Refine()` (ours) and Resynthesizer (theirs). "
        f"Lower is better. Coherence and completeness both better on **{better} of {len(pictures)}**.",
        report.table(header, body),
        f"## Ten passes\n\n{PUBLISHED_SIZE}² from 192² samples, torus, all ten passes, analysis included. "
        f"Published: {PUBLISHED}.",
        report.table(["sample", "order", "analysis s", "seconds", *_SCORES[:4]], timed),
        f"## Fusion\n\n{' and '.join(FUSED)} into 512²: **{float(np.median(fusion)):.2f} s**, median of {len(fusion)}.",
    ]
    numbers = {
        "pictures": pictures,
        "passes": {" / ".join(key): row for key, row in passes.items()},
        "fusion": fusion,
    }
    report.write("refine", title="Pixel-based synthesis and fusion", sections=sections, numbers=numbers)
