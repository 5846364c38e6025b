"""Wang et al. 2014, "Interactive texture design and synthesis from mesh sketches", on one page.

1. A sketch, drawn, detected or at random (§3, §4.1):  ``sketch.read.read_sketch``, ``sketch.detect``, ``sketch.random``
2. Best crop, seamless patch (§3.1, eqs 1-6):          ``sketch.patch.seamless_patch``
3. Tiling, disc refinement (§3.1, eqs 7, 8):           ``sketch.tiling.tile``, ``sketch.disks.refined``
4. Distance and orientation maps (§3.2, eqs 9-12):     ``sketch.maps.feature_maps``
5. Edges and cells initialized (§3.2, eq. 13):         ``sketch.warp.Initialization``, ``sketch.kinds``
6. Pixels in turned neighbourhoods (§3.2, fig. 13):    ``sketch.pixels.PixelSynthesis``

All of it together is ``sketch.design.Design``; the paper's choices are those here.
"""

from typing import Literal

import numpy as np
from jaxtyping import Float32

from texloom.sketch.design import Design
from texloom.sketch.kinds import Deal
from texloom.sketch.mesh import TextureMesh
from texloom.sketch.patch import Sketches
from texloom.sketch.pixels import PixelSynthesis
from texloom.sketch.sample import SketchSample
from texloom.sketch.warp import Initialization


def design(
    sketch: Sketches,
    sample: SketchSample,
    mesh: TextureMesh,
    *,
    inside: Literal["radial", "scale"] = "radial",
    pattern: Float32[np.ndarray, "row column channel"] | None = None,
    turned: bool = True,
    seed: int = 0,
) -> Design:
    """Cells at random, edges by the nearest distance feature, neighbourhoods turned (or not, as in fig. 3, right)."""
    return Design(
        sketch=sketch,
        sample=sample,
        mesh=mesh,
        pattern=pattern,
        deal=Deal(by="random"),
        initialization=Initialization(inside=inside, lines="nearest"),
        pixels=PixelSynthesis(passes=4, turned=turned),
        seed=seed,
    )
