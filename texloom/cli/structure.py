"""What ``texloom inspect`` says of a sample's structure: in numbers, and on a page."""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import UInt8

from texloom.cli.reports import sample_figures
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.regularity import NEAR_REGULAR, Regularity
from texloom.exemplar.suggest import Structure
from texloom.output.plots import curve_plot
from texloom.output.report import Account, Figure

_SIDE = 384  # pixels of the autocorrelation's picture, about
_DARK, _BRIGHT = -0.3, 0.7  # correlations shown as black and as white
_DOT = (235, 60, 30)
_LAGS = "How like itself the sample is when moved, the unmoved place in the middle"


def facts(structure: Structure) -> dict[str, Any]:
    """Numbers in texels; the lattice is empty where the sample is not near-regular."""
    periods, advice = structure.regularity, structure.suggestion
    return {
        "dominant scale": round(structure.spectrum.scale, 2),
        "prominence": round(structure.spectrum.prominence, 2),
        "regularity": round(periods.value, 3),
        "lattice": [list(vector) for vector in _lattice(periods)],
        "suggested": {
            "window": advice.window,
            "pitch": advice.pitch,
            "patch": advice.patch,
            "method": advice.method,
            "why": advice.why,
        },
    }


def lines(structure: Structure) -> dict[str, Any]:
    """The same facts for people."""
    told = facts(structure)
    advice = told.pop("suggested")
    told["lattice"] = ", ".join(f"{down:g} down {across:g} across" for down, across in told["lattice"])
    return told | {f"suggested {name}" if name != "why" else "because": value for name, value in advice.items()}


def curves(structure: Structure) -> dict[str, Any]:
    """The ring spectrum as plotted, for ``--json``: cycles a texel, and power that sums to 1."""
    waves = structure.spectrum
    frequency, power = ([float(f"{value:.4g}") for value in values] for values in (waves.frequency, waves.power))
    return {"spectrum": {"frequency": frequency, "power": power}}


def account(path: Path, exemplar: Exemplar, structure: Structure, command: str) -> Account:
    """The page: the sample, its ring spectrum, its autocorrelation, the settings that follow."""
    waves, periods = structure.spectrum, structure.regularity
    shown = waves.frequency >= 1.5 / min(exemplar.shape)  # one cycle across the sample is no texture
    plot = curve_plot(
        (1 / waves.frequency[shown])[::-1].tolist(),
        waves.power[shown][::-1].tolist(),
        across="texels a cycle (power in rings of the spectrum)",
        mark=(waves.scale, f"dominant scale {waves.scale:.1f}"),
    )
    count = len(_lattice(periods))
    said = ("no lattice", "red: its rows", "red: its lattice")[count]
    caption = f"{_LAGS}; {said}; near-regularity {periods.value:.2f} of 1"
    return Account(
        title=f"Structure of {path.name}",
        subtitle=f"{exemplar.shape[1]}×{exemplar.shape[0]} texels",
        command=command,
        settings={name: str(value) for name, value in lines(structure).items() if value},
        figures={
            "Sample": sample_figures(exemplar),
            "Autocorrelation": [Figure(autocorrelation_picture(periods), caption)],
        },
        plots={"Spectrum": plot},
    )


def autocorrelation_picture(periods: Regularity) -> UInt8[np.ndarray, "row column 3"]:
    """The autocorrelation in greys, a dot on every point of the lattice."""
    values = periods.correlation
    grey = np.clip((values - _DARK) / (_BRIGHT - _DARK), 0, 1) * 255
    enlarged = max(1, round(_SIDE / max(values.shape)))
    picture = np.repeat(np.repeat(grey.astype(np.uint8), enlarged, 0), enlarged, 1)[..., None].repeat(3, 2)
    dot = max(2, round(max(picture.shape) / 160))
    for lag in _points(_lattice(periods), np.array(values.shape) // 2):
        row, column = np.round((lag + np.array(values.shape) // 2 + 0.5) * enlarged).astype(int)
        picture[max(row - dot, 0) : row + dot, max(column - dot, 0) : column + dot] = _DOT
    return picture


def _lattice(periods: Regularity) -> tuple[tuple[float, float], ...]:
    return periods.lattice if periods.value >= NEAR_REGULAR else ()


def _points(lattice: tuple[tuple[float, float], ...], reach: np.ndarray) -> np.ndarray:
    """Whole combinations of the vectors within reach."""
    if not lattice:
        return np.empty((0, 2))
    many = np.arange(-64, 65)
    combined = many[:, None] * np.array(lattice[0])
    if len(lattice) == 2:
        combined = (combined[:, None] + many[:, None] * np.array(lattice[1])).reshape(-1, 2)
    return combined[(np.abs(combined) <= reach).all(axis=1)]
