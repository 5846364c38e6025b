"""The ``texloom`` command: parse, run one command, and end with one clear line when something is wrong.

Only typer and the standard library are imported before a command runs, so that ``--help`` and errors are instant.
"""

import sys
import warnings
from collections.abc import Sequence
from typing import Annotated

import typer

from texloom.cli.apply import apply
from texloom.cli.demo import demo
from texloom.cli.fill import fill
from texloom.cli.fuse import fuse
from texloom.cli.image import image
from texloom.cli.inspect import inspect
from texloom.cli.points import points
from texloom.cli.score import score
from texloom.cli.session import written
from texloom.cli.sketch import sketch
from texloom.cli.surface import surface
from texloom.cli.textons import textons
from texloom.errors import TexloomError

BAD_INPUT = 2
INTERRUPTED = 130

app = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for _command in (image, surface, fill, fuse, sketch, apply, textons, points, inspect, score, demo):
    app.command()(_command)


def _print_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        print(f"texloom {version('texloom')}")
        raise typer.Exit


@app.callback()
def _texloom(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Texture grown from a sample, on anything: images, vector fields, meshes."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return the exit status: 0, 2 for bad input, 130 when interrupted."""
    arguments = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    if not sys.warnoptions:
        warnings.simplefilter("ignore")  # a library's doubts are no part of our one line
    try:
        status = app(arguments, prog_name="texloom", standalone_mode=False, obj=arguments)
    except (KeyboardInterrupt, typer.Abort):
        status = INTERRUPTED
    except TexloomError as error:
        return _fail(str(error))
    except MemoryError:
        return _fail("not enough memory: use a smaller --size, --atlas-size or sample, or larger texels")
    except Exception as error:
        if not hasattr(error, "format_message"):  # not a usage error of the parser's
            raise
        return _fail(_usage(error))
    if status == INTERRUPTED:
        print(f"texloom: interrupted, {written()}", file=sys.stderr)
    return status if isinstance(status, int) else 0


def _usage(error: Exception) -> str:
    """What the parser found wrong, and where help is."""
    context = getattr(error, "ctx", None)
    command = context.command_path if context else "texloom"
    return f"{error.format_message().rstrip('.')}: see {command} --help"  # pyright: ignore[reportAttributeAccessIssue]


def _fail(message: str) -> int:
    """One line, whatever the message."""
    print(f"texloom: {' '.join(message.split())}", file=sys.stderr)
    return BAD_INPUT
