"""Patches traced in a field: a network of samples along its integral curves and those of its orthogonal field.

Chen, Liu & Dong, "Local resampling for patch-based texture synthesis in vector fields", §3.2.
"""

import numpy as np
import warp as wp
from jaxtyping import Complex64, Float32, Int32

from texloom.domain.neighbourhoods import Stencils
from texloom.domain.patches import Patches
from texloom.domain.reach import Covering
from texloom.field.trace import Flow, Samples, starts
from texloom.kernels.launch import launch, thread_count
from texloom.kernels.meet import meet_half_way
from texloom.kernels.stencils import trace_stencils
from texloom.kernels.trace import trace_squares

APART_AT_LEAST, APART_PER_TEXEL = 1.5, 0.2
"""Texels the two paths to a sample may end apart: always, and more for each texel of their shorter leg.

Where a field of curvature k turns, legs of u and v texels end k u v apart and half way between them samples spread or
crowd by k u / 2 and k v / 2: a tenth of a texel when the second term is spent. Past both, patches would fold.
"""

_PATCHES_A_THREAD, _MOST_SAMPLES = 32, 1 << 19
"""Traced and covered together: few enough that their tables stay in a cache, enough to keep every thread busy."""


def lay_patches(
    flow: Flow, centres: Int32[np.ndarray, "patch"], width: int, *, axis: Complex64[np.ndarray, "face 3"]
) -> Patches:
    """Patches of ``width × width`` samples traced from the sites ``centres``, which are their samples (w // 2, w // 2).

    Every sample is one texel on from its neighbour, by two ways: up or down and then left or right, and left or right
    and then up or down; it lies half way between their ends. ``axis`` is the site's frame at every face corner, as a
    direction in the face.
    """
    count, square = len(centres), width * width
    sites = np.empty((count, square, 3), np.int32)
    weights = np.empty((count, square, 3), np.float32)
    covering = Covering(flow, width, axis)
    origins = starts(flow)
    batch = max(1, min(_PATCHES_A_THREAD * max(2, thread_count()), _MOST_SAMPLES // square))
    for begin in range(0, count, batch):
        samples = trace_network(flow, origins, centres[begin : begin + batch], width)
        missed = samples.face < 0
        corners = sites[begin : begin + batch].reshape(-1, 3)
        np.take(flow.faces, samples.face, axis=0, out=corners, mode="wrap")
        corners[missed] = -1
        samples.place[missed] = 0
        weights[begin : begin + batch] = samples.place.reshape(-1, square, 3)
        covering.add(samples)
    start, patch, position, turn = covering.cover()
    return Patches(
        width=width,
        centres=centres,
        sites=sites,
        weights=weights,
        cover_start=start,
        cover_patch=patch,
        cover_position=position,
        cover_turn=turn,
    )


def lay_stencils(
    flow: Flow, sites: Int32[np.ndarray, "n"], width: int, *, axis: Complex64[np.ndarray, "face 3"]
) -> Stencils:
    """Squares of ``width × width`` samples traced from sites: so few texels that one path to each is enough.

    ``axis`` is the site's frame at every face corner, as a direction in the face.
    """
    origins, shape = _aligned(flow, starts(flow), axis), (len(sites), width * width, 3)
    laid = Stencils(np.empty(shape, np.int32), np.empty(shape, np.float32), _steps(width))
    begin = [part[sites] for part in (origins.face, origins.place, origins.heading)]
    inputs = [flow.record, flow.twin, flow.faces, flow.order, width, *begin]
    launch(trace_stencils, len(sites), inputs=inputs, outputs=[laid.sites, laid.weights])
    return laid


def _aligned(flow: Flow, origins: Samples, axis: Complex64[np.ndarray, "face 3"]) -> Samples:
    """Of the directions of a symmetric field each sample follows the one that is its site's."""
    wanted = axis[origins.face, origins.place.argmax(axis=1)]
    heading = origins.heading[:, 0] + 1j * origins.heading[:, 1]
    branch = 2 * np.pi / flow.order
    heading = heading * np.exp(1j * branch * np.rint(np.angle(wanted * heading.conj()) / branch))
    origins.heading[:] = np.stack([heading.real, heading.imag], axis=1)
    return origins


def _steps(width: int) -> Float32[np.ndarray, "1 sample 2"]:
    """[row, column] of every sample of a square from its middle one."""
    steps = np.stack(np.divmod(np.arange(width * width), width), axis=1) - width // 2
    return steps.astype(np.float32)[None]


def trace_network(flow: Flow, origins: Samples, centres: Int32[np.ndarray, "patch"], width: int) -> Samples:
    """The samples of all patches, row-major; face -1 where neither path arrives or the two disagree."""
    count, middle = len(centres), width // 2 * (width + 1)
    samples = Samples.empty(2 * count * width * width)
    centre = np.arange(middle, 2 * count * width * width, width * width)
    samples.face[centre] = np.tile(origins.face[centres], 2)
    samples.place[centre] = np.tile(origins.place[centres], (2, 1))
    samples.heading[centre] = np.tile(origins.heading[centres], (2, 1))
    outputs = [samples.face, samples.place, samples.heading]
    inputs = [flow.record, flow.twin, flow.order, width, count]
    launch(trace_squares, count, inputs=inputs, outputs=outputs)
    inputs = [flow.record, flow.twin, flow.order, flow.position, flow.faces, wp.vec3(*flow.period)]
    limits = [width, APART_AT_LEAST, APART_PER_TEXEL, count]
    launch(meet_half_way, count * width * width, inputs=[*inputs, *limits], outputs=outputs)
    return Samples(*(part[: count * width * width] for part in outputs))
