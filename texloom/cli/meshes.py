"""The meshes ``texloom surface`` is asked for, one or many, and the way through them."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from texloom.cli.options import MESH_SUFFIXES
from texloom.errors import FileError, ParameterError, TexloomError

if TYPE_CHECKING:
    from texloom.cli.session import Session

Texture = Callable[[Path, Path], Mapping[str, Any]]
"""Textures the mesh of a path, writes it to another, and tells what it did."""

_LIST = ".txt"


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
        name, times = Counter(file.stem for file in found).most_common(1)[0]
        if times > 1:
            raise ParameterError(f"{mesh}: two meshes are called {name}, one would overwrite the other: rename one")
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

    def check(self, *extras: Path | None) -> None:
        """Raises: ParameterError, if a file about one mesh is asked for and there are many."""
        for extra in extras:
            if self.many and extra is not None:
                raise ParameterError(f"{extra.name} is about one mesh, but {len(self.pairs)} were given: leave it out")


def over_meshes(meshes: Meshes, texture: Texture, session: "Session", *, at_once: int = 1) -> int:
    """Texture one mesh, or many, ``at_once`` side by side: what is wrong with one is told, and the others go on.

    Returns how many failed.
    """
    if not meshes.many:
        session.finish(texture(*meshes.pairs[0]))
        return 0

    def tried(pair: tuple[Path, Path]) -> Mapping[str, Any]:
        mesh, output = pair
        try:
            return {"mesh": mesh.name, **texture(mesh, output)}
        except TexloomError as error:
            return {"mesh": mesh.name, "failed": " ".join(str(error).split())}

    told: list[Mapping[str, Any]] = []
    with _folder(meshes.output):
        for entry in _each(tried, meshes.pairs, at_once):
            told.append(entry)
            if "failed" in entry:
                name, problem = str(entry["mesh"]), str(entry["failed"])
                named = problem if problem.startswith(name) else f"{name}: {problem}"
                typer.echo(f"texloom: {named}", err=True)
            session.report(str(entry["mesh"]), len(told) / len(meshes.pairs))
    failed = [str(entry["mesh"]) for entry in told if "failed" in entry]
    words = f"{len(told) - len(failed)} of {len(told)} meshes textured, in {meshes.output}"
    session.finish({"meshes": told, "failed": failed}, text=words)
    return len(failed)


def _each(
    work: Callable[[tuple[Path, Path]], Mapping[str, Any]], pairs: Sequence[tuple[Path, Path]], at_once: int
) -> Iterator[Mapping[str, Any]]:
    """The results in order. Side by side each mesh has one thread, the first the machine: it loads what all need."""
    if at_once == 1:
        yield from map(work, pairs)
        return
    from texloom.exemplar.blas import single_threaded
    from texloom.kernels import launch

    yield work(pairs[0])
    threads = launch.thread_count()
    launch.use(threads=1)
    pool = ThreadPoolExecutor(at_once)
    try:
        with single_threaded():
            yield from pool.map(work, pairs[1:])
    finally:
        pool.shutdown(cancel_futures=True)
        launch.use(threads=threads)


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
