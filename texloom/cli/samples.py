"""Samples, or stacks to take their place, read as the one exemplar that commands work on."""

from collections.abc import Sequence
from pathlib import Path

import typer

from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.join import Joined, join
from texloom.io.stack import read_exemplar


def read_samples(paths: Sequence[Path], *, mask: Path | None = None, directx_normals: bool = False) -> Joined:
    """All samples joined; ``mask`` is that of a lone sample."""
    return join(read_each(paths, mask=mask, directx_normals=directx_normals))


def read_each(paths: Sequence[Path], *, mask: Path | None = None, directx_normals: bool = False) -> list[Exemplar]:
    """Every sample as it is."""
    return [read_exemplar(path, mask=mask, directx_normals=directx_normals) for path in paths]


def tell_dropped(joined: Joined) -> None:
    """Say in one line on stderr which maps not all samples have."""
    if joined.dropped:
        typer.echo(f"texloom: left out, since not all samples have it: {', '.join(joined.dropped)}", err=True)
