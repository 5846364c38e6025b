"""Wang et al. 2014, "Interactive texture design and synthesis from mesh sketches", on one page.

1. A sketch, drawn, detected or at random (§3, §4.1):  ``sketch.reading``, ``sketch.random``
2. Best crop, seamless patch (§3.1, eqs 1-6):          ``sketch.mesh.patch.seamless_patch``
3. Tiling, disc refinement (§3.1, eqs 7, 8):           ``sketch.mesh.tiling.tile``, ``sketch.mesh.disks.refined``
4. Distance and orientation maps (§3.2, eqs 9-12):     ``sketch.filling.maps.feature_maps``
5. Edges and cells initialized (§3.2, eq. 13):         ``sketch.filling.warp.Initialization``
6. Pixels in turned neighbourhoods (§3.2, fig. 13):    ``sketch.filling.pixels.PixelSynthesis``

All of it together is ``sketch.design.Design``; the paper's choices are those here.
"""

from typing import Literal

import numpy as np
from jaxtyping import Float32

from texloom.sketch.design import Design
from texloom.sketch.filling.kinds import Deal
from texloom.sketch.filling.pixels import PixelSynthesis
from texloom.sketch.filling.warp import Initialization
from texloom.sketch.mesh.patch import Sketches
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.sample import SketchSample


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
        pixels=PixelSynthesis(passes=4, turned=turned, sparse=False),
        seed=seed,
    )
