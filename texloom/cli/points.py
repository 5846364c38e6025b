"""``texloom points``: points spread evenly over a mesh, in nested levels."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from texloom.cli import options
from texloom.cli.session import Session, in_words
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.points import Hierarchy

FINER = 4  # times the points of the level before
_SUFFIXES = (".ply", ".npz")


def points(
    mesh: Annotated[Path, typer.Argument(metavar="MESH", help="OBJ, PLY, OFF, STL, GLB or glTF.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="A .ply or .npz.")],
    number: Annotated[int, typer.Option("--number", "-n", metavar="N", help="Points, on the finest level.")] = 64_000,
    levels: Annotated[
        int, typer.Option(metavar="N", min=1, max=12, help="Each has a quarter of the finer one's points.")
    ] = 1,
    scale: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Arrows or an array: points farther apart, nearer.")
    ] = None,
    material: Annotated[str | None, typer.Option(metavar="NAME", help="Only on this material.")] = None,
    seed: Annotated[int, typer.Option(metavar="N", help="Same seed, same points.")] = 0,
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Spread points evenly over a mesh by repulsion on its surface; the points of a coarse level stay in finer ones."""
    if output.suffix.lower() not in _SUFFIXES:
        raise ParameterError(f"--output {output.name}: points are written as .ply or .npz")
    options.check_output(output)
    counts = level_counts(number, levels)
    with Session(threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.cli.fields import scale_field
            from texloom.io.mesh import read_mesh
            from texloom.output.points_file import write_points
            from texloom.points import hierarchy

            model = read_mesh(mesh, material=material)
            wanted = scale_field(model, scale, "smooth")
        with session.stage("points"):
            made = hierarchy(model.mesh, counts, scale=wanted, seed=seed, report=session.report)
        with session.stage("write"):
            settings = options.settings("points", mesh, number=number, levels=levels, seed=seed)
            session.wrote(write_points(output, made, settings=settings))
        facts = {"points": number, "seed": seed, "levels": _levels(made), "mends": model.mends, "files": [str(output)]}
        session.finish(facts, text=None if as_json else in_words(_told(facts)))


def level_counts(number: int, levels: int) -> tuple[int, ...]:
    """Points of each level, the coarsest first."""
    counts = tuple(number // FINER**level for level in reversed(range(levels)))
    if counts[0] < FINER:
        raise ParameterError(
            f"--levels {levels} of --number {number} points: the coarsest would have {counts[0]}, "
            f"and {FINER} are the fewest: give fewer levels or more points"
        )
    return counts


def _levels(made: "Hierarchy") -> list[dict[str, Any]]:
    """How even each level is."""
    return [
        {
            "points": level.count,
            "spacing": level.spacing,
            "variation": round(level.variation, 4),
            "closest": round(level.closest, 4),
        }
        for level in made.levels
    ]


def _told(facts: dict[str, Any]) -> dict[str, Any]:
    """The same, with a line for each level."""
    lines = [
        f"{level['points']} points {level['spacing']:.4g} apart, "
        f"varying by {level['variation']:.1%}, the closest at {level['closest']:.0%} of the mean"
        for level in facts["levels"]
    ]
    return {**facts, "points": "\n".join(lines), "levels": ""}
