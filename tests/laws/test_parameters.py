"""What a method cannot do it refuses, in one line that says why, with the number, and what to do."""

from collections.abc import Callable

import numpy as np
import pytest

from tests.synthesis.samples import exemplar
from texloom.domain.grid import Grid
from texloom.errors import ExemplarError, ParameterError
from texloom.synthesis.boundary import BoundarySampling
from texloom.synthesis.least_squares import LeastSquares, Stage, stages
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.refine import Refine
from texloom.synthesis.synthesize import Method, synthesize

BAD: dict[str, Callable[[], object]] = {
    "width 4": lambda: Optimize(width=4),
    "width 1": lambda: Optimize(width=1),
    "passes -1": lambda: Optimize(passes=-1),
    "reach -2": lambda: Optimize(reach=-2),
    "alike -1": lambda: Optimize(alike=-1),
    "patch 7": lambda: PatchSampling(patch=7),
    "overlap 0": lambda: PatchSampling(overlap=0.0),
    "overlap 0.6": lambda: PatchSampling(overlap=0.6),
    "overlap nan": lambda: PatchSampling(overlap=float("nan")),
    "balance -0.1": lambda: PatchSampling(balance=-0.1),
    "balance nan": lambda: PatchSampling(balance=float("nan")),
    "order 'rows'": lambda: Refine(order="rows"),  # pyright: ignore[reportArgumentType]
    "'median'": lambda: Refine(difference="median"),  # pyright: ignore[reportArgumentType]
    "window 2": lambda: Refine(window=2),
    "pitch 0": lambda: Refine(order="scan-line", pitch=0),
    "pitch 6": lambda: Refine(pitch=6),
    "passes 0": lambda: Refine(passes=0),
    "dimensions 0": lambda: Refine(dimensions=0),
    "shortlist 0": lambda: Refine(shortlist=0),
    "threshold -0.5": lambda: Refine(threshold=-0.5),
    "threshold nan": lambda: Refine(threshold=float("nan")),
    "alike -2": lambda: Refine(alike=-2),
    "'spiral'": lambda: PatchSampling(order="spiral"),  # pyright: ignore[reportArgumentType]
    "'scan'": lambda: BoundarySampling(order="scan"),  # pyright: ignore[reportArgumentType]
    "patch 30": lambda: BoundarySampling(patch=30),
    "patch 12": lambda: BoundarySampling(patch=12),
    "zone 0": lambda: BoundarySampling(zone=0),
    "zone 17": lambda: BoundarySampling(zone=17),
    "(4, 2)": lambda: BoundarySampling(steps=(4, 2)),
    "(1, 2)": lambda: BoundarySampling(steps=(1, 2)),
    "(3, 1)": lambda: BoundarySampling(steps=(3, 1), patch=36),
    "()": lambda: BoundarySampling(steps=()),
    "step 3": lambda: Stage(3, 8),
    "step 0": lambda: Stage(0, 8),
    "width 0": lambda: Stage(1, 0),
    "empty": lambda: LeastSquares(schedule=()),
    "iterations 0": lambda: LeastSquares(iterations=0),
    "samples 0": lambda: LeastSquares(samples=0),
    "6": lambda: stages(6),
    "0 × 4": lambda: Grid(0, 4),
}


def one_line(error: Exception, name: str) -> None:
    text = str(error)
    assert name in text and "\n" not in text and 20 < len(text) < 200


@pytest.mark.parametrize("name", BAD)
def test_a_bad_parameter_is_named_in_one_line(name: str) -> None:
    with pytest.raises(ParameterError) as caught:
        BAD[name]()
    one_line(caught.value, name)


@pytest.mark.parametrize("method", [LeastSquares(), BoundarySampling()], ids=["least-squares", "boundary"])
def test_an_exemplar_smaller_than_the_patches_is_refused_by_its_own_size(method: Method) -> None:
    with pytest.raises(ExemplarError) as caught:
        synthesize(exemplar(24).crop(slice(0, 20), slice(0, 24)), Grid(20, 20), method)
    one_line(caught.value, "24x20 texels, but a patch needs 32x32")


def test_a_mask_that_leaves_no_block_is_refused() -> None:
    mask = np.zeros((32, 32), bool)
    mask[::5] = True
    ours = (Optimize(), PatchSampling(patch=8), Refine(), Refine(order="scan-line"))
    for method in (*ours, BoundarySampling(patch=16), LeastSquares(schedule=stages(16))):
        with pytest.raises(ExemplarError, match="mask"):
            synthesize(exemplar(32).with_mask(mask), Grid(20, 20), method)
