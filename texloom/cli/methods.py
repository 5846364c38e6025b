"""Method and search objects from the names given on the command line."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

from texloom.cli.options import (
    METHODS,
    PRESET_METHODS,
    PRESETS,
    SEARCHES,
    SHAPES,
    SURFACE_METHODS,
    SURFACE_PRESETS,
    SWEEP_SEARCHES,
    choose,
)
from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.fusion.fuse import BeltMethod
    from texloom.synthesis.growth import Grower
    from texloom.synthesis.optimize import Optimize
    from texloom.synthesis.patches import PatchSampling
    from texloom.synthesis.refine import Refine
    from texloom.synthesis.refine_patches import RefinePatches
    from texloom.synthesis.sweep import Sweep
    from texloom.synthesis.synthesize import Method

Task = Literal["fill", "fuse"]


@dataclass(frozen=True)
class MethodWish:
    """The names, checked without importing what they stand for."""

    method: str
    search: str | None
    preset: str | None
    parameters: Mapping[str, Any] = field(default_factory=dict)  # of Refine or Sweep, those that are set

    def build(self) -> "Method":
        """Our method of that name, or with a preset the paper's own, with one of its searches."""
        if self.method == "sweep":
            return self._sweeping()
        if self.preset == "resampling":
            from texloom.search import SEARCHES as by_name
            from texloom.systems import resampling

            search = None if self.search is None else by_name[self.search]
            if self.method == "optimize":
                return resampling.optimization(search=search)
            return resampling.patch_sampling(search=search)
        return self._refining(None) if self.preset == "refine" else self._ours()

    def grower(self, task: Task) -> "Grower":
        """The same where texture is there already, to be continued; a paper's own for that task.

        Raises: ParameterError, if the method, or those of the preset, begin with nothing.
        """
        if self.method == "sweep":
            raise ParameterError("--method sweep grows whole textures and cannot continue one: choose another")
        if self.preset == "resampling":
            raise ParameterError(
                "--preset resampling grows whole textures and cannot continue one: choose --preset refine, or none"
            )
        return self._refining(task) if self.preset == "refine" else self._ours()

    def belt_method(self) -> "BeltMethod | None":
        """How a paper fills the belts of a fusion."""
        if self.preset != "refine":
            return None
        from texloom.systems.refine import belt_refinement

        return belt_refinement

    def _ours(self) -> "Optimize | PatchSampling | Refine | RefinePatches":
        from texloom.synthesis.optimize import Optimize
        from texloom.synthesis.patches import PatchSampling

        if self.method == "refine":
            from texloom.synthesis.refine import Refine

            return Refine(**self.parameters)
        if self.method == "refine-patches":
            from texloom.synthesis.refine_patches import RefinePatches

            return RefinePatches()
        return Optimize() if self.method == "optimize" else PatchSampling()

    def _sweeping(self) -> "Sweep":
        """Ours, or the talk's."""
        from texloom.synthesis.sweep import Sweep
        from texloom.systems import sweep

        return replace(sweep.sweeps() if self.preset == "sweep" else Sweep(), **self.parameters)

    def _refining(self, task: Task | None) -> "Refine | RefinePatches":
        """Of the paper of ``refine``, what it does the task with, but for the parameters set."""
        from texloom.systems import refine

        if self.method == "refine-patches":
            return refine.patches()
        papers = {None: refine.refinement, "fill": refine.hole_refinement, "fuse": refine.region_refinement}
        return replace(papers[task](), **self.parameters)


def wish(
    method: str | None, search: str | None, preset: str | None, *, surface: bool = False, **given: str | float | None
) -> MethodWish:
    """The method asked for; ``given`` are parameters of ``refine``, on a surface of ``sweep``; None: not given.

    Without a name it is the preset's first, or the default. Raises: ParameterError, for an unknown name, a search
    without the preset it belongs to, or parameters of another method.
    """
    if preset is not None:
        choose("preset", preset, SURFACE_PRESETS if surface else PRESETS)
    known = SURFACE_METHODS[:-1] if surface else METHODS
    offered = known if preset is None else PRESET_METHODS[preset]
    method = choose("method", method or offered[0], known)
    if method not in offered:
        raise ParameterError(f"--preset {preset} has no {method}: choose {' or '.join(offered)}, or no preset")
    if method == "sweep":
        given["search"] = None if search is None else choose("search", search, SWEEP_SEARCHES)
        search = None
        random = given.get("start") == "random" or (preset == "sweep" and given.get("start") is None)
        if given.get("shape") in SHAPES and not random:
            raise ParameterError(f"--shape {given['shape']} is for a random copy's first sweep: add --start random")
    if search is not None:
        choose("search", search, SEARCHES)
        if preset is None:
            raise ParameterError(f"--search {search} is part of a paper's method: add --preset {PRESETS[0]}")
        if preset != PRESETS[0]:
            raise ParameterError(f"--search {search} is for --preset {PRESETS[0]}, {preset} has its own: leave it out")
    parameters = {name: value for name, value in given.items() if value is not None}
    owner = "sweep" if surface else "refine"
    if parameters and method != owner:
        name, value = next(iter(parameters.items()))
        raise ParameterError(f"--{name} {value} is not for {method}: add --method {owner}")
    return MethodWish(method, search, preset, parameters)
