"""Pictures: ten samples grown to 384², scored beside the tools people use today."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from benchmarks import ours, peers, report
from benchmarks.data import SAMPLES, SEED
from texloom.metrics import score

SIZE = 384
SCORES = ("swd", "completeness", "coherence", "copy", "seam", "seconds")
_GAP = 8  # texels between the pictures of the sheet

Row = dict[str, dict[str, float]]
"""Scores by tool, for one sample."""


def main(data: Path) -> None:
    rows: dict[str, Row] = {}
    strips = []
    ours.grow(data / "exemplars" / f"{SAMPLES[0]}.png", 64)  # load kernels outside the times
    for name in SAMPLES:
        with Image.open(data / "exemplars" / f"{name}.png") as file:
            sample = file.convert("RGB")
        pictures = _grow_all(data / "exemplars" / f"{name}.png", sample)
        rows[name] = {
            tool: {**asdict(score(np.asarray(sample), picture)), "seconds": seconds}
            for tool, (picture, seconds) in pictures.items()
        }
        strips.append(_strip(np.asarray(sample), [picture for picture, _ in pictures.values()]))
        print(
            f"  {name}: " + ", ".join(f"{tool} {scores['swd']:.3f}" for tool, scores in rows[name].items()), flush=True
        )
    _write(rows, strips)


def _grow_all(path: Path, sample: Image.Image) -> dict[str, tuple[np.ndarray, float]]:
    """Picture and seconds by tool; ours first, and once more as a tile for its seam."""
    grown = ours.grow(path, SIZE)
    tile = ours.grow(path, SIZE, tileable=True)
    made = {
        "texloom": (next(iter(grown.maps.values())), grown.seconds),
        "texloom --tileable": (next(iter(tile.maps.values())), tile.seconds),
    }
    return made | {name: peers.timed(peer, sample, SIZE) for name, peer in peers.PEERS.items()}


def _write(rows: dict[str, Row], strips: list[np.ndarray]) -> None:
    tools = list(next(iter(rows.values())))
    header = ["sample", *tools]
    sections = [
        f"{SIZE}² from ten samples, seed {SEED}, default methods. Lower is better everywhere; `copy` is in texels, and "
        "`seam` says something of tiles only.",
        _wins(rows),
    ]
    for name in SCORES:
        body = [[sample, *(row[tool][name] for tool in tools)] for sample, row in rows.items()]
        body.append(["**median**", *(float(np.median([row[tool][name] for row in rows.values()])) for tool in tools)])
        sections.append(f"## {name}\n\n{report.table(header, body)}")
    report.write("picture", title="Pictures", sections=sections, numbers={"size": SIZE, "seed": SEED, "scores": rows})
    _save_sheet(strips)


def _wins(rows: dict[str, Row]) -> str:
    """The sentence that sums the tables up."""

    def median(tool: str, name: str) -> float:
        return float(np.median([row[tool][name] for row in rows.values()]))

    won = sum(row["texloom"]["swd"] <= min(row[peer]["swd"] for peer in peers.PEERS) for row in rows.values())
    complete = ", ".join(f"{peer} {median(peer, 'completeness'):.2f}" for peer in peers.PEERS)
    worst = max(row["texloom --tileable"]["seam"] for row in rows.values())
    return (
        f"swd no worse than the better peer on **{won} of {len(rows)}**; median completeness "
        f"**{median('texloom', 'completeness'):.2f}** ({complete}); "
        f"median copy **{median('texloom', 'copy'):.0f} px**; worst seam of a tile **{worst:.2f}**."
    )


def _strip(sample: np.ndarray, pictures: list[np.ndarray]) -> np.ndarray:
    """The sample's first SIZE² texels and the results, side by side on white."""
    shown: list[Any] = [sample[:SIZE, :SIZE], *pictures]
    strip = np.full((SIZE + _GAP, len(shown) * (SIZE + _GAP), 3), 255, np.uint8)
    for index, picture in enumerate(shown):
        left = index * (SIZE + _GAP)
        strip[: picture.shape[0], left : left + picture.shape[1]] = picture[..., :3]
    return strip


def _save_sheet(strips: list[np.ndarray]) -> None:
    """Sample and results in the order of the tables. Not kept in the repository: most samples may not be shipped."""
    path = report.RESULTS.parents[1] / "out" / "picture-sheet.png"
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(np.concatenate(strips)).save(path)
    print(f"  sheet: out/{path.name}")
