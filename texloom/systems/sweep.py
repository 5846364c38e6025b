"""Turk 2001, "Texture Synthesis on Surfaces" (the talk's slides), on one page.

1. Mesh hierarchy by repulsion (S1):               ``points.hierarchy``
2. Blur, down- and up-sampling on it (S2):         ``points.pyramid.Pyramid``
3. Vector field from arrows, coarse to fine (S3):  ``field.spread.directions``
4. Sweep distance, which orders the vertices (S4): ``field.sweep.sweep_distance``, ``domain.order.sweep_order``
5. Neighbours by steps over the surface (S5):      ``domain.network.lay_stencils``
6. Full, causal and half neighbourhoods (S6):      ``synthesis.sweep.in_shape``
7. Sweeps from coarse to fine (S7):                ``sweeps``

The talk's choices are those here; our own method for the same task is ``Sweep()``.
"""

from texloom.synthesis.sweep import Shape, Sweep


def sweeps(*, levels: int = 3, shape: Shape = "half") -> Sweep:
    """A random copy, swept along the field one vertex after the other, each level once; the nearest window exactly.

    The talk does not say how it searches; here it is the nearest of all windows in their principal components.
    """
    return Sweep(levels=levels, start="random", shape=shape, order="sequential", search="tree", alike=0, passes=1)
