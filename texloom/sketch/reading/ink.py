"""Cells between inked lines: gaps closed, double lines made one and loose ends left out, all by distance to the ink."""

import numpy as np
from jaxtyping import Bool, Float32, Int

from texloom.sketch.reading.basins import basins
from texloom.sketch.reading.labels import borders
from texloom.sketch.reading.lines import Lines
from texloom.sketch.reading.mends import Mend, mends

_GAP = 0.45  # half-width of the widest gap that is closed, by the radius of the smaller cell beside it
_SLIVER = 0.22  # radius of a region that is no cell but lies between lines drawn for one, by the typical cell's
_FAR = 0.3  # of the typical radius: ink that far from every border bounds nothing
_CROWD = 12  # neighbours of a region that is no cell but the ground of many
_RIM = 4  # texels from the page's edge where a frame may be drawn
_ALONG = 0.8  # of the edge that a frame covers
_SHORT = 0.3  # of the typical radius: forks nearer than that are one crossing


def cells_of_ink(ink: Bool[np.ndarray, "row column"]) -> tuple[Lines, list[Mend]]:
    """Borders of the cells, and what had to be mended.

    Cells are basins of the distance to the ink: two are parted where the passage between them is narrower than 0.45 of
    the smaller, drawn or not. What is too thin for a cell is divided among the cells beside it, and so is the ink: each
    texel goes to the nearest cell, which leaves the border in the middle of its stroke.
    """
    if not ink.any():
        return borders(np.zeros(ink.shape, np.int64), shortest=0.0), []
    page = max(ink.shape) // 16
    framed = _framed(ink)
    whole = not _edges(ink).any()
    margin = page * np.array([framed[:2] | whole, framed[2:] | whole])  # room for the ground beyond a drawn frame
    lines, notes = _cells(np.pad(ink, margin), around=whole)
    row, column = margin[:, 0].tolist()
    lines = Lines(lines.vertices - margin[:, 0], lines.edges)
    return lines, [Mend(note.what, note.row - row, note.column - column) for note in notes]


def _edges(ink: Bool[np.ndarray, "row column"]) -> Bool[np.ndarray, "texel"]:
    """The ink near the page's edge."""
    return np.concatenate([ink[:_RIM].ravel(), ink[-_RIM:].ravel(), ink[:, :_RIM].ravel(), ink[:, -_RIM:].ravel()])


def _framed(ink: Bool[np.ndarray, "row column"]) -> Bool[np.ndarray, "side"]:
    """Whether a line runs along the top, the bottom, the left, the right of the page."""
    rims = ink[:_RIM].any(axis=0), ink[-_RIM:].any(axis=0), ink[:, :_RIM].any(axis=1), ink[:, -_RIM:].any(axis=1)
    return np.array([rim.mean() > _ALONG for rim in rims])


def _cells(ink: Bool[np.ndarray, "row column"], *, around: bool) -> tuple[Lines, list[Mend]]:
    from scipy.ndimage import distance_transform_edt

    distance = np.asarray(distance_transform_edt(~ink), np.float32)
    region = basins(-distance, _one_cell)
    if around:
        region = _one_ground(region)
    radius = np.zeros(region.max() + 1)
    np.maximum.at(radius, region.ravel(), distance.ravel())
    typical = _typical(radius)
    cell = ~ink & (radius >= _SLIVER * typical)[region]
    if not cell.any():
        return borders(np.zeros_like(region), shortest=0.0), []
    cell &= ~_between(_nearest(region, cell), distance, _SLIVER * typical)
    region = _nearest(region, cell)
    lines = borders(region, shortest=_SHORT * typical)
    return lines, _gaps(lines, distance, _SLIVER * typical) + _loose(ink, region, _FAR * typical)


def _one_ground(region: Int[np.ndarray, "row column"]) -> Int[np.ndarray, "row column"]:
    """All regions at the page's edge made one."""
    edge = np.unique(np.concatenate([region[0], region[-1], region[:, 0], region[:, -1]]))
    return np.where(np.isin(region, edge), edge[0], region)


