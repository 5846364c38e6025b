"""Sweeps over a hierarchy of points (Turk 2001): points, seconds, pictures beside other methods, fields, seams.

``python -m benchmarks.sweep PART...`` measures some parts anew and leaves the others on the page as they are.
"""

from pathlib import Path
from typing import Any

from benchmarks import parts, report, sweep_pictures, sweep_speed
from benchmarks.data import SEED
from benchmarks.sweep_scenes import BUNNY, TEXELS

NAME = "sweep"
TIMED = ("points", "stages", "processes", "fields")
PARTS = (*TIMED, "pairs", "structure", "seam")


def main(data: Path, chosen: tuple[str, ...] = PARTS) -> None:
    """Measure, print and write the page."""

    def measure(part: str) -> Any:
        return getattr(sweep_speed if part in TIMED else sweep_pictures, part)(data)

    for numbers in parts.anew(NAME, PARTS, chosen, measure):
        sections = [f"Seed {SEED}. `copy` is the side in texels of the typical piece of the sample shown unbroken."]
        for part, measured in numbers.items():
            shown = sweep_pictures.tables(measured) if isinstance(measured, dict) else parts.rows(measured)
            sections += [_INTRODUCTION[part], shown]
        report.write(NAME, title="Sweeps over points", sections=sections, numbers=numbers)


_INTRODUCTION = {
    "points": f"## Points\n\nThe hierarchy of 4 k, 16 k, 64 k and 256 k points on {BUNNY}, warm, the best of a few: "
    "how much the distance to the nearest neighbour varies on each level, and the closest pair, over the mean.",
    "stages": f"## Stages\n\nThree levels, {sweep_speed.POINTS} points on the finest, 7×7 neighbourhoods, "
    f"{sweep_speed.SAMPLE} on {BUNNY}, warm, the best of a few runs.",
    "processes": "## Processes\n\nThe same as a whole command, read, field and file included, once kernels are cached; "
    "last the first one of all, which compiles them.",
    "fields": "## Fields through arrows\n\nFour arrows around the mesh's shortest axis, far from each other: spread "
    "from coarse to fine as in the talk, and the smoothest (harmonic) field.",
    "pairs": f"## Pictures\n\nSix samples on six meshes of about {TEXELS} texels, the same sites for all methods. "
    "*sweep, random* begins with a random copy instead of blocks, *talk* is the talk's own method, *scaled patches* "
    "the optimization of `resampling`.",
    "structure": f"## Coarse structures\n\nSamples with large parts on {BUNNY}, about {TEXELS} texels: blocks on the "
    "finest level only, and on the coarsest of two to four.",
    "seam": "## Where a sweep closes on itself\n\nMean colour step along edges whose two ends found more than 0.6 of "
    "what lies within 2.5 texels visited before them, over that along all other edges. The field runs around an axis, "
    "two seeds.",
}


if __name__ == "__main__":
    parts.command(NAME, PARTS, __doc__, main)
