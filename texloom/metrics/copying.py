"""How large are the pieces that a result copies from the sample unchanged."""

import numpy as np
from jaxtyping import Bool, Int, UInt8, UInt64

from texloom.arrays import Image
from texloom.metrics.patches import SIDE, Picture
from texloom.sources import SourceMap

_TOLERANCE = 1  # of 255: what rounding through linear light may change
_ROUNDS = 16  # pieces of flat or periodic parts are told apart this often, then left as they are
_STEPS = ((0, 1), (0, -1), (1, 0), (-1, 0))
_NOWHERE = -(2**30)

Offsets = Int[np.ndarray, "row column 2"]
"""From a patch's place in the result to its place in the sample, ``_NOWHERE`` where it is not a copy."""


def copy_side(
    sample: Image,
    result: Picture,
    seeds: tuple[Int[np.ndarray, "seed 2"], Int[np.ndarray, "seed 2"]] | None = None,
) -> float:
    """Side in texels of the typical exactly copied piece: √(area-weighted mean area of regions) + 6, or 0 without any.

    A patch is a copy if some 7×7 patch of the sample equals it to 1/255 in every value. Connected patches at the same
    offset are one region; its area counts patches. Every patch equal to the bit is found, by hashing; from those, and
    from ``seeds`` (places in the result, and of their nearest patches in the sample), regions grow as far as the
    tolerance allows.
    """
    ours, theirs = _bytes(result), _bytes(sample)
    offsets = _equal_patches(ours, theirs)
    if seeds is not None:
        _plant(offsets, ours, theirs, *seeds)
    _grow(offsets, ours, theirs)
    return _typical_side(offsets, margin=SIDE - 1)


def copy_side_of_sources(sources: SourceMap, shape: tuple[int, int]) -> float:
    """The same from the sources of an image of ``shape``: regions of texels that continue one place of the sample.

    Only texels with a single upright source count; blends are not copies.
    """
    place = np.moveaxis(np.indices(shape), 0, -1)
    offsets = np.rint(sources.position[:, 0]).astype(np.int64).reshape(*shape, 2) - place
    alone = sources.weight[:, 0] > 254.5 / 255.0
    if sources.turn is not None:
        alone &= np.abs(sources.turn[:, 0]) < 1e-6
    if sources.scale is not None:
        alone &= np.abs(sources.scale[:, 0] - 1.0) < 1e-6
    offsets[~alone.reshape(shape)] = _NOWHERE
    return _typical_side(offsets, margin=0)


def _bytes(image: Image) -> UInt8[np.ndarray, "row column channel"]:
    return np.rint(np.clip(image, 0.0, 1.0) * 255.0).astype(np.uint8)


def _hashes(image: UInt8[np.ndarray, "row column channel"]) -> UInt64[np.ndarray, "row2 column2"]:
    """One 64-bit polynomial hash of every whole patch; equal patches, and practically only those, have equal hashes."""
    row, column, channel = (np.uint64(odd) for odd in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9))
    value = np.zeros(image.shape[:2], np.uint64)
    for layer in np.moveaxis(image, -1, 0):
        value = value * channel + layer + np.uint64(1)
    value = value * column  # spreads the low bits before the sums below
    value ^= value >> np.uint64(29)
    for axis, factor in ((0, row), (1, column)):
        count = value.shape[axis] - SIDE + 1
        total = np.zeros_like(np.take(value, range(count), axis))
        for step in range(SIDE):
            total = total * factor + np.take(value, range(step, step + count), axis)
        value = total ^ (total >> np.uint64(31))
    return value


def _equal_patches(ours: np.ndarray, theirs: np.ndarray) -> Offsets:
    """Offsets of patches equal to the bit. Where several fit, the neighbours decide, and failing that the first."""
    wanted, known = _hashes(ours), _hashes(theirs)
    order = np.argsort(known.ravel(), kind="stable")
    ordered = known.ravel()[order]
    first = np.searchsorted(ordered, wanted.ravel())
    count = np.searchsorted(ordered, wanted.ravel(), side="right") - first
    index = order[np.minimum(first, len(order) - 1)]
    place = np.indices(wanted.shape)
    ambiguous = (count > 1).reshape(wanted.shape)
    match = np.stack(np.unravel_index(index, known.shape)).reshape(place.shape)
    offsets = np.moveaxis(match - place, 0, -1)
    found = np.where((count == 1).reshape(wanted.shape)[..., None], offsets, _NOWHERE)
    _grow(found, ours, theirs, within=ambiguous)
    # What touches nothing decided is decided at one patch a piece, and grown from there.
    for _ in range(_ROUNDS):
        left = ambiguous & (found[..., 0] == _NOWHERE)
        if not left.any():
            break
        pieces = _regions(left, left[:, 1:] & left[:, :-1], left[1:] & left[:-1])
        row, column = np.argwhere(left)[np.unique(pieces, return_index=True)[1]].T
        found[row, column] = offsets[row, column]
        _grow(found, ours, theirs, within=ambiguous)
    left = ambiguous & (found[..., 0] == _NOWHERE)
    found[left] = offsets[left]
    return found


