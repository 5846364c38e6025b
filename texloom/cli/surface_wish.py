"""What ``texloom surface`` is asked for, checked, and the meshes it is asked for."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from texloom.cli.library import SUFFIX
from texloom.cli.options import MESH_SUFFIXES
from texloom.errors import FileError, ParameterError, TexloomError

if TYPE_CHECKING:
    from texloom.cli.methods import MethodWish
    from texloom.cli.session import Session

Texture = Callable[[Path, Path], Mapping[str, Any]]
"""Textures the mesh of a path, writes it to another, and tells what it did."""

_LIST = ".txt"


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

    def check(self, method: str | None, search: str | None, fuse: str | None, analysis: Path | None) -> None:
        """Raises: ParameterError, for options of other methods."""
        if method not in (None, "texton"):
            raise ParameterError(f"--preset texton has no {method}: leave --method out, or choose no preset")
        if self.published and (self.patch or self.rounds):
            raise ParameterError("--preset texton quilts every face alone, once: leave --patch and --rounds out")
        for name, value in (("search", search), ("fuse", fuse), ("analysis", analysis)):
            if value is not None:
                raise ParameterError(f"--{name} {value} is not for --method texton: leave it out")


@dataclass(frozen=True)
class Meshes:
    """One mesh or many, and where each goes."""

    pairs: tuple[tuple[Path, Path], ...]
    output: Path
    many: bool

    @classmethod
    def of(cls, mesh: Path, output: Path) -> "Meshes":
        """``mesh`` itself, those of a folder, or those a text file names line by line; many go into a folder as GLB.

        Raises: FileError, if a folder or list has no meshes; ParameterError, for an output that does not fit.
        """
        if mesh.is_dir():
            found = sorted(file for file in mesh.iterdir() if file.suffix.lower() in MESH_SUFFIXES)
        elif mesh.suffix.lower() == _LIST:
            found = _listed(mesh)
        else:
            return cls(((mesh, output),), output, many=False)
        if not found:
            raise FileError(f"{mesh}: no meshes there: {', '.join(MESH_SUFFIXES)} are understood")
        if output.is_file() or (output.suffix and not output.is_dir()):
            raise ParameterError(f"{output.name}: {len(found)} meshes go into a folder: give one")
        names = [file.stem for file in found]
        double = next((name for name in names if names.count(name) > 1), None) if len(set(names)) < len(names) else None
        if double is not None:
            raise ParameterError(f"{mesh}: two meshes are called {double}, one would overwrite the other: rename one")
        pairs = tuple((file, output / f"{file.stem}.glb") for file in found)
        for file, written in pairs:
            if written.resolve() == file.resolve():
                raise ParameterError(
                    f"{output}: {file.name} would be overwritten by its own result: give another folder"
                )
        return cls(pairs, output, many=True)

    @property
    def suffix(self) -> str:
        """Of what is written."""
        return self.pairs[0][1].suffix.lower()

    @property
    def checked(self) -> Path:
        """What has to lie in a folder that is there."""
        return self.output

    def check(self, *extras: Path | None) -> None:
        """Raises: ParameterError, if a file about one mesh is asked for and there are many."""
        for extra in extras:
            if self.many and extra is not None:
                raise ParameterError(f"{extra.name} is about one mesh, but {len(self.pairs)} were given: leave it out")


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


def over_meshes(meshes: Meshes, texture: Texture, session: "Session") -> int:
    """Texture one mesh, or many one after the other: what is wrong with one of many is told, and the others go on.

    Returns how many failed.
    """
    if not meshes.many:
        session.finish(texture(*meshes.pairs[0]))
        return 0
    told: list[Mapping[str, Any]] = []
    with _folder(meshes.output):
        for number, (mesh, output) in enumerate(meshes.pairs):
            session.report(mesh.name, number / len(meshes.pairs))
            try:
                told.append({"mesh": mesh.name, **texture(mesh, output)})
            except TexloomError as error:
                problem = " ".join(str(error).split())
                named = problem if problem.startswith(mesh.name) else f"{mesh.name}: {problem}"
                typer.echo(f"texloom: {named}", err=True)
                told.append({"mesh": mesh.name, "failed": problem})
    failed = [str(entry["mesh"]) for entry in told if "failed" in entry]
    words = f"{len(told) - len(failed)} of {len(told)} meshes textured, in {meshes.output}"
    session.finish({"meshes": told, "failed": failed}, text=words)
    return len(failed)


@contextmanager
def _folder(path: Path) -> Iterator[None]:
    """A folder to write into, made if it is not there, and gone again if nothing was written."""
    made = not path.exists()
    path.mkdir(exist_ok=True)
    try:
        yield
    finally:
        if made and not any(path.iterdir()):
            path.rmdir()


def _listed(path: Path) -> list[Path]:
    """Meshes named in a text file, a line each, beside it if not absolute."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path.name} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    return [path.parent / line.strip() for line in lines if line.strip()]
