"""Holes: squares in five pictures and the masks beside them, filled by us and by the tools people use today."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from benchmarks import report
from benchmarks.data import SEED
from texloom.metrics.border import border_step

CROP, SIDE = 256, 64  # texels
PICTURES = ("tiles-azulejo-256", "grass-green-290x272", "leaves-ivy-384", "wood-grain-orange-512", "gravel-grey-512")
MASKS = {  # each on a picture of its size
    "letters-256": "tiles-azulejo-256",
    "scratches-256": "text-newsprint-256",
    "blobs-256": "sand-ripples-256",
    "specks-128": "bricks-red-128",
    "square-centre-192": "weave-wood-basket-192",
    "bottom-border-192": "bricks-brown-192",
}
TOOLS = ("texloom", "resynthesizer", "pypatchmatch")
NUMBERS = ("border", "error", "seconds")
_GAP = 8  # texels between the pictures of the sheet

Tool = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""A picture (row, column, 3) in 8 bits and its hole, filled."""


def main(data: Path) -> None:
    tools = {name: tool for name in TOOLS if (tool := _tool(name)) is not None}
    rows: dict[str, dict[str, dict[str, float]]] = {}
    strips = []
    for name, (picture, hole) in _tasks(data).items():
        painted = np.where(hole[..., None], np.uint8(255), picture)
        made = {tool: _timed(run, painted, hole) for tool, run in tools.items()}
        rows[name] = {
            tool: {"border": border_step(result, hole), "error": _error(result, picture, hole), "seconds": seconds}
            for tool, (result, seconds) in made.items()
        }
        rows[name]["original"] = {"border": border_step(picture, hole), "error": 0.0, "seconds": 0.0}
        strips.append([painted, *(result for result, _ in made.values())])
        print(f"  {name}: " + ", ".join(f"{tool} {row['border']:.2f}" for tool, row in rows[name].items()), flush=True)
    _write(rows, list(tools))
    _save_sheet(strips)


def _tasks(data: Path) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Pictures and their holes."""
    tasks = {}
    for name in PICTURES:
        picture = _picture(data / "exemplars" / f"{name}.png")[:CROP, :CROP]
        hole = np.zeros(picture.shape[:2], bool)
        corner = [(size - SIDE) // 2 for size in hole.shape]
        hole[corner[0] : corner[0] + SIDE, corner[1] : corner[1] + SIDE] = True
        tasks[name] = picture, hole
    for mask, name in MASKS.items():
        hole = _picture(data / "masks" / f"{mask}.png")[..., 0] > 127
        tasks[mask] = _picture(data / "exemplars" / f"{name}.png"), hole
    return tasks


def _picture(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def _tool(name: str) -> Tool | None:
    """A tool by its name; None where it is not installed."""
    try:
        return {"texloom": _ours, "resynthesizer": _resynthesizer, "pypatchmatch": _patchmatch}[name]()
    except ImportError:
        print(f"  {name} is not installed and left out", flush=True)
        return None


def _ours() -> Tool:
    from texloom.exemplar.exemplar import from_array
    from texloom.output.filled import filled_maps
    from texloom.output.image import stored
    from texloom.synthesis.fill import fill

    def run(picture: np.ndarray, hole: np.ndarray) -> np.ndarray:
        return stored(filled_maps(fill(from_array(picture), hole, seed=SEED))["basecolor"], 8)

    return run


def _resynthesizer() -> Tool:
    """Its defaults but for the flags that make tiles, as these pictures are none."""
    from resynthesizer.resynthesizer import getDefaultParams, resynthesize

    def run(picture: np.ndarray, hole: np.ndarray) -> np.ndarray:
        parameters = getDefaultParams()
        parameters.isMakeSeamlesslyTileableHorizontally = parameters.isMakeSeamlesslyTileableVertically = 0
        mask = Image.fromarray(hole * np.uint8(255))
        return np.asarray(resynthesize(Image.fromarray(picture), mask, parameters))

    return run


def _patchmatch() -> Tool:
    """Patches as wide as in its examples; its default of 31 texels is slow."""
    from patchmatch import patch_match  # pyright: ignore[reportMissingImports]

    def run(picture: np.ndarray, hole: np.ndarray) -> np.ndarray:
        patch_match.set_random_seed(SEED)
        return np.asarray(patch_match.inpaint(np.ascontiguousarray(picture), hole * np.uint8(255), patch_size=3))

    return run


def _timed(tool: Tool, picture: np.ndarray, hole: np.ndarray) -> tuple[np.ndarray, float]:
    """The result, and the shorter time of two runs: the first loads what it needs."""
    clock = [time.perf_counter()]
    tool(picture, hole)
    clock.append(time.perf_counter())
    result = tool(picture, hole)
    clock.append(time.perf_counter())
    return result, float(np.diff(clock).min())


def _error(result: np.ndarray, picture: np.ndarray, hole: np.ndarray) -> float:
    """Root mean squared difference from what was in the hole, of 255."""
    difference = result[hole].astype(np.float64) - picture[hole]
    return float(np.sqrt((difference**2).mean()))


def _write(rows: dict[str, dict[str, dict[str, float]]], tools: list[str]) -> None:
    sections = [
        f"A hole of {SIDE}² in the middle of {CROP}² texels of five pictures, then six masks; seed {SEED}, defaults. "
        "`border`: the mean step across the hole's border over the mean step inside, about 1 if it cannot be told "
        "(last column: in the original). `error`: RMS of 255 against what was in the hole, which nobody can know: it "
        "tells only where texture repeats. `seconds`: the shorter of two runs.",
    ]
    for name in NUMBERS:
        shown = [*tools, "original"] if name == "border" else tools
        body: list[list[Any]] = [[task, *(row[tool][name] for tool in shown)] for task, row in rows.items()]
        body.append(["**median**", *(float(np.median([row[tool][name] for row in rows.values()])) for tool in shown)])
        sections.append(f"## {name}\n\n{report.table(['hole', *shown], body)}")
    report.write("fill", title="Holes", sections=sections, numbers={"seed": SEED, "scores": rows})


def _save_sheet(strips: list[list[np.ndarray]]) -> None:
    """Each hole and how each tool has filled it. Not kept in the repository: most pictures may not be shipped."""
    width = max(picture.shape[1] for strip in strips for picture in strip) + _GAP
    sheet = Image.new(
        "RGB", (width * max(map(len, strips)), sum(strip[0].shape[0] + _GAP for strip in strips)), (255, 255, 255)
    )
    top = 0
    for strip in strips:
        for column, picture in enumerate(strip):
            sheet.paste(Image.fromarray(picture), (column * width, top))
        top += strip[0].shape[0] + _GAP
    path = report.RESULTS.parents[1] / "out" / "fill-sheet.png"
    path.parent.mkdir(exist_ok=True)
    sheet.save(path)
    print(f"  sheet: out/{path.name}")
