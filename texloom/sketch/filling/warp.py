"""Where in the sample each texel of a texture begins: cell by cell, from centre to rim."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float32, Float64

from texloom import draws
from texloom.arrays import Image
from texloom.kernels import sketch_cells as kernels
from texloom.kernels.launch import launch
from texloom.sketch.filling.kinds import Assignment
from texloom.sketch.filling.maps import FeatureMaps, Window
from texloom.sketch.filling.shapes import CellShapes
from texloom.sources import SourceMap

_RADIAL = 0.0, 1.0  # rims count as the square of the way to them
_SCALE = -1.5, 2.5  # the same from three fifths of the way on

_STRETCHED = 1.5  # times as much one way as the other,
_ENLARGED = 5 / 3  # or in all: further than that what is shown looks drawn out

_DETAIL = 2 / 3  # of the maps' blur
_LEAST_DETAIL = 0.7  # texels
_DETAILED = 0.5


@dataclass(frozen=True, eq=False)
class Start:
    """The place in the sample that each texel of a texture shows first: a source a texel (see ``SourceMap``)."""

    position: Float32[np.ndarray, "row column 2"]
    turn: Float32[np.ndarray, "row column"]
    scale: Float32[np.ndarray, "row column"]

    @property
    def sources(self) -> SourceMap:
        """The same for the texels in row order."""
        position = self.position.reshape(-1, 1, 2)
        turn, scale = self.turn.reshape(-1, 1), self.scale.reshape(-1, 1)
        return SourceMap(position, np.ones_like(turn), turn, scale)

    def drawn_out(
        self, window: Window, *, wrap: bool
    ) -> tuple[Bool[np.ndarray, "row column"], Float32[np.ndarray, "bent"]]:
        """Where in a window the sample is shown stretched or enlarged too far, and how it is turned at these places.

        With the derivative M of positions, Q and R half the lengths of (M00 + M11, M10 - M01) and (M00 - M11,
        M10 + M01): it shows the sample (Q + R) / (Q - R) times as stretched one way as the other, 1 / Q times as large.
        """
        (a, c), (b, d) = (np.moveaxis(self._slope(window, axis, wrap), 2, 0) for axis in (0, 1))
        even, uneven = np.hypot(a + d, c - b), np.hypot(a - d, c + b)
        bent = (even + uneven > _STRETCHED * np.abs(even - uneven)) | (even < 2 / _ENLARGED)
        return bent, np.arctan2((b - c)[bent], (a + d)[bent])

    def _slope(self, window: Window, axis: int, wrap: bool) -> Float32[np.ndarray, "row column 2"]:
        """How positions change from texel to texel along an axis."""
        side, texels = window[axis], self.turn.shape[axis]
        before, after = (np.arange(side.start + step, side.stop + step) for step in (-1, 1))
        if not wrap:
            before, after = np.maximum(before, 0), np.minimum(after, texels - 1)
        strip = self.position[:, window[1]] if axis == 0 else self.position[window[0]]
        change = strip.take(after % texels, axis=axis) - strip.take(before % texels, axis=axis)
        apart = np.maximum(after - before, 1).astype(np.float32)
        return change / (apart[:, None, None] if axis == 0 else apart[:, None])


@dataclass(frozen=True, kw_only=True)
class Initialization:
    """How the cells of a sample are laid into those of a texture (Wang et al. 2014, §3.2, figs 9-11).

    ``inside``: "radial" stretches cells to each other's shape along rays from the centre (fig. 10), "scale" only turns
    and scales their middle (fig. 11).

    ``lines``: "carried" is ours. Rims go to rims and keep their depth over a zone as wide as the blur of the maps
    reaches, so lines keep their width and are met from both sides. Radially, the middle is stretched to the other's
    length and width, so corners find corners; with "scale" it is the circle of three fifths. "nearest" is the paper's:
    cells radially in proportion, or scaled so that the circle around the one comes to lie in the circle within the
    other; texels close to an edge show a texel of the sample equally close (eq. 13).
    """

    inside: Literal["radial", "scale"] = "radial"
    lines: Literal["carried", "nearest"] = "carried"

    def run(
        self,
        sample: tuple[FeatureMaps, CellShapes],
        texture: tuple[FeatureMaps, CellShapes],
        assignment: Assignment,
        *,
        seed: int,
    ) -> Start:
        """The start of every texel."""
        rows, columns = texture[0].shape
        start = Start(
            np.empty((rows, columns, 2), np.float32),
            np.zeros((rows, columns), np.float32),
            np.ones((rows, columns), np.float32),
        )
        self.again(start, sample, texture, assignment, window=(slice(0, rows), slice(0, columns)), seed=seed)
        return start

    def again(
        self,
        start: Start,
        sample: tuple[FeatureMaps, CellShapes],
        texture: tuple[FeatureMaps, CellShapes],
        assignment: Assignment,
        *,
        window: Window,
        seed: int,
    ) -> None:
        """The start of the texels of a window, in place."""
        (sample_maps, its), (maps, own) = sample, texture
        _mirror(start, sample_maps.shape, window)
        if len(its) and len(own):
            fit, bend, zone = self._fits(sample_maps, its, own, assignment)
            first, columns = (window[0].start, window[1].start), window[1].stop - window[1].start
            size = tuple(float(side) for side in maps.shape) if maps.wrap else (0.0, 0.0)
            inputs = [first, columns, size, zone, maps.cell, maps.away, own.centre, own.rim, own.depth]
            inputs += [assignment.source, fit, bend, assignment.turn]
            inputs += [int(sample_maps.wrap), sample_maps.away, its.centre, its.rim]
            count = (window[0].stop - window[0].start) * columns
            launch(kernels.carry_cells, count, inputs=inputs, outputs=[start.position, start.turn, start.scale])
        if self.lines == "nearest":
            _nearest(start, sample_maps, maps, window, seed)
        _within(start, sample_maps, window)

    def _fits(
        self, maps: FeatureMaps, its: CellShapes, own: CellShapes, assignment: Assignment
    ) -> tuple[Float32[np.ndarray, "cell 2 2"], tuple[float, float], float]:
        """What takes a cell to the sample's, how that gives way to rims towards the rim, and how wide zones are."""
        source, turned = assignment.source, _rotations(assignment.turn)
        published, radial = self.lines == "nearest", self.inside == "radial"
        if radial:
            fit = turned if published else _stretch(own.spread, its.spread[source], turned) @ turned
        else:
            by = its.inner[source] / own.outer if published else np.sqrt(its.area[source] / own.area)
            fit = turned * by[:, None, None]
        bend = (float(radial), 0.0) if published else _RADIAL if radial else _SCALE
        return np.ascontiguousarray(fit, np.float32), bend, 0.0 if published else maps.reach + 0.5


