"""Maps to labels: which sample each site shows, from a coloured picture or from discs strewn by chance."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float64, Int32

from texloom import draws
from texloom.errors import ParameterError

# Colours found in a map count in this order, so that painting on does not exchange samples: red, blue, green, yellow,
# magenta, cyan, black, grey, white.
_ORDER = np.array(
    [(1, 0, 0), (0, 0, 1), (0, 1, 0), (1, 1, 0), (1, 0, 1), (0, 1, 1), (0, 0, 0), (0.5, 0.5, 0.5), (1, 1, 1)]
)
_FLAT = 0.05  # steps of colour between neighbours that a flat area may have
_APART = 0.1  # colours of a palette differ by more
_BITS = 5  # a channel, of the histogram in which colours are found
_ROUNDS = 8  # of k-means, from a start that is nearly right
_CENTRE, _KIND = 0xD15C, 0xD15D  # purposes of the draws that place and colour discs
_ROUND = 1024  # discs drawn at a time


@dataclass(frozen=True, eq=False)
class Labelled:
    """The sample each texel or vertex of a map asks for, and the colour that stands for each sample."""

    labels: Int32[np.ndarray, "*shape"]
    palette: Float64[np.ndarray, "sample 3"]


def from_picture(
    picture: Float[np.ndarray, "row column 3"],
    count: int,
    palette: Float[np.ndarray, "sample 3"] | None = None,
) -> Labelled:
    """Labels of a drawn, photographed or rendered map; each texel goes to the nearest colour of the palette.

    Colours are as seen (encoded), in [0, 1]. Without a palette the ``count`` dominant colours of flat areas are found.
    Areas under 3 texels across, such as the mixed colours along a smoothed border, fall to what lies beside them.

    Raises: ParameterError, unless there are as many colours as samples.
    """
    picture = np.asarray(picture, np.float64)
    found = from_colours(picture[_flat(picture)], count, palette)
    return Labelled(without_slivers(nearest_colour(picture, found.palette)), found.palette)


def from_colours(
    colours: Float[np.ndarray, "n 3"], count: int, palette: Float[np.ndarray, "sample 3"] | None = None
) -> Labelled:
    """Labels of single colours, of vertices for example; like ``from_picture``."""
    if palette is None:
        palette = dominant_colours(colours, count)
    elif len(palette) != count:
        raise ParameterError(f"colours in the palette: {len(palette)}, samples: {count}: give one a sample")
    return Labelled(nearest_colour(colours, palette), np.asarray(palette, np.float64))


def dominant_colours(colours: Float[np.ndarray, "n 3"], count: int) -> Float64[np.ndarray, "count 3"]:
    """The ``count`` colours that stand for most: by frequency and distance, then weighted k-means.

    They are ordered by the nearest of red, blue, green, yellow, magenta, cyan, black, grey and white, then by
    brightness, whatever their shares.

    Raises: ParameterError, where fewer differ.
    """
    levels = (1 << _BITS) - 1
    cells = np.rint(np.clip(colours, 0, 1) * levels).astype(np.int64) @ (1 << _BITS * np.arange(3))
    _, cell, share = np.unique(cells, return_inverse=True, return_counts=True)
    mean = np.stack([np.bincount(cell, colours[:, k]) for k in range(3)], 1) / share[:, None]
    found = mean[[share.argmax()]]
    while len(found) < count:
        apart = _distance(mean, found).min(1)
        if apart.max() < _APART:
            raise ParameterError(
                f"the map has {len(found)} colours, but there are {count} samples: paint more, or give a palette"
            )
        found = np.concatenate([found, mean[[(share * apart**2).argmax()]]])
    for _ in range(_ROUNDS):
        nearest = _distance(mean, found).argmin(1)
        weight = np.bincount(nearest, share, count)
        sums = np.stack([np.bincount(nearest, share * mean[:, k], count) for k in range(3)], 1)
        found = np.where(weight[:, None] > 0, sums / np.maximum(weight, 1)[:, None], found)
    return found[np.lexsort((found.sum(1), _distance(found, _ORDER).argmin(1)))]


def nearest_colour(
    colours: Float[np.ndarray, "*shape 3"], palette: Float[np.ndarray, "sample 3"]
) -> Int32[np.ndarray, "*shape"]:
    """The row of the palette nearest to each colour; the first among equals."""
    distance = np.stack([((colours - colour) ** 2).sum(-1) for colour in palette], -1)
    return distance.argmin(-1).astype(np.int32)


def without_slivers(labels: Int32[np.ndarray, "row column"]) -> Int32[np.ndarray, "row column"]:
    """Texels that no 3 × 3 square of their own label holds take the label of the nearest that has one.

    Whatever is 3 texels across or more (2 along the picture's border) stays as it is, to the texel.
    """
    from scipy import ndimage

    held = np.zeros(labels.shape, bool)
    for label in np.unique(labels):
        own = np.pad(labels == label, 1, mode="edge")
        held |= ndimage.binary_opening(own, np.ones((3, 3), bool))[1:-1, 1:-1] & (labels == label)
    if held.all() or not held.any():
        return labels
    nearest = ndimage.distance_transform_edt(~held, return_distances=False, return_indices=True)
    assert isinstance(nearest, np.ndarray)
    return labels[tuple(nearest)]


def resized(labels: Int32[np.ndarray, "row column"], rows: int, columns: int) -> Int32[np.ndarray, "rows columns"]:
    """The same map at another size: each texel takes the label it lies in."""
    row, column = (
        (np.arange(size) * 2 + 1) * old // (2 * size) for size, old in zip((rows, columns), labels.shape, strict=True)
    )
    return np.ascontiguousarray(labels[np.ix_(row, column)])


def fading(rows: int, columns: int, sigma: float | None = None) -> Float64[np.ndarray, "row column"]:
    """The probability of the second of two samples, 1 − exp(−x² / 2σ²), ``x`` texels below the top row (fig. 11).

    ``sigma`` is in texels; None is 0.4 of the height, the paper's 80 of 200.
    """
    x = np.arange(rows) / (0.4 * rows if sigma is None else sigma)
    return np.repeat(1 - np.exp(-(x**2) / 2)[:, None], columns, 1)


def discs(
    probability: Float[np.ndarray, "row column"], radii: tuple[float, float], *, wrap: bool = False, seed: int = 0
) -> Int32[np.ndarray, "row column"]:
    """Discs at random texels until all is covered, of the second sample with the ``probability`` of their middle.

    ``radii`` are texels, one a sample: the dominant scales. A disc lies on top of those before it. Shin & Shin 2004,
    section 5; there the parts that overlap are belts, here belts follow the borders as on any map.
    """
    rows, columns = probability.shape
    labels = np.full((rows, columns), -1, np.int32)
    reach = int(np.ceil(max(radii)))
    side = np.arange(-reach, reach + 1)
    offset = np.stack(np.meshgrid(side, side, indexing="ij"), -1).reshape(-1, 2)
    inside = [offset[(offset**2).sum(1) <= max(radius, 1.0) ** 2] for radius in radii]
    drawn = 0
    while (labels < 0).any():
        number = drawn + np.arange(_ROUND)
        middle = np.stack([draws.uniform(seed, _CENTRE, axis, index=number) for axis in (0, 1)], 1)
        middle = (middle * (rows, columns)).astype(np.int64)
        kind = draws.uniform(seed, _KIND, index=number) < probability[middle[:, 0], middle[:, 1]]
        for at, second in zip(middle, kind, strict=True):
            disc = at + inside[int(second)]
            disc = disc % (rows, columns) if wrap else disc[_within(disc, rows, columns)]
            labels[disc[:, 0], disc[:, 1]] = second
        drawn += _ROUND
    return labels


def _within(texel: np.ndarray, rows: int, columns: int) -> Bool[np.ndarray, "n"]:
    row, column = texel.T
    return (row >= 0) & (row < rows) & (column >= 0) & (column < columns)


def _flat(picture: Float[np.ndarray, "row column 3"]) -> Bool[np.ndarray, "row column"]:
    """Texels like those below and beside them; all where none is."""
    flat = np.ones(picture.shape[:2], bool)
    for axis in (0, 1):
        step = np.abs(np.diff(picture, axis=axis)).max(-1) < _FLAT
        flat &= np.concatenate([step, step[-1:] if axis == 0 else step[:, -1:]], axis) if step.size else True
    return flat if flat.any() else np.ones_like(flat)


def _distance(one: Float[np.ndarray, "n 3"], two: Float[np.ndarray, "m 3"]) -> Float64[np.ndarray, "n m"]:
    return np.sqrt(((one[:, None] - two) ** 2).sum(-1))
