"""What a paper's method learns from its sample, kept in a file between runs."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from texloom.errors import ParameterError

if TYPE_CHECKING:
    from texloom.cli.session import Session
    from texloom.exemplar.exemplar import Exemplar
    from texloom.synthesis.synthesize import Method


def check_analysis(path: Path | None, preset: str | None) -> None:
    """Refuse a file of analysis for the methods that keep none."""
    if path is not None and preset is None:
        raise ParameterError(f"--analysis {path.name} is for a paper's method: add --preset resampling")
    if path is not None and preset != "resampling":
        raise ParameterError(f"--analysis {path.name} is for --preset resampling, {preset} keeps none: leave it out")


def with_analysis(method: "Method", path: Path, exemplar: "Exemplar", session: "Session") -> "Method":
    """The method with what the file holds of this exemplar; where there is no file, it is learnt now and saved.

    Raises: FileError, if the file is no analysis or of another version; ExemplarError, if it is of other pixels.
    """
    from texloom.search.analysis import load_analysis
    from texloom.synthesis.boundary import BoundarySampling
    from texloom.synthesis.least_squares import LeastSquares

    assert isinstance(method, LeastSquares | BoundarySampling), "check_analysis comes first"
    with session.stage("analysis"):
        if path.exists():
            return replace(method, analysis=load_analysis(path, exemplar))
        analysis = method.analyse(exemplar)
        analysis.save(path)
        session.wrote(path)
        return replace(method, analysis=analysis)
