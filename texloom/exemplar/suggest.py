"""Which settings suit a sample, from the size and the period of its structure."""

from dataclasses import dataclass
from math import hypot

from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.regularity import NEAR_REGULAR, Regularity, regularity
from texloom.exemplar.scale import Spectrum, spectrum

_SURROUNDINGS = 1.25  # cells of a lattice that a patch holds, at least
_STEP = 4  # texels; patches are a whole number of steps wide
_LEAST_PATCH, _LARGEST_PATCH = 16, 64  # texels; larger ones show as copies, unless the sample repeats anyway
_STRONG = 0.3  # regularity from which patches fit as well as corrected ones
_NO_SCALE = 2.0  # prominence under which no scale stands out


@dataclass(frozen=True)
class Suggestion:
    """Settings in texels. A method is named as on the command line."""

    window: int  # of a pixel's neighbourhood: twice the dominant scale (Shin & Shin 2004)
    pitch: int  # between seed points: the dominant scale
    patch: int  # per side: holds a feature, or a cell of the lattice, and some of its surroundings
    method: str
    why: str


@dataclass(frozen=True, eq=False)
class Structure:
    """All that is measured of a sample's structure, and what follows from it."""

    spectrum: Spectrum
    regularity: Regularity
    suggestion: Suggestion


def structure(exemplar: Exemplar) -> Structure:
    """Measure the maps that matching compares; tenths of a second for 512 x 512 texels."""
    image = match_image(exemplar)
    waves = spectrum(image, exemplar.mask)
    periods = regularity(image, waves.scale, exemplar.mask)
    return Structure(waves, periods, suggest(waves, periods, exemplar.shape))


def suggest(waves: Spectrum, periods: Regularity, shape: tuple[int, int]) -> Suggestion:
    """Settings for a sample of this many rows and columns. No patch is more than half of its shorter side wide.

    Patches are never less than a quarter of the side, the default: smaller ones fitted worse on every sample tried.
    """
    regular = periods.value >= NEAR_REGULAR
    cell = max((hypot(*vector) for vector in periods.lattice), default=0.0) if regular else 0.0
    usual = min(max(2 * waves.scale, min(shape) / 4, _LEAST_PATCH), _LARGEST_PATCH)
    patch = max(2 * _STEP, int(min(max(usual, _SURROUNDINGS * cell), min(shape) / 2)) // _STEP * _STEP)
    return Suggestion(round(2 * waves.scale), round(waves.scale), patch, *_method(waves, periods, cell, patch))


def _method(waves: Spectrum, periods: Regularity, cell: float, patch: int) -> tuple[str, str]:
    """A method and why, as ``docs/choose.md`` has it."""
    if cell and cell > patch:
        return "optimize", "it repeats, in cells larger than a patch: joints need correction texel by texel"
    if len(periods.lattice) == 2 and periods.value >= _STRONG:
        return "patches", "it repeats, and a patch holds a cell of its lattice: joints fit, and it takes less time"
    if cell:
        return "optimize", "it repeats, but loosely: joints need correction texel by texel"
    if waves.prominence < _NO_SCALE:
        return "optimize", "fine grain in which no scale stands out: any method copies it well"
    return "optimize", "features without a period: blocks keep them whole, and joints are corrected texel by texel"
