"""Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", on one page.

1. A vector field through the user's arrows (§3.1):        ``vector_field``
2. Patches resampled along it (§3.2):                      ``Surface.patches``, ``Grid.patches``
3. Appearance vectors and a search among patches (§4.1):   ``search.analysis.analyse``, ``SEARCHES``
4. Texture optimization, multi-level (§4.2–4.4):           ``optimization``
5. Patch-based sampling (§5):                              ``patch_sampling``

The paper's parameters are those here; our own methods for the same task are ``Optimize`` and ``PatchSampling``.
"""

from collections.abc import Sequence

from texloom.domain.surface import Surface
from texloom.exemplar.exemplar import Exemplar
from texloom.field import rbf
from texloom.field.arrows import Arrow, place
from texloom.mesh.mesh import Mesh
from texloom.progress import Report, silent
from texloom.search.matching import Search
from texloom.search.principal import PcaNearest
from texloom.synthesis.boundary import BoundarySampling
from texloom.synthesis.least_squares import LeastSquares, Stage, stages
from texloom.synthesis.result import Result
from texloom.synthesis.synthesize import synthesize


def vector_field(mesh: Mesh, arrows: Sequence[Arrow], *, texel: float, progressive: bool) -> Surface:
    """Sites along directions interpolated by radial basis functions over geodesic distance (§3.1).

    ``progressive`` spaces samples by the arrows' magnitudes as well (fig. 2c), else evenly (fig. 2b).
    """
    placed = place(mesh, arrows)
    field = rbf.directions(mesh, 1, vertices=placed.direction_vertex, directions=placed.direction)
    scale = rbf.scales(mesh, vertices=placed.scale_vertex, scales=placed.scale) if progressive else None
    return Surface.build(mesh, field, texel=texel, scale=scale)


def optimization(*, largest: int = 32, search: Search | None = None) -> LeastSquares:
    """§4 with the six stages of fig. 5; ``largest`` 40 for large structure (§6)."""
    return LeastSquares(schedule=stages(largest), search=search or PcaNearest())


def patch_sampling(*, patch: int = 32, search: Search | None = None) -> BoundarySampling:
    """§5 on three levels, with a boundary zone of 4."""
    return BoundarySampling(patch=patch, search=search or PcaNearest())


def single_level(search: Search) -> tuple[LeastSquares, BoundarySampling]:
    """Both methods as table 1 times them: 32 × 32 patches on the finest level only, ten iterations, zone 4."""
    return LeastSquares(schedule=(Stage(1, 32),), search=search), BoundarySampling(steps=(1,), search=search)


def texture(
    exemplar: Exemplar,
    mesh: Mesh,
    arrows: Sequence[Arrow],
    *,
    texel: float,
    progressive: bool = False,
    method: LeastSquares | BoundarySampling | None = None,
    seed: int = 0,
    report: Report = silent,
) -> Result:
    """The whole paper: a field from arrows, patches along it, texture by ``method`` (``optimization()`` if None)."""
    surface = vector_field(mesh, arrows, texel=texel, progressive=progressive)
    return synthesize(exemplar, surface, method or optimization(), seed=seed, report=report)