def best_inside(image: Image, maps: FeatureMaps) -> Literal["radial", "scale"]:
    """Which ``inside`` suits a sample, of which ``image`` is what matching compares (``match_image``).

    "scale" where there is half as much to see deep inside its cells as at their edges: mean squared gradient, blurred
    by 0.04 of a typical cell, further than two zones from edges and within one. Tiles, crackers and studs give 0.7 to
    1.7, stones, bricks and beans less than 0.4.
    """
    from scipy.ndimage import gaussian_gradient_magnitude

    blur = max(_DETAIL * maps.blur, _LEAST_DETAIL)
    channels = [gaussian_gradient_magnitude(channel, blur, mode="nearest") for channel in np.moveaxis(image, 2, 0)]
    detail = (np.stack(channels) ** 2).sum(axis=0)
    zone = maps.reach + 0.5
    deep, edge = (maps.away > 2 * zone) & (maps.cell >= 0), maps.away <= zone
    if not deep.any() or not edge.any():
        return "radial"
    return "scale" if detail[deep].mean() > _DETAILED * detail[edge].mean() else "radial"


def _rotations(turn: Float32[np.ndarray, "cell"]) -> Float64[np.ndarray, "cell 2 2"]:
    """R(turn) on [row, column]."""
    cosine, sine = np.cos(turn, dtype=np.float64), np.sin(turn, dtype=np.float64)
    return np.stack([np.stack([cosine, sine], axis=1), np.stack([-sine, cosine], axis=1)], axis=1)


def _stretch(
    own: Float64[np.ndarray, "cell 2 2"], its: Float64[np.ndarray, "cell 2 2"], turned: Float64[np.ndarray, "cell 2 2"]
) -> Float64[np.ndarray, "cell 2 2"]:
    """The symmetric map that takes cells turned into the sample to the covariance of its own: the one of least effort.

    With A = R own Rᵀ and B its, A^-½ (A^½ B A^½)^½ A^-½ (Gelbrich 1990).
    """
    half = _root(turned @ own @ turned.transpose(0, 2, 1))
    back = np.linalg.inv(half)
    return back @ _root(half @ its @ half) @ back


def _root(matrix: Float64[np.ndarray, "cell 2 2"]) -> Float64[np.ndarray, "cell 2 2"]:
    """Square roots of symmetric positive matrices."""
    root = np.sqrt(np.maximum(np.linalg.det(matrix), 1e-12))[:, None, None]
    trace = np.trace(matrix, axis1=1, axis2=2)[:, None, None]
    return (matrix + root * np.eye(2)) / np.sqrt(trace + 2 * root)


def _mirror(start: Start, shape: tuple[int, int], window: Window) -> None:
    """The sample mirrored on and on: what texels of no cell show."""
    for axis, (span, side) in enumerate(zip(window, shape, strict=True)):
        index = np.arange(span.start, span.stop) % (2 * side)
        place = np.minimum(index, 2 * side - 1 - index).astype(np.float32)
        start.position[*window, axis] = place[:, None] if axis == 0 else place
    start.turn[window], start.scale[window] = 0, 1


def _nearest(start: Start, sample: FeatureMaps, texture: FeatureMaps, window: Window, seed: int) -> None:
    """Texels close to edges: the sample's texel of the nearest closeness (eq. 13), of equal ones any."""
    near = np.flatnonzero(sample.closeness > 0)
    order = near[np.argsort(sample.closeness.ravel()[near], kind="stable")]
    known = sample.closeness.ravel()[order]
    row, column = np.nonzero(texture.closeness[window] > 0)
    if not len(known) or not len(row):
        return
    row, column = row + window[0].start, column + window[1].start
    asked = texture.closeness[row, column]
    above = np.clip(np.searchsorted(known, asked), 1, len(known) - 1)
    best = known[above - (asked - known[above - 1] <= known[above] - asked)] if len(known) > 1 else known[above * 0]
    first, past = np.searchsorted(known, best), np.searchsorted(known, best, side="right")
    luck = draws.uniform(seed, index=row * texture.shape[1] + column)
    chosen = order[np.minimum(first + (luck * (past - first)).astype(np.int64), past - 1)]
    start.position[row, column] = np.stack(np.divmod(chosen, sample.shape[1]), axis=1)
    start.turn[row, column], start.scale[row, column] = 0, 1


def _within(start: Start, sample: FeatureMaps, window: Window) -> None:
    """Positions in the sample: beyond its border those across it, or the border itself."""
    position = start.position[window]
    if sample.wrap:
        position[...] = (position + np.float32(0.5)) % np.array(sample.shape, np.float32) - np.float32(0.5)
    else:
        np.clip(position, 0, np.array(sample.shape, np.float32) - 1, out=position)
