"""Options that several commands share, and the names they accept."""

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from texloom.errors import ParameterError

METHODS = ("optimize", "patches", "refine", "refine-patches")
SEARCHES = ("exhaustive", "pca", "pca-tree", "pca-clusters", "clusters")
PRESETS = ("resampling", "refine")
SURFACE_METHODS = (*METHODS, "sweep", "texton")
SURFACE_PRESETS = (*PRESETS, "sweep", "texton")
PRESET_METHODS = {"resampling": METHODS[:2], "refine": METHODS[2:], "sweep": ("sweep",)}  # the paper's, its own first
SWEEP_SEARCHES = ("coherence", "tree")
SWEEP_ORDERS = ("parallel", "sequential")
STARTS = ("blocks", "random")
SHAPES = ("half", "causal", "full")
ORDERS = ("parallel", "scan-line")
DEVICES = ("cpu", "cuda")
MESH_SUFFIXES = (".obj", ".ply", ".off", ".stl", ".glb", ".gltf")
IMAGE_SUFFIXES = (".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg")
_LARGEST_SIDE = 32_768  # texels

Samples = Annotated[
    list[Path], typer.Argument(metavar="SAMPLE", help="An image, or a folder of maps (basecolor.png, normal.png, ...).")
]
Sample = Annotated[
    Path, typer.Argument(metavar="SAMPLE", help="An image, or a folder of maps (basecolor.png, normal.png, ...).")
]
Method = Annotated[str | None, typer.Option(metavar="NAME", help=f"{', '.join(METHODS[:-1])} or {METHODS[-1]}.")]
SurfaceMethod = Annotated[
    str | None, typer.Option("--method", metavar="NAME", help=f"{', '.join(SURFACE_METHODS[:-1])} or texton.")
]
Search = Annotated[str | None, typer.Option(metavar="NAME", help=f"{', '.join(SEARCHES[:-1])} or {SEARCHES[-1]}.")]
SurfaceSearch = Annotated[
    str | None,
    typer.Option("--search", metavar="NAME", help=f"With sweep: {' or '.join(SWEEP_SEARCHES)}; with a preset its own."),
]
Preset = Annotated[str | None, typer.Option(metavar="KEY", help=f"A paper's own parameters: {', '.join(PRESETS)}.")]
SurfacePreset = Annotated[
    str | None, typer.Option("--preset", metavar="KEY", help=f"A paper's own parameters: {', '.join(SURFACE_PRESETS)}.")
]
Order = Annotated[str | None, typer.Option(metavar="NAME", help=f"With refine: {' or '.join(ORDERS)}.")]
Window = Annotated[int | None, typer.Option(metavar="N", help="With refine: texels a side of what is kept together.")]
Pitch = Annotated[int | None, typer.Option(metavar="N", help="With refine in scan-line order: texels between seeds.")]
Passes = Annotated[int | None, typer.Option(metavar="N", help="With refine: passes at most.")]
Threshold = Annotated[
    float | None, typer.Option(metavar="E", help="With refine: stop when a pass changes less; 0 never does.")
]
Difference = Annotated[
    str | None, typer.Option(metavar="NAME", help="With refine: what changes is a mean over pixels, or a sum.")
]
Levels = Annotated[int | None, typer.Option(metavar="N", min=1, max=8, help="With sweep: of points; 3, or fewer.")]
Start = Annotated[str | None, typer.Option(metavar="NAME", help=f"With sweep: {' or '.join(STARTS)}.")]
Shape = Annotated[
    str | None, typer.Option(metavar="NAME", help=f"With sweep from random: first compare {', '.join(SHAPES)}.")
]
SweepOrder = Annotated[
    str | None, typer.Option("--order", metavar="NAME", help=f"With sweep: {' or '.join(SWEEP_ORDERS)}.")
]
SweepWidth = Annotated[
    int | None, typer.Option("--window", metavar="N", help="With sweep: texels a side of a neighbourhood; 7.")
]
SweepPasses = Annotated[int | None, typer.Option("--passes", metavar="N", help="With sweep: sweeps of each level; 2.")]
Sketches = Annotated[
    list[str] | None,
    typer.Option(
        "--sketch",
        metavar="SKETCH",
        help="Cells to lay: an SVG, a drawing, a picture, or random; any number, used together.",
    ),
]
SampleSketch = Annotated[
    list[Path] | None,
    typer.Option(metavar="FILE", help="The sample's own cells; of several, one each. Detected if not given."),
]
Radius = Annotated[
    float | None,
    typer.Option(metavar="R", help="Texels that cells stray: 0 is regular; a quarter of a cell if not given."),
]
Seed = Annotated[int, typer.Option(metavar="N", help="Same seed, same pixels.")]
Device = Annotated[str, typer.Option(metavar="NAME", help="cpu or cuda.")]
Threads = Annotated[int | None, typer.Option(metavar="N", min=1, max=1024, help="CPU threads; all cores if not given.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")]
DirectX = Annotated[bool, typer.Option("--directx-normals", help="The sample's normal map has green down.")]
Mask = Annotated[Path | None, typer.Option(metavar="FILE", help="An image, white where the sample is used.")]
AnalysisFile = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="With --preset: what is learnt from the sample, read if there, else saved."),
]
Report = Annotated[Path | None, typer.Option(metavar="FILE", help="All about the run on one page (.html).")]
SourcesOut = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Save the sources too (.npz), for `texloom apply`.")
]


