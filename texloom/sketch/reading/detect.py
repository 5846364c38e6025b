"""The cells of an example texture: bricks, stones, scales and whatever else lines, colours or repeats part."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Bool, Float32, Int

from texloom.arrays import Image
from texloom.errors import ExemplarError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.pca import fit
from texloom.exemplar.scale import dominant_scale
from texloom.sketch.cells import Cells
from texloom.sketch.graph import CellGraph
from texloom.sketch.reading.drawing import threshold
from texloom.sketch.reading.fitting import curved
from texloom.sketch.reading.ink import cells_of_ink, connected
from texloom.sketch.reading.lattice import lattice_of, tiles
from texloom.sketch.reading.lines import Lines
from texloom.sketch.reading.mending import cells_of

_BLUR = 0.07  # of the dominant scale: where lines between cells stand out
_FINEST, _COARSEST = 0.8, 2.5  # texels of that blur
_WIDER = 1.6  # the second blur, by the first: for lines of uneven width
_LEAST_CONTRAST = 0.02  # of what is compared: fainter than that is noise
_STRONGEST = 99.5  # percentile of line strength that counts as 1
_WEAK = 0.7  # of the threshold: lines as faint as that count where they continue stronger ones
_PIECE = 0.5  # of the dominant scale: a shorter line is a speck
_CROSSING = 12.0  # squares of the blur: so little between steps is where they cross, and cancel out
_GRAIN = 1.0  # texels: the blur that takes off what no cells foretell
_LEAST_TOLD = 0.15  # by colours or repeats: noise comes to as much
_AS_LARGE = 2.5  # times as large, or as small, as a tile: it may hold two cells
_FEWEST = 4  # cells; fewer are no texture of cells
_FIT = 0.9  # texels from the middle of a line to the curve

_Plane = Float32[np.ndarray, "row column"]
_Reading = tuple[float, Callable[[], Lines]]  # the share of the example that it tells, and its borders


def detect(exemplar: Exemplar) -> CellGraph:
    """The cells that lines, colours or repeats part in the example: of three readings the one that tells most of it.

    Lines, all dark or all bright, are ridges of the example's first principal component at a fine share of its dominant
    scale, gaps closed and specks left out as in a drawing (``cells_of_ink``). Borders between cells of different
    colours are ridges of the colour's gradient. Repeats are tiles on a lattice; where the others find cells as
    large, those are the tiles, and they know better where borders run. What each tells is a share of variance.

    Raises: ExemplarError, if no reading finds four cells.
    """
    rows, columns = exemplar.shape
    scale = dominant_scale(exemplar).scale
    image = match_image(exemplar)
    shade = _even(_main(image, exemplar), exemplar.usable, scale)
    lined, coloured = _lined(shade, scale), _coloured(image, exemplar, scale)
    told, borders = coloured if coloured[0] > max(lined[0], _LEAST_TOLD) else lined
    lines = borders()
    cells = cells_of(lines)
    tiled = _repeated(_smooth(shade), exemplar, more=max(told if len(cells) >= _FEWEST else 0.0, _LEAST_TOLD))
    if len(cells_of(tiled)) >= _FEWEST and not _as_large(cells, cells_of(tiled)):
        lines = tiled
    elif len(cells) < _FEWEST:
        raise ExemplarError("the example shows no cells with lines between them: give it a sketch of its own")
    return curved((float(rows), float(columns)), lines, tolerance=_FIT)


def _as_large(cells: Cells, tiles: Cells) -> bool:
    """Whether most of the cells' area is in cells about as large as a tile."""
    by = np.maximum(cells.area / tiles.area.mean(), tiles.area.mean() / cells.area)
    return 2 * float(cells.area[by < _AS_LARGE].sum()) > float(cells.area.sum())


def _lined(shade: _Plane, scale: float) -> _Reading:
    """Dark or bright lines: what the distance to the nearest one tells of the shade.

    Those are taken whose cells are more compact (4π area / perimeter², by area): between the wrong lines lie slivers.
    """
    found = [cells_of_ink(_strong(ridges, scale))[0] for ridges in _ridges(shade, _blur(scale))]
    lines = max(found, key=_compactness)
    return _told(_smooth(shade), _away(_ruled(lines, shade.shape))), lambda: lines


def _coloured(image: Image, exemplar: Exemplar, scale: float) -> _Reading:
    """Cells of different colours: what distance to a step tells of the steps, times what the cell does of the colour.

    Both have to hold: within their outlines even cells with lines around them are not of one colour.
    """
    steps = _even(_gradient(image, _blur(scale)), exemplar.usable, scale)
    ink = _filled(_strong(_ridges(steps, _blur(scale))[1], scale), _CROSSING * _blur(scale) ** 2)
    return _told(_smooth(steps), _away(ink)) * _told(image, _pieces(ink)), lambda: cells_of_ink(ink)[0]


def _repeated(shade: _Plane, exemplar: Exemplar, *, more: float) -> Lines:
    """Tiles, if the others tell more of each than that; else nothing."""
    lattice = lattice_of(shade, exemplar.usable)
    if lattice is None or lattice.order <= more:
        return Lines(np.zeros((0, 2)), np.zeros((0, 2), np.int64))
    return tiles(shade, lattice)


def _blur(scale: float) -> float:
    return float(np.clip(_BLUR * scale, _FINEST, _COARSEST))


def _main(image: Image, exemplar: Exemplar) -> _Plane:
    """The example's first principal component."""
    texels = image.reshape(-1, image.shape[2])
    return fit(texels[exemplar.usable.ravel()], 1)(texels).reshape(exemplar.shape)


