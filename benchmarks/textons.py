"""Triangle quilting with textons (Magda & Kriegman 2003): the published tables beside ours, and what they leave out.

``python -m benchmarks.textons PART...`` measures some parts anew and leaves the others on the page as they are.
"""

from pathlib import Path
from typing import Any

from benchmarks import many_meshes, parts, preprocessing, quilting, report
from benchmarks.bunny import FACES, bunny
from benchmarks.data import SEED

NAME = "textons"
PARTS = ("preprocessing", "synthesis", "threads", "growth", "edges", "many", "blending")
MESHES = 100  # textured in one process


def main(data: Path, chosen: tuple[str, ...] = PARTS) -> None:
    """Measure, print and write the page."""
    scale = round(quilting.scale_of(bunny(data)), 3)
    for numbers in parts.anew(NAME, PARTS, chosen, lambda part: measure(part, data)):
        sections = [f"Seed {SEED}; published figures are of an Athlon at 1.3 GHz."]
        for part, measured in numbers.items():
            sections += [_INTRODUCTION[part].format(scale=scale), parts.rows(measured)]
        title = "Triangle quilting with textons"
        report.write(NAME, title=title, sections=sections, numbers={"scale": scale, **numbers})


def measure(part: str, data: Path) -> list[dict[str, Any]]:
    """The rows of one part."""
    if part == "preprocessing":
        return preprocessing.preprocessing(data)
    if part == "many":
        return many_meshes.many(data, MESHES)
    return many_meshes.blending(data) if part == "blending" else getattr(quilting, part)(data)


_ROUNDS = "after 2 rounds in which the worst half is chosen anew"
_INTRODUCTION = {
    "preprocessing": "## Preprocessing (table 1)\n\n"
    f"Crops of {', '.join(preprocessing.SAMPLES)}, 11×11 windows, until 99 % of the texels keep their texton, warm, "
    "the best of a few runs. Median and slowest of the samples with one orientation, as published; the median with "
    f"{preprocessing.ORIENTATIONS} orientations, and of reading a saved file of these.",
    "synthesis": "## Synthesis (table 2)\n\n"
    f"A bunny of {FACES} faces; crops of {', '.join(quilting.SAMPLES)}, the median of them, warm, the best of 2. "
    f"The texture's shortest side lies {quilting.REPEATS:g} times along the bunny's longest, so that by eq. 1 a face "
    "is {scale} textures large. *As published*: single faces in random order, one orientation, textons alone. Ours on "
    f"single faces, grown once, and {_ROUNDS}; *default* is ours on patches of faces, whose making is told apart.",
    "threads": "## One thread and two\n\nThe same with the first of the samples, in milliseconds.",
    "growth": "## Linear in the number of faces\n\n"
    "The bunny cut finer, with as many texels a face each time: a sample of 128², seconds. Three steps to four "
    "times as many faces, then one to twice.",
    "edges": "## Edges\n\n"
    "Mean difference E_t along the edges, of 255, over all inner edges: as published, ours on single faces grown once "
    f"and {_ROUNDS.replace('2', '5')}, and the default, patches of faces. There most edges lie inside patches and fit "
    "by themselves: *borders only* counts the others. The sample lies "
    f"{quilting.REPEATS:g} times along each mesh.",
    "many": "## Many meshes, one sample\n\n"
    f"One process for a folder of bunnies, each bent in its own way, with a saved {many_meshes.SAMPLE}: "
    "`texloom surface FOLDER FILE.textons --method texton -o OUT`. Milliseconds a mesh, from start to exit; what one "
    "more mesh takes, by a process for 10 of them; extrapolated from both to 1000; then the stages.",
    "blending": "## Blending\n\n"
    f"The bunny of {FACES} faces with {many_meshes.SAMPLE}, default parameters: edges, those between patches, those "
    f"blended where the whole mesh shows on 1024 pixels; baking an atlas of {many_meshes.ATLAS}²; the GLB with "
    "coordinates into the sample and with the atlas.",
}


if __name__ == "__main__":
    parts.command(NAME, PARTS, __doc__, main)
