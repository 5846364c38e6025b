"""Magda & Kriegman 2003, "Fast Texture Synthesis on Arbitrary Meshes", on one page.

1. Textons of Gaussian windows or of a filter bank, buckets, distances (§3.1):  ``search.textons.learn_textons``
2. Every triangle laid flat along the field, scale constant (§3.2.1):           ``domain.faces.Faces``
3. Texton strings, bucket voting, eq. 2 for the most voted (§3.2.2):            ``kernels.quilting``
4. Growth from one random triangle over the whole surface (§3.2.2):             ``quilting``
5. Edges blended over the neighbours' maps (§3.3.1), where Φ says so (§3.3.2):  ``output.blending``

The paper's parameters are those here; ours are ``learn_textons``, groups of faces and ``Quilting()``.
"""

from texloom.exemplar.exemplar import Exemplar
from texloom.progress import Report, silent
from texloom.search.textons import Textons, learn_textons
from texloom.synthesis.quilting import Quilting


def textons(exemplar: Exemplar, *, count: int | None = None, report: Report = silent) -> Textons:
    """§3.1: windows of 11×11 texels, one orientation, about as many textons as the square root of the pixels."""
    return learn_textons(exemplar, count=count, width=11, orientations=1, report=report)


def quilting(*, candidates: int = 32) -> Quilting:
    """§3.2.2: from one random triangle, textons alone, no second choice. The paper does not say how many are m."""
    return Quilting(order="random", match="textons", candidates=candidates, rounds=0)
