"""Texture that grows from head to foot.

A scale field makes the same texture finer here and coarser there: patches are spaced by it, so features keep their form
and change their size. Left uniform; middle and right progressively variant, from 0.5 on the ears to 1.5 at the feet.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", fig. 1.
"""

import numpy as np

import texloom
from examples.pictures import BACK, FRONT, Picture, beside, coat
from texloom.demo import draw, rabbit


def picture(detail: float = 1.0) -> Picture:
    """Scales at one size and at many; ``detail`` scales how many texels cover the mesh."""
    mesh, sample = rabbit(), draw("scales", size=160)
    texel = texloom.texel_for_repeats(mesh, 2.2 * detail, sample.shape[1])
    field = texloom.smoothest(mesh, 1)
    low, high = mesh.vertices[:, 1].min(), mesh.vertices[:, 1].max()
    growing = 1.5 * (0.5 / 1.5) ** ((mesh.vertices[:, 1] - low) / (high - low))

    pictures = []
    for scale, views in ((np.ones(len(mesh.vertices)), [FRONT]), (growing, [FRONT, BACK])):
        surface = texloom.Surface.build(mesh, field, texel=texel, scale=scale)
        result = texloom.synthesize(sample, surface, seed=0)
        pictures.append(coat(surface, result.sources, sample, views))
    return beside(*pictures, gap=0)
