"""What ``texloom surface`` is asked for, checked."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from texloom.cli.library import SUFFIX
from texloom.cli.meshes import Meshes
from texloom.cli.sketch_wish import check_cells
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.cli.methods import MethodWish


@dataclass(frozen=True)
class Guides:
    """Where the texture runs, and how large it is."""

    direction: str
    scale: Path | None
    symmetry: int
    progressive: bool


@dataclass(frozen=True)
class Fusion:
    """Which sample goes where."""

    map: str | None
    palette: str | None
    belts: str


@dataclass(frozen=True)
class QuiltWish:
    """Options of ``--method texton``; None where they are left open."""

    patch: float | None
    rounds: int | None
    blend: float | None
    distance: float | None
    published: bool  # the paper's own parameters

    def refuse(self, edges: Path | None, samples: Sequence[Path]) -> None:
        """Raises: ParameterError, if any was given for another method, or a file of textons."""
        for sample in samples:
            if sample.suffix.lower() == SUFFIX:
                raise ParameterError(f"{sample.name} is for --method texton: add it, or give the sample itself")
        given = {"patch": self.patch, "rounds": self.rounds, "blend": self.blend, "distance": self.distance}
        for name, value in {**given, "edges": edges}.items():
            if value is not None:
                raise ParameterError(f"--{name} {value} is for --method texton: add it, or leave --{name} out")

    def check(self, method: str | None, **others: object) -> None:
        """Raises: ParameterError, for options of other methods."""
        if method not in (None, "texton"):
            raise ParameterError(f"--preset texton has no {method}: leave --method out, or choose no preset")
        if self.published and (self.patch or self.rounds):
            raise ParameterError("--preset texton quilts every face alone, once: leave --patch and --rounds out")
        for name, value in others.items():
            if value is not None:
                raise ParameterError(f"--{name} {value} is not for --method texton: leave it out")


@dataclass(frozen=True)
class CellsWish:
    """The cells to design a texture by; without sketches, the samples are taken as they are."""

    sketches: Sequence[str]
    drawings: Sequence[Path]  # of the samples' own cells
    radius: float | None

    def check(self, samples: Sequence[Path]) -> None:
        """Raises: ParameterError, for options that do not go together, or a value out of its range."""
        given = {"sample-sketch": self.drawings[0].name if self.drawings else None, "radius": self.radius}
        for name, value in given.items():
            if value is not None and not self.sketches:
                raise ParameterError(f"--{name} {value} is for cells that are laid: add --sketch SKETCH")
        check_cells(self.drawings, samples, self.radius)


@dataclass(frozen=True, kw_only=True)
class SurfaceWish:
    """All options, those of one kind together."""

    meshes: Meshes
    material: str | None
    samples: Sequence[Path]
    mask: Path | None
    directx_normals: bool
    repeats: float | None
    texel: float | None
    guides: Guides
    cells: CellsWish
    fusion: Fusion
    method: "MethodWish | None"  # None: quilting
    quilting: QuiltWish | None
    preset: str | None
    analysis: Path | None
    seed: int
    home: str
    atlas: tuple[int | None, int, bool]  # texels a side, gutter, whether to make new UVs
    preview: Path | None
    sources: Path | None
    report: Path | None
    edges: Path | None
    command: str
