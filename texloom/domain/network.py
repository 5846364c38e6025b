"""Patches traced in a field: a network of samples along its integral curves and those of its orthogonal field.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", §3.2.
"""

import numpy as np
import warp as wp
from jaxtyping import Complex64, Int32

from texloom.domain.patches import Patches
from texloom.domain.reach import cover_of
from texloom.field.trace import Flow, Samples, follow, spokes, starts
from texloom.kernels.launch import launch
from texloom.kernels.trace import meet_half_way

APART_AT_LEAST, APART_PER_TEXEL = 1.5, 0.2
"""Texels the two paths to a sample may end apart: always, and more for each texel of their shorter leg.

Where a field of curvature k turns, legs of u and v texels end k u v apart and half way between them samples spread or
crowd by k u / 2 and k v / 2: a tenth of a texel when the second term is spent. Past both, patches would fold.
"""


def lay_patches(
    flow: Flow, centres: Int32[np.ndarray, "patch"], width: int, *, axis: Complex64[np.ndarray, "face 3"]
) -> Patches:
    """Patches of ``width × width`` samples traced from the sites ``centres``, which are their samples (w // 2, w // 2).

    Every sample is one texel on from its neighbour, by two ways: up or down and then left or right, and left or right
    and then up or down; it lies half way between their ends. ``axis`` is the site's frame at every face corner, as a
    direction in the face.
    """
    samples = trace_network(flow, centres, width)
    reached = samples.face >= 0
    sites = np.where(reached[:, None], flow.faces[samples.face], -1).astype(np.int32)
    samples.place[~reached] = 0
    start, patch, position, turn = cover_of(flow, samples, width, axis)
    shape = (len(centres), width * width, 3)
    return Patches(
        width=width,
        centres=centres,
        sites=sites.reshape(shape),
        weights=samples.place.reshape(shape),
        cover_start=start,
        cover_patch=patch,
        cover_position=position,
        cover_turn=turn,
    )


def trace_network(flow: Flow, centres: Int32[np.ndarray, "patch"], width: int) -> Samples:
    """The samples of all patches, row-major; face -1 where neither path arrives or the two disagree."""
    origins = starts(flow)
    up, down, left, right = spokes(width)
    samples = _two_leg_paths(flow, origins, centres, width, legs=((up, down), (left, right)))
    other = _two_leg_paths(flow, origins, centres, width, legs=((left, right), (up, down)))
    launch(
        meet_half_way,
        len(samples.face),
        inputs=[
            *(flow.record, flow.twin, flow.order, flow.position, flow.faces, wp.vec3(*flow.period)),
            *(width, APART_AT_LEAST, APART_PER_TEXEL),
            *(other.face, other.place, other.heading),
        ],
        outputs=[samples.face, samples.place, samples.heading],
    )
    return samples


def _two_leg_paths(
    flow: Flow, origins: Samples, centres: Int32[np.ndarray, "patch"], width: int, legs: tuple
) -> Samples:
    """Samples reached from each centre along the first legs, and from every sample of those along the second."""
    middle = width // 2
    samples = Samples.empty(len(centres) * width * width)
    centre = (np.arange(len(centres)) * width * width + middle * width + middle).astype(np.int32)
    samples.face[centre] = origins.face[centres]
    samples.place[centre] = origins.place[centres]
    samples.heading[centre] = origins.heading[centres]
    spine = centre[:, None] + (np.arange(width) - middle).astype(np.int32) * abs(legs[0][0][0])
    for first, leg in ((centre, legs[0]), (np.ascontiguousarray(spine.ravel(), np.int32), legs[1])):
        for stride, steps, quarters in leg:
            follow(flow, samples, first, stride=stride, steps=steps, quarters=quarters)
    return samples