def _gradient(image: Image, blur: float) -> _Plane:
    """The root of how steeply the example changes over a blur's length: faint steps count beside strong ones."""
    from scipy.ndimage import gaussian_gradient_magnitude

    along = [gaussian_gradient_magnitude(channel, blur, mode="nearest") for channel in np.moveaxis(image, 2, 0)]
    return np.sqrt(np.float32(blur) * np.linalg.norm(along, axis=0))


def _even(plane: _Plane, usable: Bool[np.ndarray, "row column"], scale: float) -> _Plane:
    """Level and contrast made even over a few scales; 0 where masked."""
    from scipy.ndimage import gaussian_filter

    flat = np.where(usable, plane - gaussian_filter(plane, scale, mode="nearest"), np.float32(0))
    contrast = np.sqrt(gaussian_filter(flat**2, 2 * scale, mode="nearest"))
    return flat / (contrast + np.float32(_LEAST_CONTRAST))


def _smooth(plane: _Plane) -> _Plane:
    from scipy.ndimage import gaussian_filter

    return np.asarray(gaussian_filter(plane, _GRAIN, mode="nearest"))


def _strong(strength: _Plane, scale: float) -> Bool[np.ndarray, "row column"]:
    """Where lines run: strong ridges and what continues them, without specks."""
    from scipy.ndimage import find_objects

    strength = np.clip(strength / max(float(np.percentile(strength, _STRONGEST)), 1e-6), 0, 1)
    strong = threshold(strength[strength > 0])[0]
    pieces, count = connected(strength > _WEAK * strong)
    kept = np.bincount(pieces[strength > strong], minlength=count + 1) > 0
    kept[0] = False
    sides = [max(side.stop - side.start for side in box) for box in find_objects(pieces)]
    kept[1:] &= np.array(sides, np.int64) >= _PIECE * scale
    return kept[pieces]


def _filled(ink: Bool[np.ndarray, "row column"], texels: float) -> Bool[np.ndarray, "row column"]:
    """Without holes of fewer texels; what the picture's edge cuts is none."""
    pieces, count = connected(~ink)
    hole = np.bincount(pieces.ravel(), minlength=count + 1) < texels
    hole[np.concatenate([pieces[0], pieces[-1], pieces[:, 0], pieces[:, -1]])] = False
    return ink | hole[pieces]


def _ridges(plane: _Plane, blur: float) -> tuple[_Plane, _Plane]:
    """How much each texel is on a line lower, and on one higher, than its surroundings, the wider of two blurs."""
    lower, higher = zip(_curvatures(plane, blur), _curvatures(plane, _WIDER * blur), strict=True)
    return np.maximum(*lower), np.maximum(*higher)


def _curvatures(plane: _Plane, blur: float) -> tuple[_Plane, _Plane]:
    """The larger principal curvature of the plane and of its negative, in units that do not depend on the blur."""
    from scipy.ndimage import gaussian_filter

    down, across, both = (
        np.asarray(gaussian_filter(plane, blur, order=order, mode="nearest"))  # pyright: ignore[reportArgumentType]
        for order in ((2, 0), (0, 2), (1, 1))
    )
    mean, apart = (down + across) / 2, np.hypot((down - across) / 2, both)
    return blur**2 * (apart + mean), blur**2 * (apart - mean)


def _ruled(lines: Lines, shape: tuple[int, ...]) -> Bool[np.ndarray, "row column"]:
    """The texels that borders run through, over corners."""
    ruled = np.zeros(shape, bool)
    tail, head = lines.vertices[lines.edges].transpose(1, 0, 2)
    count = np.ceil(np.abs(head - tail).max(axis=1, initial=0)).astype(np.int64) + 1
    of = np.repeat(np.arange(len(count)), count)
    share = (np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)) / (count[of] - 1 + 1e-9)
    row, column = np.floor(tail[of] + share[:, None] * (head - tail)[of] + 0.5).astype(np.int64).T
    ruled[np.clip(row, 0, shape[0] - 1), np.clip(column, 0, shape[1] - 1)] = True
    return ruled


def _away(ruled: Bool[np.ndarray, "row column"]) -> Int[np.ndarray, "row column"]:
    """Whole texels to the nearest border; 0 where there is none."""
    from scipy.ndimage import distance_transform_edt

    if not ruled.any():
        return np.zeros(ruled.shape, np.int64)
    return np.round(np.asarray(distance_transform_edt(~ruled))).astype(np.int64)


def _pieces(ink: Bool[np.ndarray, "row column"]) -> Int[np.ndarray, "row column"]:
    """The number of the nearest piece between the ink."""
    from scipy.ndimage import distance_transform_edt

    pieces = connected(~ink)[0]
    rows, columns = np.asarray(distance_transform_edt(ink, return_distances=False, return_indices=True))
    return pieces[rows, columns]


def _told(image: Float32[np.ndarray, "row column *channel"], group: Int[np.ndarray, "row column"]) -> float:
    """The share of an image's variance that lies between groups of texels."""
    texels, of = image.reshape(group.size, -1), group.ravel()
    count = np.maximum(np.bincount(of), 1)
    mean = np.stack([np.bincount(of, channel) / count for channel in texels.T], axis=1)
    within = np.square(texels - mean[of]).sum(axis=1).mean()
    return 1 - float(within) / max(float(texels.var(axis=0, dtype=np.float64).sum()), 1e-12)


def _compactness(lines: Lines) -> float:
    """4π area / perimeter² of the cells, large ones counting more; 0 where there are too few."""
    cells = cells_of(lines)
    if len(cells) < _FEWEST:
        return 0.0
    tail, head = lines.vertices[lines.edges].transpose(1, 0, 2)
    around = np.add.reduceat(np.hypot(*(head - tail).T)[cells.halfedge // 2], cells.start[:-1])
    return float((4 * np.pi * cells.area**2 / around**2).sum() / cells.area.sum())
