"""Centres for patches: sites spread evenly over any flow, closer where texels are small."""

import numpy as np
import warp as wp
from jaxtyping import Float32, Int32

from texloom import draws
from texloom.domain.cover import group_by_site
from texloom.field.trace import Flow
from texloom.kernels.launch import launch
from texloom.kernels.scatter import scatter_sites

_CHANCE = 0x7363  # purpose of the draw that orders the sites
_LEAST_APART = 0.84  # of the pitch: dart throwing to the end then leaves one centre a squared pitch


def scatter(flow: Flow, texel: Float32[np.ndarray, "site"], pitch: float, *, seed: int) -> Int32[np.ndarray, "centre"]:
    """Sites at least 0.84 ``pitch`` texels apart, and no site farther than that from one of them; in site order.

    Dart throwing in an order hashed from ``seed``, until every site is chosen or within reach of a chosen one: about
    one centre for every squared pitch. Distances are straight, between sites joined by sites within that distance.
    """
    count = len(flow.position)
    first, neighbour = site_neighbours(flow)
    turn = draws.permutation(seed, _CHANCE, count=count).astype(np.int32)
    state, stamp, queue = np.zeros(count, np.int32), np.full(count, -1, np.int32), np.empty(count, np.int32)
    radius = (_LEAST_APART * pitch * texel).astype(np.float32)
    inputs = [turn, first, neighbour, flow.position, wp.vec3(*flow.period), radius]
    launch(scatter_sites, 1, inputs=inputs, outputs=[stamp, queue, state])
    return np.flatnonzero(state == 2).astype(np.int32)


def site_neighbours(flow: Flow) -> tuple[Int32[np.ndarray, "sites_plus_one"], Int32[np.ndarray, "entry"]]:
    """Sites one edge away from each site, each once, in compressed rows."""
    ends = np.roll(flow.faces, -1, axis=1)
    border = flow.twin < 0  # elsewhere the twin runs the other way
    origin = np.concatenate([flow.faces.ravel(), ends[border]])
    target = np.concatenate([ends.ravel(), flow.faces[border]])
    start, order = group_by_site(origin, len(flow.position))
    return start, target[order]
