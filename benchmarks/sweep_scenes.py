"""What sweeps are measured on, and the methods they are measured beside."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.clock import once
from benchmarks.data import SEED
from texloom.cli.painted import score_sites, scored_patches
from texloom.domain.patches import Patches
from texloom.domain.surface import Surface
from texloom.exemplar.exemplar import Exemplar
from texloom.field.smooth import smoothest
from texloom.io.mesh import read_mesh
from texloom.io.stack import read_exemplar
from texloom.mesh.mesh import Mesh
from texloom.metrics import surface_copy_side
from texloom.output.gather import gather_sites
from texloom.sources import SourceMap
from texloom.synthesis.synthesize import Method, synthesize

BUNNY = "bunny-watertight-30k"
TEXELS = 50_000  # of each scene's surface
SCORES = ("swd", "coherence", "completeness", "copy", "seconds")


@dataclass(frozen=True, eq=False)
class Scene:
    """A sample, and the sites of a mesh that it is to cover."""

    exemplar: Exemplar
    surface: Surface
    patches: Patches  # that are scored

    @classmethod
    def of(cls, data: Path, sample: str, mesh: str) -> "Scene":
        """Sites along the smoothest field."""
        surface = sites(data, mesh)
        return cls(read_exemplar(data / "exemplars" / f"{sample}.png"), surface, scored_patches(surface))

    def grow(self, method: Method) -> tuple[SourceMap, dict[str, float]]:
        """What a method makes of it, and its scores."""
        seconds, result = once(lambda: synthesize(self.exemplar, self.surface, method, seed=SEED))
        lead = self.exemplar.lead
        scores: dict[str, Any] = vars(score_sites(lead, self.patches, gather_sites(result.sources, lead)))
        copied = surface_copy_side(result.sources, self.surface)
        return result.sources, {**scores, "copy": copied, "seconds": seconds}


@cache
def sites(data: Path, mesh: str) -> Surface:
    """About ``TEXELS`` texels of a mesh."""
    model = load(data, mesh)
    return Surface.build(model, smoothest(model, 1), texel=float(np.sqrt(model.face_areas.sum() / TEXELS)))


def load(data: Path, mesh: str) -> Mesh:
    """A mesh by name."""
    return read_mesh(data / "meshes" / f"{mesh}.obj").mesh
