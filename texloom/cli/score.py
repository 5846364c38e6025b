"""``texloom score``: how good a result is against its sample."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from texloom.cli import options
from texloom.cli.session import Session
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.exemplar.exemplar import Exemplar, Map


def score(
    sample: options.Sample,
    result: Annotated[
        Path,
        typer.Argument(
            metavar="RESULT",
            help="An image or folder grown from it, a .glb of --as vertex, or a .npz of --sources.",
        ),
    ],
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Print how a result compares to its sample: swd, coherence, completeness, copy, of images seam, map by map."""
    if sample.suffix.lower() in options.MESH_SUFFIXES:
        raise ParameterError(f"{sample.name} is a mesh: the first file is the sample, an image or a folder of maps")
    with Session(threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.io.stack import read_exemplar

            exemplar = read_exemplar(sample)
        with session.stage("score"):
            table = _scored(exemplar, result, sample.name, session)
        session.finish({"scores": dict(table)}, text=_as_table(table))


def as_seen(map: "Map") -> Any:
    """Values as the eye has them: colours as sRGB, 16 bits where the map is float."""
    from texloom.output.image import stored

    return stored(map, min(map.bits, 16))


def _scored(exemplar: "Exemplar", result: Path, sample: str, session: Session) -> Mapping[str, Mapping[str, float]]:
    """Scores by map, whatever the result is."""
    if result.suffix.lower() in options.MESH_SUFFIXES:
        from texloom.cli.painted import from_glb, score_painted

        return score_painted(exemplar, from_glb(result, exemplar))
    if result.suffix.lower() != ".npz":
        from texloom.io.stack import read_exemplar

        return _score_images(exemplar.maps, read_exemplar(result).maps, (sample, result.name), session)
    from texloom.cli.reapply import reapply
    from texloom.output.sources_file import load_sources

    saved = load_sources(result)
    if "rows" in saved.domain:
        return _score_images(exemplar.maps, reapply(saved, exemplar, result.name), (sample, result.name), session)
    from texloom.cli.painted import from_sources, score_painted

    return score_painted(exemplar, from_sources(saved, exemplar, result.name))


def _score_images(
    theirs: "Mapping[str, Map]", ours: "Mapping[str, Map]", files: tuple[str, str], session: Session
) -> dict[str, Mapping[str, float]]:
    """Scores of every map that both have."""
    from texloom.metrics import score as score_map

    names = [name for name in theirs if name in ours]
    if not names:
        held = f"{files[0]} holds {', '.join(theirs)}, {files[1]} holds {', '.join(ours)}"
        raise ParameterError(f"{held}: no map in common")
    table: dict[str, Mapping[str, float]] = {}
    for done, name in enumerate(names):
        session.report(f"score {name}", done / len(names))
        table[name] = vars(score_map(as_seen(theirs[name]), as_seen(ours[name])))
    return table


def _as_table(table: Mapping[str, Mapping[str, float]]) -> str:
    """One line a map, one column a score."""
    names = list(next(iter(table.values())))
    width = max(len("map"), *(len(name) for name in table))
    lines = [f"{'map':<{width}}" + "".join(f"{name:>14}" for name in names)]
    for map_name, scores in table.items():
        lines.append(f"{map_name:<{width}}" + "".join(f"{value:>14.3f}" for value in scores.values()))
    return "\n".join(lines)