def _nearest(region: Int[np.ndarray, "row column"], cell: Bool[np.ndarray, "row column"]) -> np.ndarray:
    """The region of the nearest texel of a cell."""
    from scipy.ndimage import distance_transform_edt

    rows, columns = np.asarray(distance_transform_edt(~cell, return_distances=False, return_indices=True))
    return region[rows, columns]


def _between(
    region: Int[np.ndarray, "row column"], distance: np.ndarray, thin: float
) -> Bool[np.ndarray, "row column"]:
    """The narrow parts of the ground that outlines drawn apart lie on: a region at the edge beside most others."""
    from scipy.ndimage import distance_transform_edt

    count = region.max() + 1
    pairs = [np.stack([a[a != b], b[a != b]]) for a, b in ((region[1:], region[:-1]), (region[:, 1:], region[:, :-1]))]
    one, other = np.concatenate(pairs, axis=1)
    beside = np.unique(np.concatenate([one * count + other, other * count + one])) // count
    neighbours = np.bincount(beside, minlength=count)
    at_edge = np.zeros(count, bool)
    for side in (region[0], region[-1], region[:, 0], region[:, -1]):
        at_edge[side] = True
    most = min(_CROWD, max(3, len(np.unique(region)) // 2))
    ground = (at_edge & (neighbours >= most))[region]
    return ground & (np.asarray(distance_transform_edt(distance < thin)) > thin)


def connected(mask: Bool[np.ndarray, "row column"]) -> tuple[Int[np.ndarray, "row column"], int]:
    """The number from 1 of each connected piece, over corners too, and how many there are."""
    from scipy.ndimage import label

    pieces = np.zeros(mask.shape, np.int32)
    count = label(mask, np.ones((3, 3)), output=pieces)
    return pieces, int(count)  # pyright: ignore[reportArgumentType]


def _one_cell(saddle: float, deepest: float, lowest: float, _texels: int, _others: int) -> bool:
    return -saddle > _GAP * -lowest or lowest > -1


def _typical(radius: np.ndarray) -> float:
    """The median radius, large regions counting more: slivers are many."""
    order = np.argsort(radius)
    share = np.cumsum(radius[order])
    return float(radius[order][np.searchsorted(share, share[-1] / 2)])


def _gaps(lines: Lines, distance: Float32[np.ndarray, "row column"], wide: float) -> list[Mend]:
    """Where a border runs far from all ink."""
    chains = lines.chains
    if not len(chains):
        return []
    place = np.clip(np.round(lines.vertices[chains.vertex]).astype(np.int64), 0, np.array(distance.shape) - 1)
    far = distance[place[:, 0], place[:, 1]]
    widest = np.maximum.reduceat(far, chains.start[:-1])
    of = np.repeat(np.arange(len(chains)), np.diff(chains.start))
    order = np.lexsort((-far, of))
    at = order[chains.start[:-1]]
    gap = widest > wide
    return mends("closed a gap", lines.vertices[chains.vertex[at[gap]]], 2 * widest[gap])


def _loose(ink: Bool[np.ndarray, "row column"], region: Int[np.ndarray, "row column"], far: float) -> list[Mend]:
    """Ink that bounds no cell."""
    from scipy.ndimage import center_of_mass, distance_transform_edt

    inner = np.ones(ink.shape, bool)
    for all_but_first, all_but_last, border in (
        (inner[1:], inner[:-1], region[1:] != region[:-1]),
        (inner[:, 1:], inner[:, :-1], region[:, 1:] != region[:, :-1]),
    ):
        all_but_first &= ~border
        all_but_last &= ~border
    away = np.asarray(distance_transform_edt(inner)) if not inner.all() else np.full(ink.shape, np.inf)
    left, count = connected(ink & (away > far))
    if not count:
        return []
    index = np.arange(1, count + 1)
    across = 2 * np.asarray(distance_transform_edt(ink))
    texels = np.bincount(left.ravel())[1:]
    width = np.bincount(left.ravel(), across.ravel())[1:] / texels
    long = texels / width + far
    kept = texels / width > far / 2
    return mends("dropped an open stroke", np.array(center_of_mass(left > 0, left, index))[kept], long[kept])
