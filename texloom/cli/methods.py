"""Method and search objects from the names given on the command line."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from texloom.cli.options import METHODS, PRESETS, SEARCHES, choose
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.synthesis.synthesize import Method


@dataclass(frozen=True)
class MethodWish:
    """The names, checked without importing what they stand for."""

    method: str
    search: str | None
    preset: str | None

    def build(self) -> "Method":
        """Our method of that name, or with a preset the paper's own, with one of its searches."""
        if self.preset is None:
            from texloom.synthesis.optimize import Optimize
            from texloom.synthesis.patches import PatchSampling

            return Optimize() if self.method == "optimize" else PatchSampling()
        from texloom.search import SEARCHES as by_name
        from texloom.systems import resampling

        search = None if self.search is None else by_name[self.search]
        if self.method == "optimize":
            return resampling.optimization(search=search)
        return resampling.patch_sampling(search=search)


def wish(method: str | None, search: str | None, preset: str | None) -> MethodWish:
    """The method asked for.

    Raises: ParameterError, for an unknown name, or a search without the preset it belongs to.
    """
    if preset is not None:
        choose("preset", preset, PRESETS)
    if search is not None:
        choose("search", search, SEARCHES)
        if preset is None:
            raise ParameterError(f"--search {search} is part of a paper's method: add --preset {PRESETS[0]}")
    return MethodWish(choose("method", method or METHODS[0], METHODS), search, preset)
