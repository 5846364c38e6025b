"""The cells of an example texture: bricks, stones, scales and whatever else has lines around it."""

import numpy as np
from jaxtyping import Bool, Float32

from texloom.errors import ExemplarError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.pca import fit
from texloom.exemplar.scale import dominant_scale
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.drawing import threshold
from texloom.sketch.reading.fitting import curved
from texloom.sketch.reading.ink import cells_of_ink, connected
from texloom.sketch.reading.lines import Lines
from texloom.sketch.reading.mending import cells_of

_BLUR = 0.07  # of the dominant scale: where lines between cells stand out
_FINEST, _COARSEST = 0.8, 2.5  # texels of that blur
_WIDER = 1.6  # the second blur, by the first: for lines of uneven width
_LEAST_CONTRAST = 0.02  # of what is compared: fainter than that is noise
_STRONGEST = 99.5  # percentile of line strength that counts as 1
_WEAK = 0.7  # of the threshold: lines as faint as that count where they continue stronger ones
_PIECE = 0.5  # of the dominant scale: a shorter line is a speck
_FEWEST = 4  # cells; fewer are no texture of cells
_FIT = 0.9  # texels from the middle of a line to the curve


def detect(exemplar: Exemplar) -> CellGraph:
    """The cells that dark or bright lines part in the example, one or the other throughout.

    Lines are ridges of the example's first principal component at a fine share of its dominant scale, gaps closed and
    specks left out as in a drawing (``cells_of_ink``). Of dark and bright ones those are taken whose cells are more
    compact (4π area / perimeter², by area): between the wrong lines lie slivers.

    Raises: ExemplarError, if neither parts four cells.
    """
    scale = dominant_scale(exemplar).scale
    flat = _even(exemplar, scale)
    found = [cells_of_ink(_lines(flat * sign, scale))[0] for sign in (1, -1)]
    rounder, lines = max(((_compactness(lines), lines) for lines in found), key=lambda pair: pair[0])
    if rounder == 0.0:
        raise ExemplarError("the example shows no cells with lines between them: give it a sketch of its own")
    rows, columns = exemplar.shape
    return curved((float(rows), float(columns)), lines, tolerance=_FIT)


def _even(exemplar: Exemplar, scale: float) -> Float32[np.ndarray, "row column"]:
    """The example's first principal component, light and contrast made even over a few scales; 0 where masked."""
    from scipy.ndimage import gaussian_filter

    image = match_image(exemplar)
    texels = image.reshape(-1, image.shape[2])
    grey = fit(texels[exemplar.usable.ravel()], 1)(texels).reshape(exemplar.shape)
    flat = np.where(exemplar.usable, grey - gaussian_filter(grey, scale, mode="nearest"), np.float32(0))
    contrast = np.sqrt(gaussian_filter(flat**2, 2 * scale, mode="nearest"))
    return flat / (contrast + np.float32(_LEAST_CONTRAST))


def _lines(flat: Float32[np.ndarray, "row column"], scale: float) -> Bool[np.ndarray, "row column"]:
    """Where lines lower than their surroundings run."""
    from scipy.ndimage import find_objects

    blur = float(np.clip(_BLUR * scale, _FINEST, _COARSEST))
    strength = np.maximum(_valley(flat, blur), _valley(flat, _WIDER * blur))
    strength = np.clip(strength / max(float(np.percentile(strength, _STRONGEST)), 1e-6), 0, 1)
    strong = threshold(strength[strength > 0])[0]
    pieces, count = connected(strength > _WEAK * strong)
    kept = np.bincount(pieces[strength > strong], minlength=count + 1) > 0
    kept[0] = False
    sides = [max(side.stop - side.start for side in box) for box in find_objects(pieces)]
    kept[1:] &= np.array(sides, np.int64) >= _PIECE * scale
    return kept[pieces]


def _valley(flat: Float32[np.ndarray, "row column"], blur: float) -> Float32[np.ndarray, "row column"]:
    """The larger principal curvature at a scale, in units that do not depend on it."""
    from scipy.ndimage import gaussian_filter

    down, across, both = (
        np.asarray(gaussian_filter(flat, blur, order=order, mode="nearest"))  # pyright: ignore[reportArgumentType]
        for order in ((2, 0), (0, 2), (1, 1))
    )
    return blur**2 * ((down + across) / 2 + np.hypot((down - across) / 2, both))


def _compactness(lines: Lines) -> float:
    """4π area / perimeter² of the cells, large ones counting more; 0 where there are too few."""
    cells = cells_of(lines)
    if len(cells) < _FEWEST:
        return 0.0
    tail, head = lines.vertices[lines.edges].transpose(1, 0, 2)
    around = np.add.reduceat(np.hypot(*(head - tail).T)[cells.halfedge // 2], cells.start[:-1])
    return float((4 * np.pi * cells.area**2 / around**2).sum() / cells.area.sum())
