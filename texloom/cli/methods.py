"""Method and search objects from the names given on the command line."""

from typing import TYPE_CHECKING

from texloom.cli.options import METHODS, PRESETS, SEARCHES, choose
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.synthesis.synthesize import Method


def build_method(name: str | None, *, search: str | None = None, preset: str | None = None) -> "Method":
    """The method of that name: ours, or with a preset the paper's own, with one of its searches."""
    name = choose("method", name or METHODS[0], METHODS)
    if preset is not None:
        choose("preset", preset, PRESETS)
    if search is not None:
        choose("search", search, SEARCHES)
        if preset is None:
            raise ParameterError(f"--search {search} is part of a paper's method: add --preset {PRESETS[0]}")
    if preset is None:
        from texloom.synthesis.optimize import Optimize
        from texloom.synthesis.patches import PatchSampling

        return Optimize() if name == "optimize" else PatchSampling()
    raise NotImplementedError
