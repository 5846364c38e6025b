"""Seed points: a coarse grid of texels that guides the first pass (Shin & Shin 2004, section 3, fig. 5)."""

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom import draws
from texloom.arrays import Image
from texloom.errors import ExemplarError

_BEST = 5  # best matching tiles, of which one is drawn
_STEP = 4  # unit tiles of the sample begin at this part of the pitch
_DRAW = 0x5EED  # purpose of the draws among them


def plant(
    image: Image,
    pitch: int,
    grid: tuple[int, int],
    *,
    seed: int,
    usable: Bool[np.ndarray, "row column"] | None = None,
) -> Int32[np.ndarray, "grid_row grid_column 2"]:
    """[row, column] in the sample of every seed of a ``grid`` of (rows, columns) points, ``pitch`` texels apart.

    Four seeds around a slot show the corners of one unit tile, or of tiles with like corners: slots are filled in
    scan-line order, each by one of the five tiles whose corners fit best the seeds that are there. Departure: tiles
    begin at every quarter of the pitch instead of the whole one, or a large structure leaves no choice.

    Raises: ExemplarError, if no tile fits into the sample's usable part.
    """
    tiles = _unit_tiles(image.shape[:2], pitch, usable)
    colours = image[tiles[..., 0], tiles[..., 1]]
    rows, columns = grid
    source = np.zeros((rows, columns, 2), np.int32)
    planted = np.zeros(grid, bool)
    for slot in range(max(rows - 1, 1) * max(columns - 1, 1)):
        row, column = divmod(slot, max(columns - 1, 1))
        around = slice(row, row + 2), slice(column, column + 2)  # cut off where the grid has one row or column
        known = planted[around].copy()
        corner = slice(0, known.shape[0]), slice(0, known.shape[1])
        shown = image[source[around][known][:, 0], source[around][known][:, 1]]
        chosen = _draw(colours[:, *corner][:, known], shown, seed, slot)
        source[around][~known] = tiles[chosen, *corner][~known]
        planted[around] = True
    return source


def _draw(
    colours: Float32[np.ndarray, "tile known channel"],
    shown: Float32[np.ndarray, "known channel"],
    seed: int,
    slot: int,
) -> int:
    """One of the tiles whose corners fit best what is shown there; any tile where nothing is."""
    drawn = float(draws.uniform(seed, _DRAW, index=np.array([slot]))[0])
    if not len(shown):
        return int(drawn * len(colours))
    best = np.argsort(((colours - shown) ** 2).sum((1, 2)), kind="stable")[:_BEST]
    return int(best[int(drawn * len(best))])


def _unit_tiles(
    shape: tuple[int, int], pitch: int, usable: Bool[np.ndarray, "row column"] | None
) -> Int32[np.ndarray, "tile 2 2 2"]:
    """[row, column] of the corners (upper and lower, left and right) of the sample's tiles, scan-line order."""
    step = max(pitch // _STEP, 1)
    start = [np.arange(0, max(size - pitch, 0), step, dtype=np.int32) for size in shape]
    first = np.stack(np.meshgrid(*start, indexing="ij"), axis=-1).reshape(-1, 1, 1, 2)
    tiles = first + np.array([[[0, 0], [0, pitch]], [[pitch, 0], [pitch, pitch]]], np.int32)
    if usable is not None:
        tiles = tiles[usable[tiles[..., 0], tiles[..., 1]].all((1, 2))]
    if not len(tiles):
        raise ExemplarError(f"no tile {pitch} texels wide lies inside the sample: lower the pitch, or widen the mask")
    return tiles
