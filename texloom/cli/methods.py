"""Method and search objects from the names given on the command line."""

from typing import Any

from texloom.cli.options import METHODS, PRESETS, SEARCHES, choose


def build_method(name: str | None, *, search: str | None = None, preset: str | None = None) -> Any:
    """The method of that name, with that search, or with a paper's own parameters."""
    name = choose("method", name or METHODS[0], METHODS)
    if preset is not None:
        choose("preset", preset, PRESETS)
    if search is not None:
        choose("search", search, SEARCHES)
    raise NotImplementedError
