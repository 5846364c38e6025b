"""Appearance vectors: each texel described by its surroundings (Lefebvre & Hoppe 2006, section 3)."""

import numpy as np
from jaxtyping import Bool, Float32

from texloom.arrays import Image
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.pca import Projection, fit

_ROWS = 16  # of texels whose neighbourhoods are gathered at once
_MOST_FITTED = 4096  # neighbourhoods from which the axes are found


def appearance_vectors(
    image: Image,
    *,
    dimensions: int = 4,
    feature_weight: float = 0.5,
    usable: Bool[np.ndarray, "row column"] | None = None,
) -> Float32[np.ndarray, "row column component"]:
    """``dimensions`` principal components of the 5×5 neighbourhoods, then the feature distance.

    Neighbourhoods are Gaussian-weighted (weights sum to 1) and mirrored at the border, so a squared difference is that
    of the image averaged around the texel. The feature distance varies ``feature_weight`` times as much as the first
    component; at 0 it is left out. Masked texels take the values of the nearest usable ones.
    """
    image = fill_masked(image, usable)
    components = _project_neighborhoods(image, width=5, sigma=1.0, dimensions=dimensions)
    if feature_weight == 0.0:
        return components
    inside = slice(None) if usable is None else usable
    distance = feature_distance(feature_mask(components[..., :1]))
    spread = float(distance[inside].std())
    scale = feature_weight * float(components[inside][..., 0].std()) / spread if spread > 0.0 else 0.0
    return np.concatenate([components, (distance * np.float32(scale))[..., None]], axis=2)


def neighborhood_vectors(image: Image, *, width: int, dimensions: int) -> Float32[np.ndarray, "row column component"]:
    """``dimensions`` principal components of the ``width × width`` neighbourhoods, weighted by a Gaussian that has
    fallen to 1/8 at their border; mirrored at the image's border."""
    return _project_neighborhoods(image, width=width, sigma=0.25 * width, dimensions=dimensions)


def feature_mask(image: Image) -> Bool[np.ndarray, "row column"]:
    """The darker or brighter half of the first channel, split where the two classes differ most (Otsu 1979)."""
    values = image[..., 0]
    count, edge = np.histogram(values, bins=128)
    centre = 0.5 * (edge[:-1] + edge[1:])
    below = np.cumsum(count)[:-1]
    above = count.sum() - below
    sum_below = np.cumsum(count * centre)[:-1]
    sum_above = (count * centre).sum() - sum_below
    contrast = sum_below / np.maximum(below, 1) - sum_above / np.maximum(above, 1)
    return values > edge[1 + np.argmax(below * above * contrast**2)]


def feature_distance(mask: Bool[np.ndarray, "row column"]) -> Float32[np.ndarray, "row column"]:
    """Texels to the mask's edge: positive inside, negative outside, 0 everywhere if it has no edge."""
    if mask.all() or not mask.any():
        return np.zeros(mask.shape, np.float32)
    from scipy.ndimage import distance_transform_edt

    inside, outside = np.asarray(distance_transform_edt(mask)), np.asarray(distance_transform_edt(~mask))
    return np.where(mask, inside - 0.5, 0.5 - outside).astype(np.float32)


def fill_masked(image: Image, usable: Bool[np.ndarray, "row column"] | None) -> Image:
    """The image with masked texels replaced by the nearest usable ones."""
    if usable is None or usable.all():
        return image
    from scipy.ndimage import distance_transform_edt

    row, column = np.asarray(distance_transform_edt(~usable, return_distances=False, return_indices=True))
    return image[row, column]


def _project_neighborhoods(
    image: Image, *, width: int, sigma: float, dimensions: int
) -> Float32[np.ndarray, "row column component"]:
    """Principal components of the weighted neighbourhood of every texel."""
    rows, columns, channels = image.shape
    windows = _windows(image, width)
    root = np.repeat(_root_weights(width, sigma), channels)
    projection = _fit_windows(windows, root, dimensions)
    weighted_axes = projection.axes * root[:, None]
    offset = projection.mean @ projection.axes
    components = np.empty((rows, columns, projection.axes.shape[1]), np.float32)

    def project(first: int, last: int) -> None:
        flat = windows[first:last].reshape((last - first) * columns, -1)
        components[first:last] = (flat @ weighted_axes - offset).reshape(last - first, columns, -1)

    over_blocks(project, rows, _ROWS)
    return components


def _fit_windows(windows: np.ndarray, root: Float32[np.ndarray, "dim"], dimensions: int) -> Projection:
    """Principal axes of weighted neighbourhoods, from texels picked evenly over the image."""
    rows, columns = windows.shape[:2]
    picked = np.arange(min(_MOST_FITTED, rows * columns)) * (rows * columns) // min(_MOST_FITTED, rows * columns)
    return fit(windows[picked // columns, picked % columns].reshape(len(picked), -1) * root, dimensions)


def _windows(image: Image, width: int) -> Float32[np.ndarray, "row column tall wide channel"]:
    """A view of the neighbourhood of every texel, the image mirrored at its border."""
    reach = width // 2
    padded = np.pad(image, ((reach, reach), (reach, reach), (0, 0)), mode="symmetric")
    view = np.lib.stride_tricks.sliding_window_view(padded, (width, width), axis=(0, 1))
    return view.transpose(0, 1, 3, 4, 2)


def _root_weights(width: int, sigma: float) -> Float32[np.ndarray, "sample"]:
    """Square roots of Gaussian weights that sum to 1, sample by sample."""
    offset = np.arange(width) - width // 2
    row = np.exp(-0.5 * (offset / sigma) ** 2)
    weight = np.outer(row, row)
    return np.sqrt(weight / weight.sum()).ravel().astype(np.float32)
