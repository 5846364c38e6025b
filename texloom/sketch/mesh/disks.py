"""Repetition taken out of a texture mesh: discs of the sketches are laid on it, and draw its vertices to theirs.

Wang et al. 2014, eqs 7-8.
"""

import numpy as np
from jaxtyping import Float64, Int

from texloom import draws
from texloom.kernels.launch import launch
from texloom.sketch.graph import CellGraph
from texloom.sketch.mesh.tiling import Tiling

_DISC = 0.25  # radius of a disc, of the shortest side of a sketch
_PITCH = 2.25  # radii from disc to disc, at least: on a lattice, each shifted within its cell
_SHAKE = 0.04  # R of eq. 7, of the radius of the neighbourhood
_HALVINGS = 5
_LEAST = 0.1  # area a triangle keeps, of what it had in the patch


def refined(tiling: Tiling, seed: int, *, radius: float, iterations: int, strength: float) -> CellGraph:
    """The texture mesh with vertices moved towards a sketch's within ``radius`` texels, ``strength`` (w) of the way.

    In each iteration discs of the sketches, drawn at random, are laid at random so that none overlap. Only the ends of
    curves are drawn; what lies between is carried along. What would turn over a triangle of the web goes half as far,
    and half again, or stays: nothing crosses, no cell flips.
    """
    from texloom.kernels.sketch import refine

    places = tiling.graph.vertices
    loose = np.flatnonzero(tiling.loose).astype(np.int32)
    reach, cells, origin, disc, middle = _discs(tiling, seed, iterations)
    noise = draws.uniform(seed, 1, index=np.arange(iterations * len(loose) * 2)).astype(np.float64)
    noise = (noise.reshape(-1, 2) * 2 - 1) * (radius * _SHAKE)
    inputs = [iterations, places, loose, tiling.graph.size, tuple(cells.tolist()), origin, disc, middle]
    inputs += [(tiling.patch.joints + 0.5) * tiling.scale - 0.5, reach, radius, strength, noise]
    inputs += [tiling.carrier, tiling.share, tiling.corner, tiling.patch.web.sides * tiling.scale]
    before, step, by = (np.zeros_like(places) for _ in range(3))
    tries, named, queue = np.zeros((3, len(places)), np.int32)
    carried, suspects = np.zeros((len(tiling.carrier), 2)), np.zeros(len(tiling.corner), np.int32)
    outputs = [before, step, tries, named, queue, carried, suspects, by]
    launch(refine, 1, inputs=[*inputs, _LEAST, _HALVINGS], outputs=outputs)
    return tiling.moved(by)


def _discs(
    tiling: Tiling, seed: int, iterations: int
) -> tuple[
    float,
    Int[np.ndarray, "2"],
    Float64[np.ndarray, "iteration 2"],
    Float64[np.ndarray, "disc 2"],
    Float64[np.ndarray, "disc 2"],
]:
    """Discs' radius, their lattice and its corner, their middles in its cells, and those among the sketches."""
    size = np.array(tiling.graph.size)
    sheets = (tiling.patch.sheets.reshape(-1, 2, 2) + 0.5) * tiling.scale
    corner, sides = sheets[:, 0], sheets[:, 1] - sheets[:, 0]
    reach = float(min(_DISC * sides.min(), size.min() / _PITCH))
    cells = np.maximum(np.floor(size / (_PITCH * reach)), 1).astype(np.int64)
    count = int(cells.prod())
    chance = draws.uniform(seed, 0, index=np.arange(iterations * (2 + 4 * count))).astype(np.float64)
    origin = chance[: 2 * iterations].reshape(-1, 2) * size
    chance = chance[2 * iterations :].reshape(-1, 2, 2)
    disc = reach + chance[:, 0] * (size / cells - 2 * reach)
    sheet = (draws.uniform(seed, 2, index=np.arange(len(chance))) * len(sheets)).astype(np.int64)
    middle = corner[sheet] + reach + chance[:, 1] * (sides[sheet] - 2 * reach) - 0.5
    return reach, cells, origin, disc, middle
