"""What a canvas shows under patches."""

import numpy as np
from jaxtyping import Float32, Int32

from texloom.arrays import fours
from texloom.domain.patches import Patches
from texloom.kernels.launch import launch
from texloom.kernels.patches import read_patches
from texloom.synthesis.canvas import Canvas


def read(
    canvas: Canvas, patches: Patches, chosen: Int32[np.ndarray, "patch"], samples: Int32[np.ndarray, "sample"]
) -> tuple[Float32[np.ndarray, "patch sample channel"], Float32[np.ndarray, "patch sample"]]:
    """Values of ``samples`` of the ``chosen`` patches, and 1 where at least half of a sample's weight is coloured.

    The barycentric rule of Chen, Liu & Dong, section 3.2; unknown samples are 0. O(sample · channel) time.
    """
    values = np.empty((len(chosen), len(samples), canvas.colour.shape[1]), np.float32)
    known = np.empty((len(chosen), len(samples)), np.float32)
    launch(
        read_patches,
        known.size,
        inputs=[chosen, samples, patches.sites, weights_of(patches), fours(canvas.colour), canvas.label],
        outputs=[fours(values), known],
        grain=6000,
    )
    return values, known


def weights_of(patches: Patches) -> Float32[np.ndarray, "_ _ _"]:
    """The patches' sample weights as kernels take them: one dummy where every sample is a site."""
    return np.ones((1, 1, 1), np.float32) if patches.weights is None else patches.weights
