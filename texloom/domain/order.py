"""In which order sites are visited: along the field, or in parts that share no edge."""

import numpy as np
from jaxtyping import Int32

from texloom.domain.surface import Surface
from texloom.field.sweep import sweep_distance
from texloom.kernels.cover import colour_greedily
from texloom.kernels.launch import launch


def sweep_order(surface: Surface) -> Int32[np.ndarray, "site"]:
    """Sites by their distance along the field from where it starts, front after front; a front is half a texel deep.

    A front goes outwards from its site nearest to the start, so that, where it can, what lies beside a site is visited
    before it too: where the field runs in loops and has no start, all sites are one front.
    """
    distance = sweep_distance(surface.refined.mesh, surface.field)
    front = np.floor(distance / (0.5 * float(np.median(surface.texel_length))))
    place = surface.refined.mesh.vertices
    start = place[np.argmin(distance)]
    apart = np.linalg.norm(place - start, axis=1)
    return np.lexsort((apart, front)).astype(np.int32)


def colour_parts(surface: Surface) -> list[Int32[np.ndarray, "part"]]:
    """All sites, parted so that neighbours are in different parts: about seven."""
    start, ring = surface.neighbours
    colour = np.empty(surface.count, np.int32)
    launch(colour_greedily, 1, inputs=[start, ring], outputs=[colour])
    return [np.flatnonzero(colour == number).astype(np.int32) for number in range(int(colour.max(initial=-1)) + 1)]
