"""Shin & Shin 2004, "On Pixel-Based Texture Synthesis by Non-parametric Sampling", on one page.

1. Window size from the ring-integrated spectrum (§3):       ``exemplar.scale.dominant_scale``
2. Windows in a few dimensions, and a kd-tree of them (§3):  ``exemplar.windows.Windows``, ``search.tree.KdTree``
3. Seed points on a grid (§3, fig. 5):                       ``synthesis.seeds.plant``
4. Scan-line passes until little changes (§3, eq. 1):        ``refinement``
5. Texture fusion through belts (§4), maps of discs (§5):    ``fusion``, ``fusion.labels.discs``
6. Holes filled in four scan directions (§5, fig. 12):       ``filling``
7. Patches with overlaps grown anew (§5, fig. 13):           ``patches``

The paper's parameters are those here; our own methods for the same tasks are ``Refine()``, ``fuse`` and ``fill``.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Int32

from texloom.domain.domain import Domain
from texloom.exemplar.exemplar import Exemplar
from texloom.fusion.fuse import Fused, fuse
from texloom.progress import Report, silent
from texloom.synthesis.fill import Filled, fill
from texloom.synthesis.refine import Refine
from texloom.synthesis.refine_patches import RefinePatches


def refinement(*, passes: int = 10, shortlist: int = 4) -> Refine:
    """§3: scan-line order, eq. 1 with ε = 0.01. ``shortlist`` 1 takes the nearest window of the tree unseen."""
    return Refine(order="scan-line", passes=passes, shortlist=shortlist)


def hole_refinement() -> Refine:
    """§5: every pixel of a hole visited four times, from each side of it in turn; no pass is left out."""
    return Refine(order="scan-line", passes=4, threshold=0)


def region_refinement() -> Refine:
    """§4: regions in one pass, no refinement."""
    return refinement(passes=1)


def belt_refinement(smaller: float, larger: float) -> Refine:
    """§4: a belt's window is the larger sample's, its pitch the smaller's; one pass, no refinement."""
    return Refine(order="scan-line", window=round(2 * larger), pitch=max(1, round(smaller)), passes=1)


def fusion(
    samples: Sequence[Exemplar],
    labels: Int32[np.ndarray, "site"],
    domain: Domain,
    *,
    seed: int = 0,
    report: Report = silent,
) -> Fused:
    """§4: regions first, then every belt from a sample cut together of its neighbours; one pass in scan-line order."""
    return fuse(
        samples,
        labels,
        domain,
        method=region_refinement(),
        belts="sample",
        belt_method=belt_refinement,
        seed=seed,
        report=report,
    )


def filling(
    picture: Exemplar, hole: Bool[np.ndarray, "row column"], *, seed: int = 0, report: Report = silent
) -> Filled:
    """§5: the rest of the picture is the sample."""
    return fill(picture, hole, method=hole_refinement(), seed=seed, report=report)


def patches() -> RefinePatches:
    """§5: whole samples placed by FFT, their overlaps filled by scan-line refinement."""
    return RefinePatches(fill=refinement(passes=4))
