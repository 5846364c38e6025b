"""What to imitate: a stack of aligned maps, with a mask of the texels that may be used."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float32, UInt8, UInt16

from texloom.arrays import Image, MapKind
from texloom.errors import ExemplarError
from texloom.exemplar.colour import decode

LEAST_SIDE = 8
"""Texels: the smallest patch of the default methods; no texture can be learnt from less."""

COLOUR_MAPS = ("basecolor", "emissive")
NORMAL_MAPS = ("normal",)


@dataclass(frozen=True, eq=False)
class Map:
    """One map of a stack and how it was stored, so that it can be written back the same way."""

    image: Image
    kind: MapKind
    bits: int  # 8 or 16 (integers), 32 (float)


@dataclass(frozen=True)
class Part:
    """The rectangle of one of several samples in the images that hold them all: its first texel and its size."""

    row: int
    column: int
    rows: int
    columns: int

    @property
    def slices(self) -> tuple[slice, slice]:
        """The rectangle as an index of arrays."""
        return slice(self.row, self.row + self.rows), slice(self.column, self.column + self.columns)


@dataclass(frozen=True, eq=False)
class Exemplar:
    """Aligned maps of one size, by name ("basecolor", "normal", "roughness", "metallic", "height", "ao", "alpha", ...).

    ``mask`` is True where a texel may be used; None means everywhere. The first map leads where one picture is needed.
    ``parts`` are the rectangles of several samples side by side (``texloom.exemplar.join``); empty where it is one.

    Raises: ExemplarError, if there is no map, sizes differ, a side is under 8 texels, a value is not finite,
    or the mask leaves nothing.
    """

    maps: Mapping[str, Map]
    mask: Bool[np.ndarray, "row column"] | None = None
    parts: tuple[Part, ...] = ()

    def __post_init__(self) -> None:
        if not self.maps:
            raise ExemplarError("an exemplar needs at least one map: give it a basecolor")
        if min(self.shape) < LEAST_SIDE:
            raise ExemplarError(
                f"the exemplar is {_size(self.shape)} texels, but synthesis needs {LEAST_SIDE}x{LEAST_SIDE} or more: "
                "use a larger sample"
            )
        self._check_alignment()
        if self.mask is not None and not self.mask.any():
            raise ExemplarError(
                f"the mask leaves none of {self.mask.size} texels to use: mark usable texels white (or opaque)"
            )
        self._check_finite()

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns = next(iter(self.maps.values())).image.shape[:2]
        return rows, columns

    @property
    def lead(self) -> Map:
        """The map that stands for the whole where one picture is needed: the first."""
        return next(iter(self.maps.values()))

    @property
    def usable(self) -> Bool[np.ndarray, "row column"]:
        """The mask, written out."""
        return np.ones(self.shape, bool) if self.mask is None else self.mask

    @property
    def least_side(self) -> int:
        """Texels: the shorter side of the rectangle around all that may be used; of several samples, the least."""
        whole = Part(0, 0, *self.shape)
        usable = [self.usable[part.slices] for part in self.parts or (whole,)]
        return min(int(np.ptp(np.flatnonzero(m.any(axis)))) + 1 for m in usable if m.any() for axis in (0, 1))

    def crop(self, rows: slice, columns: slice) -> "Exemplar":
        """The same stack, cut to a rectangle."""
        maps = {name: replace(m, image=np.ascontiguousarray(m.image[rows, columns])) for name, m in self.maps.items()}
        return Exemplar(maps, None if self.mask is None else self.mask[rows, columns].copy())

    def with_mask(self, mask: Bool[np.ndarray, "row column"]) -> "Exemplar":
        """The same stack, used only where ``mask`` and the present mask are both True."""
        return replace(self, mask=mask if self.mask is None else mask & self.mask)

    def _check_alignment(self) -> None:
        sizes = {name: m.image.shape[:2] for name, m in self.maps.items()}
        if self.mask is not None:
            sizes["mask"] = self.mask.shape
        odd = [name for name, size in sizes.items() if size != self.shape]
        if odd:
            first = next(iter(sizes))
            raise ExemplarError(
                f"maps must have one size, but {first} is {_size(sizes[first])} and "
                + ", ".join(f"{name} is {_size(sizes[name])}" for name in odd)
                + ": resize them to match"
            )

    def _check_finite(self) -> None:
        for name, m in self.maps.items():
            if m.bits != 32 or np.isfinite(m.image.sum(dtype=np.float64)):
                continue
            bad = int((~np.isfinite(m.image).all(axis=2)).sum())
            raise ExemplarError(
                f"{name} has {bad} texels that are NaN or infinite: repair them, or export the map again"
            )


def from_array(
    array: UInt8[np.ndarray, "row column *channel"]
    | UInt16[np.ndarray, "row column *channel"]
    | Float32[np.ndarray, "row column *channel"],
    *,
    name: str = "basecolor",
    mask: Bool[np.ndarray, "row column"] | None = None,
) -> Exemplar:
    """An exemplar of one map.

    Integers are stored values (sRGB where ``name`` is a colour); floats are linear light or data as they are. A
    second or fourth channel is opacity: it becomes the map "alpha", and where it is 0 the texel is not used.
    """
    kind = kind_of(name)
    array = np.asarray(array)
    if array.ndim == 2:
        array = array[..., None]
    if array.ndim != 3 or not 1 <= array.shape[2] <= 4:
        raise ExemplarError(f"an exemplar array is (row, column[, 1 to 4 channels]), not of shape {array.shape}")
    colour, alpha = split_alpha(array)
    maps = {name: to_map(colour, kind)}
    if alpha is not None:
        maps["alpha"] = to_map(alpha, "data")
        mask = combine_masks(mask, alpha[..., 0] > 0)
    return Exemplar(maps, mask)


def kind_of(name: str) -> MapKind:
    """How the map of this name behaves."""
    if name in COLOUR_MAPS:
        return "colour"
    return "normal" if name in NORMAL_MAPS else "data"


def to_map(stored: np.ndarray, kind: MapKind) -> Map:
    """A map of stored values: integers are decoded by kind and remember their depth, floats are taken as they are."""
    if stored.dtype in (np.uint8, np.uint16):
        if kind == "colour":
            image = decode(stored)
        else:
            image = stored / np.float32(np.iinfo(stored.dtype).max)
        return Map(np.ascontiguousarray(image), kind, stored.dtype.itemsize * 8)
    if stored.dtype.kind == "f":
        return Map(np.ascontiguousarray(stored, np.float32), kind, 32)
    if stored.dtype == bool:
        return to_map(stored * np.uint8(255), kind)
    raise ExemplarError(f"values of type {stored.dtype} are not understood: use uint8, uint16 or float32")


def split_alpha(array: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """Colours and opacity of a (row, column, channel) array; opacity is None where all is opaque."""
    if array.shape[2] not in (2, 4):
        return array, None
    colour, alpha = array[..., :-1], array[..., -1:]
    opaque = 1.0 if array.dtype.kind == "f" else np.iinfo(array.dtype).max
    return colour, None if (alpha >= opaque).all() else alpha


def combine_masks(
    first: Bool[np.ndarray, "row column"] | None, second: Bool[np.ndarray, "row column"] | None
) -> Bool[np.ndarray, "row column"] | None:
    """Usable in both; None where all is usable."""
    given = [mask for mask in (first, second) if mask is not None]
    if not given:
        return None
    mask = np.logical_and.reduce(given)
    return None if mask.all() else mask


def _size(shape: tuple[int, ...]) -> str:
    """Width x height, as people say it."""
    return f"{shape[1]}x{shape[0]}"