def choose(what: str, name: str, names: Sequence[str]) -> str:
    """The name, if it is one of the names."""
    if name not in names:
        choices = names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"
        raise ParameterError(f"unknown {what} {name!r}: choose {choices}")
    return name


def only_sample(samples: Sequence[Path]) -> Path:
    """The one sample that present methods take."""
    if len(samples) != 1:
        raise ParameterError(
            f"{len(samples)} samples were given, but each method takes 1 for now: give one image or folder"
        )
    return samples[0]


def check_mask(mask: Path | None, samples: Sequence[Path]) -> None:
    """Refuse one mask for several samples."""
    if mask is not None and len(samples) > 1:
        raise ParameterError(
            f"--mask {mask.name} is for one sample, but {len(samples)} were given: "
            "put a mask.png into each sample's folder, or make what is not used transparent"
        )


def parse_size(text: str) -> tuple[int, int]:
    """``W`` or ``WxH`` texels as (rows, columns)."""
    parts = text.lower().replace("×", "x").split("x")
    if len(parts) > 2 or not all(part.isascii() and part.isdigit() for part in parts):
        raise ParameterError(f"--size {text!r} is not W or WxH in texels: give for example 512 or 640x480")
    columns, rows = (int(part) for part in (parts * 2)[:2])
    if not (1 <= rows <= _LARGEST_SIDE and 1 <= columns <= _LARGEST_SIDE):
        raise ParameterError(f"--size {text}: sides go from 1 to {_LARGEST_SIDE} texels")
    return rows, columns


def check_output(*paths: Path | None) -> None:
    """Refuse, before any work, a file whose folder is missing."""
    for path in paths:
        if path is not None and not path.resolve().parent.is_dir():
            raise ParameterError(f"{path}: there is no folder {path.parent}: make it first, or choose another place")


def check_report(report: Path | None) -> None:
    """Refuse a report that no browser would open."""
    if report is not None and report.suffix.lower() not in (".html", ".htm"):
        raise ParameterError(f"--report {report.name}: a report is a page, name it .html")


def is_file(output: Path) -> bool:
    """Whether an output path names a single image rather than a folder."""
    return output.suffix.lower() in IMAGE_SUFFIXES or bool(output.suffix and not output.is_dir())


def command_line(context: typer.Context) -> str:
    """The words of this run, as a shell takes them."""
    return shlex.join(["texloom", *(str(word) for word in context.find_root().obj or ())])


def settings(command: str, *samples: Path, **facts: object) -> dict[str, str]:
    """What is stored in every file written: version, command, samples and the parameters that are set."""
    from importlib.metadata import version

    stored = {name: str(value) for name, value in facts.items() if value is not None and value is not False}
    names = ", ".join(sample.name for sample in samples)
    return {"software": f"texloom {version('texloom')}", "command": command, "sample": names, **stored}
