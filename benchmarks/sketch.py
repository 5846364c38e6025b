"""Textures from mesh sketches (Wang et al. 2014): times beside the published ones, detail, lines, files.

``python -m benchmarks.sketch PART...`` measures some parts anew and leaves the others on the page as they are.
"""

from pathlib import Path
from typing import Any

from benchmarks import parts, report, sketch_pictures, sketch_speed
from benchmarks.data import SEED
from benchmarks.sketch_scenes import SIDE

NAME = "sketch"
TIMED = ("preparation", "speed")
PARTS = (*TIMED, "detail", "shapes", "steps", "files")


def main(data: Path, chosen: tuple[str, ...] = PARTS) -> None:
    """Measure, print and write the page."""

    def measure(part: str) -> Any:
        return getattr(sketch_speed if part in TIMED else sketch_pictures, part)(data)

    for numbers in parts.anew(NAME, PARTS, chosen, measure):
        sections = [f"Seed {SEED}; cells of the samples detected, cells of the texture as large as theirs."]
        for part, measured in numbers.items():
            sections += [_INTRODUCTION[part], parts.rows(measured)]
        report.write(NAME, title="Textures from mesh sketches", sections=sections, numbers=numbers)


_INTRODUCTION = {
    "preparation": "## Once\n\nMilliseconds: a sample read, its cells detected and mapped; a drawing read; its "
    "seamless patch. None of this is done again when radius, size, pattern or a vertex change.",
    "speed": "## Milliseconds\n\nWarm, the least of a few runs, from the patch to the picture. *mesh* is tiling and "
    "refinement, *deal* which cell of the sample goes where, *start* the first image, *moved* a vertex near the middle "
    "moved and all of the picture there again, the median of a few. Published, for 128² and 256² on a GTX 780: mesh 2 "
    "and 4, first image 62 and 95, pixels 64 and 257, in all 128 and 356.",
    "detail": f"## Detail (figure 3)\n\nMean squared difference to a blur of {sketch_pictures.FINE:g} texels, of what "
    f"is shown, over the sample's: {SIDE}² texels, orientation features on and off. Textures are read between the "
    "sample's texels; *copied* is the same with each texel the sample's nearest, as in the paper.",
    "shapes": f"## Lines where they were drawn\n\nTexels from the texture mesh's edges to the strongest lines of the "
    f"texture, {SIDE}²: mean distance to the nearest of as many texels as edges cover, those where the picture curves "
    "most across a line. First the sample's own cells on itself, last ours against a mesh of another draw.",
    "steps": "## What each step is worth\n\n"
    "From the paper's method to ours, then ours with one choice taken back: detail and lines as above; *fit* is the "
    "mean difference of 7 × 7 texels to the sample's nearest, of 255, *fit back* the reverse, *swd* the distance of "
    "the distributions. Means over the six pairs.",
    "files": f"## Every file\n\nSketches read (seconds), what was mended, cells that show in {SIDE}² texels.",
}


if __name__ == "__main__":
    parts.command(NAME, PARTS, __doc__, main)
