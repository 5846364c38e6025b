"""Pictures that repeat: the lattice of shifts under which one looks the same, and the tiles on it."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int

from texloom.sketch.reading.lines import Lines, tidy

_REPEATS = 3  # down and across: fewer are chance, or a picture laid beside itself
_SHORTEST = 4.0  # texels of a shift: shorter is grain
_BESIDE = 5  # texels a side of the square in which a shift is the best
_NEARLY = 0.6  # of the best shift's likeness: as like as that may be a finer lattice's shift
_MOST_SHIFTS = 16  # shifts that are tried in pairs, the shortest
_SQUARE = 0.5  # sine of the angle between two shifts, at least
_AROUND = 3  # repeats each way over which order is taken: beyond, a rough lattice has drifted off
_FINER = 0.75  # of the greatest order: of lattices as good as that the one with the smallest tiles
_WIDE = 0.25  # of a tile: how far about a border the picture is to be calm, too


@dataclass(frozen=True, eq=False)
class Lattice:
    """Two shifts, a row each in [row, column] texels, and how well a picture keeps to them.

    ``order`` is the picture's mean correlation with itself over the lattice, less the highest of the three means half a
    tile off: the share of its variance that repeats foretell. A picture of even stripes is like itself half a tile off,
    and one of cells in disorder is not like itself far off: both come near 0.
    """

    shifts: Float64[np.ndarray, "2 2"]
    order: float


def lattice_of(
    picture: Float32[np.ndarray, "row column"], usable: Bool[np.ndarray, "row column"] | None = None
) -> Lattice | None:
    """The finest of the lattices that keep most order; None where no two shifts are like themselves.

    ``picture`` has its mean at 0, over a few tiles too, and is 0 where not usable.
    """
    likeness = _likeness(picture, np.ones(picture.shape, bool) if usable is None else usable)
    shifts = _shifts(likeness, np.array(picture.shape) / _REPEATS)
    pairs = [
        pair
        for one, other in combinations(range(len(shifts)), 2)
        if abs(np.linalg.det(pair := shifts[[one, other]])) >= _SQUARE * np.hypot(*pair.T).prod()
    ]
    if not pairs:
        return None
    orders = np.array([_order(likeness, pair) for pair in pairs])
    good = np.flatnonzero(orders >= _FINER * orders.max())
    finest = min(good.tolist(), key=lambda at: abs(float(np.linalg.det(pairs[at]))), default=0)
    return Lattice(_reduced(_sharpened(likeness, pairs[finest])), float(orders[finest]))


def tiles(picture: Float32[np.ndarray, "row column"], lattice: Lattice) -> Lines:
    """The borders of the tiles, laid where the picture varies least along them and near them: not through a motif."""
    shifts = lattice.shifts
    place = np.indices(picture.shape).reshape(2, -1).T @ np.linalg.inv(shifts)
    heights = abs(np.linalg.det(shifts)) / np.hypot(*shifts.T)[::-1]
    first = [_calmest(picture.ravel(), at, height) for at, height in zip(place.T, heights.tolist(), strict=True)]
    low, high = (
        np.floor(place.min(axis=0) - first).astype(np.int64),
        np.ceil(place.max(axis=0) - first).astype(np.int64),
    )
    down, across = (high - low + 1).tolist()
    number = np.arange(down * across).reshape(down, across)
    corner = (np.indices(number.shape).reshape(2, -1).T + low + first) @ shifts
    edges = [(number[1:], number[:-1]), (number[:, 1:], number[:, :-1])]
    return _clipped(corner, np.concatenate([np.stack(pair, axis=2).reshape(-1, 2) for pair in edges]), picture.shape)


def _clipped(vertices: Float64[np.ndarray, "vertex 2"], edges: np.ndarray, shape: tuple[int, ...]) -> Lines:
    """The parts of straight edges within a picture's texels."""
    tail, head = vertices[edges].transpose(1, 0, 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        sides = np.stack([-0.5 - tail, np.array(shape) - 0.5 - tail]) / (head - tail)
    sides = np.where(np.isnan(sides), [[[-np.inf]], [[np.inf]]], sides)
    enters, leaves = np.clip(sides.min(axis=0).max(axis=1), 0, 1), np.clip(sides.max(axis=0).min(axis=1), 0, 1)
    cut = np.concatenate([tail + enters[:, None] * (head - tail), tail + leaves[:, None] * (head - tail)])
    new = len(vertices) + np.arange(2 * len(edges)).reshape(2, -1)
    ends = np.stack([np.where(enters > 0, new[0], edges[:, 0]), np.where(leaves < 1, new[1], edges[:, 1])], axis=1)
    return tidy(np.concatenate([vertices, cut]), ends[enters < leaves])


def _likeness(
    picture: Float32[np.ndarray, "row column"], usable: Bool[np.ndarray, "row column"]
) -> Float64[np.ndarray, "down across"]:
    """Correlation of the picture with itself by shift, up to half of it each way; no shift is in the middle."""
    from scipy.fft import irfft2, rfft2

    rows, columns = picture.shape
    shape = 2 * rows, 2 * columns
    wave, power, where = (np.asarray(rfft2(image, shape)) for image in (picture, picture**2, usable.astype(np.float32)))
    product, here, there = (
        np.asarray(irfft2(pair, shape), np.float64)
        for pair in (wave * wave.conj(), power * where.conj(), where * power.conj())
    )
    likeness = product / np.sqrt(np.maximum(here, 1e-3) * np.maximum(there, 1e-3))
    down, across = rows // 2, columns // 2
    return np.roll(likeness, (down, across), axis=(0, 1))[: 2 * down + 1, : 2 * across + 1]


def _shifts(likeness: Float64[np.ndarray, "down across"], longest: np.ndarray) -> Float64[np.ndarray, "shift 2"]:
    """The shortest shifts nearly as like as any, one of each two opposite ones."""
    from scipy.ndimage import maximum_filter

    middle = np.array(likeness.shape) // 2
    shift = np.argwhere((maximum_filter(likeness, _BESIDE) == likeness) & (likeness > 0)) - middle
    ahead = (shift[:, 0] > 0) | ((shift[:, 0] == 0) & (shift[:, 1] > 0))
    shift = shift[ahead & (np.abs(shift) <= longest).all(axis=1) & (np.hypot(*shift.T) >= _SHORTEST)]
    like = likeness[tuple((shift + middle).T)]
    shift = shift[like >= _NEARLY * like.max(initial=0)]
    return shift[np.argsort(np.hypot(*shift.T), kind="stable")[:_MOST_SHIFTS]].astype(np.float64)


def _order(likeness: Float64[np.ndarray, "down across"], shifts: Float64[np.ndarray, "2 2"]) -> float:
    """Mean likeness on the lattice less the highest of the means half a tile off it."""
    halves = ((0, 0), (0, 0.5), (0.5, 0), (0.5, 0.5))
    on, *off = (_mean(likeness, _multiples(_AROUND) + half, shifts) for half in halves)
    return on - max(off)


def _mean(likeness: np.ndarray, multiples: np.ndarray, shifts: np.ndarray) -> float:
    """Over what of the lattice is within reach, but for no shift."""
    from scipy.ndimage import map_coordinates

    middle = np.array(likeness.shape) // 2
    at = multiples @ shifts
    at = at[(np.abs(at) <= middle).all(axis=1) & at.any(axis=1)]
    return float(np.asarray(map_coordinates(likeness, (at + middle).T, order=1)).mean()) if len(at) else 0.0


def _multiples(most: int) -> Int[np.ndarray, "point 2"]:
    return np.indices((2 * most + 1, 2 * most + 1)).reshape(2, -1).T - most


def _sharpened(
    likeness: Float64[np.ndarray, "down across"], shifts: Float64[np.ndarray, "2 2"]
) -> Float64[np.ndarray, "2 2"]:
    """The shifts to a fraction of a texel, from the likeliest places near farther and farther multiples."""
    middle = np.array(likeness.shape) // 2
    step = _multiples(1)
    most = 1
    while most * np.hypot(*shifts.T).min() < 2 * middle.max():
        multiple = _multiples(most)
        at = np.round(multiple @ shifts).astype(np.int64)
        within = (np.abs(at) < middle).all(axis=1)
        multiple, beside = multiple[within], at[within][:, None] + step
        like = likeness[beside[..., 0] + middle[0], beside[..., 1] + middle[1]]
        found = beside[np.arange(len(beside)), like.argmax(axis=1)]
        shifts = np.linalg.lstsq(multiple, found, rcond=None)[0]
        most *= 2
    return shifts


def _reduced(shifts: Float64[np.ndarray, "2 2"]) -> Float64[np.ndarray, "2 2"]:
    """The two shortest shifts of the same lattice (Lagrange)."""
    while True:
        shorter, longer = shifts[np.argsort(np.hypot(*shifts.T), kind="stable")]
        times = np.round(shorter @ longer / (shorter @ shorter))
        shifts = np.stack([shorter, longer - times * shorter])
        if times == 0:
            return shifts


def _calmest(picture: Float32[np.ndarray, "texel"], place: Float64[np.ndarray, "texel"], height: float) -> float:
    """The place modulo 1 at which the picture varies least, there and about it alike; 1 is ``height`` texels."""
    from scipy.ndimage import uniform_filter1d

    texels = max(round(height), 1)
    at = np.minimum((place % 1 * texels).astype(np.int64), texels - 1)
    count = np.maximum(np.bincount(at, minlength=texels), 1)
    mean = np.bincount(at, picture, texels) / count
    variance = np.bincount(at, picture**2, texels) / count - mean**2
    about = np.asarray(uniform_filter1d(variance, max(round(_WIDE * texels), 1), mode="wrap"))
    return (float((variance + about).argmin()) + 0.5) / texels