def _plant(offsets: Offsets, ours: np.ndarray, theirs: np.ndarray, places: np.ndarray, matches: np.ndarray) -> None:
    """Add seeds that are copies and not yet found."""
    new = offsets[places[:, 0], places[:, 1], 0] == _NOWHERE
    places, matches = places[new], matches[new]
    same = _same_patch(ours, theirs, places, matches)
    offsets[places[same, 0], places[same, 1]] = matches[same] - places[same]


def _grow(
    offsets: Offsets, ours: np.ndarray, theirs: np.ndarray, within: Bool[np.ndarray, "row column"] | None = None
) -> None:
    """Carry offsets to neighbouring patches as long as these are copies too; the first to arrive stays."""
    last = np.array(theirs.shape[:2]) - SIDE
    front: np.ndarray = np.argwhere(offsets[..., 0] != _NOWHERE)
    while len(front):
        reached = []
        for step in _STEPS:
            offset = offsets[front[:, 0], front[:, 1]]
            place: np.ndarray = front + step
            match: np.ndarray = place + offset
            inside = ((place >= 0) & (place < offsets.shape[:2]) & (match >= 0) & (match <= last)).all(1)
            place, match, offset = place[inside], match[inside], offset[inside]
            free = offsets[place[:, 0], place[:, 1], 0] == _NOWHERE
            if within is not None:
                free &= within[place[:, 0], place[:, 1]]
            place, match, offset = place[free], match[free], offset[free]
            same = _same_patch(ours, theirs, place, match)
            offsets[place[same, 0], place[same, 1]] = offset[same]
            reached.append(place[same])
        front = np.concatenate(reached)


def _same_patch(ours: np.ndarray, theirs: np.ndarray, places: np.ndarray, matches: np.ndarray) -> np.ndarray:
    """Are the patches at ``places`` equal to those at ``matches``, to the tolerance."""
    # The corners and the middle rule most pairs out before all texels are compared.
    texels = [(0, 0), (SIDE - 1, SIDE - 1), (SIDE // 2, SIDE // 2)]
    texels += [(row, column) for row in range(SIDE) for column in range(SIDE)]
    left = np.arange(len(places))
    for row, column in texels:
        a = ours[places[left, 0] + row, places[left, 1] + column]
        b = theirs[matches[left, 0] + row, matches[left, 1] + column]
        keep = (np.maximum(a, b) - np.minimum(a, b) <= _TOLERANCE).all(1)
        if not keep.all():
            left = left[keep]
        if not len(left):
            break
    same = np.zeros(len(places), bool)
    same[left] = True
    return same


def _typical_side(offsets: Offsets, margin: int) -> float:
    """√(area-weighted mean area) of connected regions of one offset, plus ``margin``; 0 where nothing is copied."""
    areas = region_areas(offsets).astype(np.float64)
    return float(np.sqrt(np.square(areas).sum() / areas.sum())) + margin if len(areas) else 0.0


def region_areas(offsets: Offsets) -> Int[np.ndarray, "region"]:
    """Areas of the regions of equal offsets, connected through edges."""
    copied = offsets[..., 0] != _NOWHERE
    across = copied[:, 1:] & (offsets[:, 1:] == offsets[:, :-1]).all(-1)
    down = copied[1:] & (offsets[1:] == offsets[:-1]).all(-1)
    return np.bincount(_regions(copied, across, down))


def _regions(
    inside: Bool[np.ndarray, "row column"],
    across: Bool[np.ndarray, "row column2"],
    down: Bool[np.ndarray, "row2 column"],
) -> Int[np.ndarray, "patch"]:
    """Region numbers, from 0 without gaps, of the patches inside, given which join their left and upper neighbours."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    place = np.arange(inside.size).reshape(inside.shape)
    first = np.concatenate([place[:, :-1][across], place[:-1][down]])
    second = np.concatenate([place[:, 1:][across], place[1:][down]])
    graph = coo_array((np.ones(len(first), bool), (first, second)), shape=(inside.size, inside.size))
    _, region = connected_components(graph, directed=False)
    return np.unique(region[inside.ravel()], return_inverse=True)[1]
