"""``texloom score``: how good a result is against its sample."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from texloom.cli import options
from texloom.cli.session import Session
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.metrics import Scores


def score(
    sample: options.Sample,
    result: Annotated[Path, typer.Argument(metavar="RESULT", help="An image, or a folder of maps, grown from it.")],
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Print swd, coherence, completeness, copy and seam of a result, for every map that both have."""
    for path in (sample, result):
        if path.suffix.lower() in options.MESH_SUFFIXES:
            raise ParameterError(f"{path.name} is a mesh: score takes images and folders of maps")
    with Session(threads=threads, as_json=as_json) as session:
        with session.stage("read"):
            from texloom.io.stack import read_exemplar
            from texloom.metrics import score as score_map

            ours, theirs = read_exemplar(result).maps, read_exemplar(sample).maps
            names = [name for name in theirs if name in ours]
            if not names:
                held = f"{sample.name} holds {', '.join(theirs)}, {result.name} holds {', '.join(ours)}"
                raise ParameterError(f"{held}: no map in common")
        table: dict[str, Scores] = {}
        for done, name in enumerate(names):
            session.report(f"score {name}", done / len(names))
            table[name] = score_map(_stored(theirs[name]), _stored(ours[name]))
        session.finish({"scores": {name: vars(scores) for name, scores in table.items()}}, text=_as_table(table))


def _stored(map: Any) -> Any:
    """Values as the eye has them: colours as sRGB, 16 bits where the map is float."""
    from texloom.output.image import stored

    return stored(map, map.bits if map.bits < 32 else 16)


def _as_table(table: "dict[str, Scores]") -> str:
    """One line a map, one column a score."""
    names = list(vars(next(iter(table.values()))))
    width = max(len("map"), *(len(name) for name in table))
    lines = [f"{'map':<{width}}" + "".join(f"{name:>14}" for name in names)]
    for map_name, scores in table.items():
        lines.append(f"{map_name:<{width}}" + "".join(f"{value:>14.3f}" for value in vars(scores).values()))
    return "\n".join(lines)
