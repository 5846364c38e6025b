"""An image as a place to grow texture: a plane or a torus of texels, one site each, straight or along a field."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Complex64, Float, Float32, Float64, Int32

from texloom import draws
from texloom.domain.cover import group_by_site
from texloom.domain.domain import Lattice
from texloom.domain.neighbourhoods import Neighbourhoods, square
from texloom.domain.network import lay_patches
from texloom.domain.patches import Patches
from texloom.domain.scatter import scatter
from texloom.errors import FieldError, ParameterError
from texloom.field.trace import Flow, planar_flow
from texloom.sources import SourceMap

_PHASE = 0x6C61  # purpose of the draw that shifts a torus's lattice


@dataclass(frozen=True, eq=False)
class Grid:
    """``rows × columns`` sites, one texel apart; site ``row * columns + column``. ``wrap`` joins opposite borders.

    Without a field all frames are the image's own, and a patch of width w around a centre c covers
    ``c - w // 2 ... c - w // 2 + w - 1``. With one, ``field`` holds at every site the direction [row, column] of its
    +column axis (any length but 0), ``magnitude`` how much the texture is enlarged there (None: 1), and
    patches are traced.
    """

    rows: int
    columns: int
    wrap: bool = False
    field: Float[np.ndarray, "row column 2"] | None = None
    magnitude: Float[np.ndarray, "row column"] | None = None

    def __post_init__(self) -> None:
        if self.rows < 1 or self.columns < 1:
            raise ParameterError(f"a grid of {self.rows} × {self.columns} texels has no site: use 1 × 1 or more")
        if self.magnitude is not None and self.field is None:
            raise ParameterError("a magnitude enlarges texture along a field: give a field too")
        if self.field is not None:
            _check_field(self.shape, self.field, self.magnitude)

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.rows, self.columns

    @property
    def count(self) -> int:
        """Number of sites."""
        return self.rows * self.columns

    @property
    def area(self) -> Float32[np.ndarray, "site"]:
        """Area each site stands for, in exemplar texels: 1 where the texture is not enlarged."""
        return (self._texel**-2).astype(np.float32)

    @property
    def edges(self) -> Int32[np.ndarray, "edge 2"]:
        """Each site with the one to its right, then each with the one below."""
        site = np.arange(self.count, dtype=np.int32).reshape(self.shape)
        pairs = [(site, np.roll(site, -1, axis)) for axis in (1, 0)]
        if not self.wrap:
            pairs = [(site[:, :-1], site[:, 1:]), (site[:-1], site[1:])]
        return np.concatenate([np.stack([a.ravel(), b.ravel()], 1) for a, b in pairs])

    @property
    def lattice(self) -> Lattice | None:
        """The grid itself, unless a field turns its frames."""
        return Lattice(self.rows, self.columns, self.wrap) if self.field is None else None

    def centres(self, pitch: float, seed: int) -> Int32[np.ndarray, "patch"]:
        """An even lattice, in scan-line order, at most ``pitch`` texels apart (less, so that the size divides).

        A torus's lattice starts anywhere, by ``seed``; a plane's begins and ends half a pitch inside the border. With
        a magnitude there is no lattice: sites at least 0.84 ``pitch`` apart, by ``seed``, in texels of their own.
        """
        if self.magnitude is not None:
            return scatter(self.flow, self._texel, pitch, seed=seed)
        phase = draws.uniform(seed, _PHASE, index=np.arange(2)) if self.wrap else np.full(2, 0.5)
        row, column = (_spread(size, pitch, at) for size, at in zip(self.shape, phase, strict=True))
        return (row[:, None] * self.columns + column).ravel().astype(np.int32)

    def patches(self, centres: Int32[np.ndarray, "patch"], width: int) -> Patches:
        """Squares of sites around ``centres``; samples outside a plane are -1.

        On a torus smaller than ``width`` samples repeat; the cover keeps each site once, nearest the centre.
        """
        if self.field is not None:
            return lay_patches(self.flow, centres, width, axis=self._axis)
        row, row_once = self._steps(centres // self.columns, width, self.rows)
        column, column_once = self._steps(centres % self.columns, width, self.columns)
        sites = row[:, :, None] * np.int32(self.columns) + column[:, None, :]
        if not self.wrap:
            sites[(row < 0)[:, :, None] | (column < 0)[:, None, :]] = -1
        kept = sites if row_once.all() and column_once.all() else np.where(row_once[:, None] & column_once, sites, -1)
        start, entry = group_by_site(kept.reshape(-1), self.count)
        patch, sample = np.divmod(entry, np.int32(width * width))
        return Patches(
            width=width,
            centres=centres,
            sites=sites.reshape(len(centres), width * width, 1),
            weights=None,
            cover_start=start,
            cover_patch=patch,
            cover_position=np.stack(np.divmod(sample, np.int32(width)), axis=1, dtype=np.float32, casting="unsafe"),
        )

    def in_image_axes(self, sources: SourceMap) -> SourceMap:
        """The same sources with the image's axes for every site's frame, as pictures and normal maps need them."""
        if self.field is None:
            return sources
        angle = np.angle(self._direction).astype(np.float32).reshape(-1, 1)
        turn = np.broadcast_to(angle, sources.weight.shape) if sources.turn is None else sources.turn + angle
        return replace(sources, turn=np.ascontiguousarray(turn))

    @cached_property
    def flow(self) -> Flow:
        """The field on triangles between the sites, to trace in."""
        return planar_flow(self._direction, self._texel.reshape(self.shape), order=1, wrap=self.wrap)

    @property
    def _direction(self) -> Complex64[np.ndarray, "row column"]:
        """The field as unit complex numbers, imaginary up the rows."""
        assert self.field is not None
        number = self.field[..., 1] - 1j * self.field[..., 0]
        return (number / np.abs(number)).astype(np.complex64)

    @property
    def _texel(self) -> Float64[np.ndarray, "site"]:
        """Length of a texel at each site, in steps of the grid."""
        return np.ones(self.count) if self.magnitude is None else self.magnitude.ravel().astype(np.float64)

    @property
    def _axis(self) -> Complex64[np.ndarray, "face 3"]:
        """Each site's frame in the faces around it: with one direction a site, the field itself."""
        return self.flow.power

    def neighbourhoods(self, sites: Int32[np.ndarray, "n"], reach: int) -> Neighbourhoods:
        """Squares of ``2 reach + 1`` texels a side, the middle one first; -1 outside a plane."""
        steps = square(reach)
        row, column = np.divmod(sites[:, None], np.int32(self.columns))
        row, column = row + steps[:, 0], column + steps[:, 1]
        if self.wrap:
            around = row % np.int32(self.rows) * np.int32(self.columns) + column % np.int32(self.columns)
        else:
            inside = (row >= 0) & (row < self.rows) & (column >= 0) & (column < self.columns)
            around = np.where(inside, row * np.int32(self.columns) + column, np.int32(-1))
        if self.field is None:
            return Neighbourhoods(around, steps[None].astype(np.float32))
        # A step along the image's axes, read in the frame of the middle site and in its texels.
        in_frame = (steps[:, 1] - 1j * steps[:, 0]) * self._direction.ravel()[sites, None].conj()
        in_frame /= self._texel[sites, None]
        return Neighbourhoods(around, np.stack([-in_frame.imag, in_frame.real], -1).astype(np.float32))

    def _steps(
        self, centre: Int32[np.ndarray, "patch"], width: int, size: int
    ) -> tuple[Int32[np.ndarray, "patch width"], np.ndarray]:
        """Rows (or columns) of each patch, -1 outside, and which of them show a row for the first time."""
        offset = np.arange(width, dtype=np.int32) - width // 2
        steps = centre[:, None] + offset
        if self.wrap:
            return steps % np.int32(size), (offset >= -(size // 2)) & (offset < size - size // 2)
        return np.where((steps >= 0) & (steps < size), steps, -1), np.ones(width, bool)


def _spread(size: int, pitch: float, phase: float) -> Int32[np.ndarray, "step"]:
    """Even steps over ``0 .. size - 1``, no farther apart than ``pitch`` (rounding aside)."""
    steps = max(1, int(np.ceil(size / pitch)))
    return (np.floor((np.arange(steps) + phase) * (size / steps)).astype(np.int64) % size).astype(np.int32)


def _check_field(shape: tuple[int, int], field: np.ndarray, magnitude: np.ndarray | None) -> None:
    """Raises: ParameterError, for a grid too thin to trace on; FieldError, unless the field fits it everywhere."""
    if min(shape) < 3:
        raise ParameterError(f"a grid of {shape[0]} × {shape[1]} texels is too thin for a field: use 3 × 3 or more")
    if field.shape != (*shape, 2):
        raise FieldError(
            f"a field of shape {field.shape} for a grid of {shape[0]} × {shape[1]}: one [row, column] a site"
        )
    if not np.isfinite(field).all() or not field.any(axis=-1).all():
        count = np.count_nonzero(~(np.isfinite(field).all(axis=-1) & field.any(axis=-1)))
        raise FieldError(f"{count} of {field[..., 0].size} directions are 0 or not finite: give each site one")
    if magnitude is not None and (magnitude.shape != shape or not (np.isfinite(magnitude) & (magnitude > 0)).all()):
        raise FieldError(f"the magnitude must be {shape[0]} × {shape[1]} numbers above 0, one a site")
