"""What ``texloom sketch`` is asked for, checked."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path

from texloom.cli import options
from texloom.errors import ParameterError

INSIDE = ("radial", "scale")
PRESET = "sketch"


@dataclass(frozen=True, kw_only=True)
class SketchWish:
    """What ``texloom sketch`` is asked for, checked; None where it is left open."""

    sketches: Sequence[str]
    samples: Sequence[Path]
    drawings: Sequence[Path]  # of the samples' cells
    output: Path
    size: tuple[int, int]  # rows, columns
    scale: float | None
    radius: float | None
    tileable: bool
    kinds: Path | None
    pattern: Path | None
    inside: str | None
    mesh_only: bool
    preset: str | None
    mask: Path | None
    seed: int
    sources: Path | None
    report: Path | None
    directx_normals: bool
    command: str


def check(wish: SketchWish) -> None:
    """Raises: ParameterError, for options that do not go together."""
    kind_options = {"kinds": wish.kinds, "pattern": wish.pattern}
    drawn = wish.output.suffix.lower() == ".svg"
    if drawn != wish.mesh_only:
        name = wish.output.name
        raise ParameterError(
            f"--output {name}: a texture is an image, or a folder of maps; add --mesh-only for the drawing alone"
            if drawn
            else f"--output {name}: --mesh-only writes a drawing, name it .svg"
        )
    if wish.mesh_only:
        given = {"inside": wish.inside, "preset": wish.preset, "sources": wish.sources, "report": wish.report}
        _refuse("is for a texture, and --mesh-only makes none: leave it out", **kind_options, **given)
    if not wish.samples:
        if not wish.mesh_only:
            raise ParameterError("a texture needs a sample: give one or more after the sketch, or add --mesh-only")
        given = {"mask": wish.mask, "sample-sketch": wish.drawings[0] if wish.drawings else None}
        _refuse("is for a sample, and there is none: give one, or leave it out", **given)
    if wish.kinds is not None and wish.pattern is None:
        raise ParameterError(f"--kinds {wish.kinds.name} tells cells apart for a pattern: add --pattern IMAGE")
    if wish.kinds is not None and len(wish.samples) > 1:
        raise ParameterError(
            f"--kinds {wish.kinds.name} is for one sample, but of {len(wish.samples)} each is a kind: leave it out"
        )
    if wish.pattern is not None and wish.kinds is None and len(wish.samples) == 1:
        raise ParameterError(
            f"--pattern {wish.pattern.name} needs kinds of cells: add --kinds MAP, or give several samples"
        )
    check_cells(wish.drawings, wish.samples, wish.radius)
    if wish.inside is not None:
        options.choose("inside", wish.inside, INSIDE)
    if wish.preset is not None:
        options.choose("preset", wish.preset, (PRESET,))
    if wish.scale is not None and not 0 < wish.scale < inf:
        raise ParameterError(f"--scale {wish.scale:g}: texels of the texture in one of the sketch, above 0, and finite")


def check_cells(drawings: Sequence[Path], samples: Sequence[Path], radius: float | None) -> None:
    """Raises: ParameterError, for drawings that are not one for each sample, or a radius below 0."""
    if len(drawings) not in (0, len(samples)):
        many = f"drawings of cells: {len(drawings)}, samples: {len(samples)}"
        raise ParameterError(f"--sample-sketch {drawings[0].name}: {many}; give one each, or none")
    if radius is not None and not 0 <= radius < inf:
        raise ParameterError(f"--radius {radius:g}: texels, 0 or more, and finite")


def _refuse(why: str, **given: object) -> None:
    """Raises: ParameterError, for the first option given."""
    for name, value in given.items():
        if value is not None:
            raise ParameterError(f"--{name} {value} {why}")
